"""Compose the robot's URDF from Baxter's description: planar base, torso, head, arms, grippers, camera frames."""

from __future__ import annotations

import hashlib
import os
import tempfile
import xml.etree.ElementTree as ET
from functools import lru_cache
from pathlib import Path

from ..mechanics.robot_model import RobotModel
from ..world import SIDES
from . import model
from .urdf_parts import UrdfParts, description, with_collisions

_ARM_LINKS = (
    "arm_mount",
    "upper_shoulder",
    "lower_shoulder",
    "upper_elbow",
    "lower_elbow",
    "upper_forearm",
    "lower_forearm",
    "wrist",
    "hand_link",
)
_ARM_FIXED = ("torso_arm_mount", "hand_joint")


def baxter_folder() -> Path:
    """Folder of Baxter's description (`urdf/`, `meshes/`) inside the installed data wheel; raises WorldError."""
    return description("baxter.urdf").parent.parent


def compose() -> str:
    """The whole robot as URDF text, without visual meshes (`visual.py` has them) and without shapes."""
    source = ET.parse(baxter_folder() / "urdf" / "baxter.urdf").getroot()
    links = {link.get("name"): link for link in source.findall("link")}
    joints = {joint.get("name"): joint for joint in source.findall("joint")}
    parts = UrdfParts("caretree_baxter")
    robot = parts.robot
    parts.planar_base()
    parts.given_link("torso", links["torso"])
    parts.joint("torso_mount", "fixed", "base", "torso", xyz=model.TORSO_IN_BASE)
    parts.given_link("head", links["head"])
    robot.append(joints["head_pan"])
    parts.head_camera()
    for side in SIDES:
        for name in _ARM_LINKS:
            parts.given_link(f"{side}_{name}", links[f"{side}_{name}"])
        for name in (*_ARM_FIXED, *model.ARM_JOINTS):
            robot.append(joints[f"{side}_{name}"])
        parts.gripper(side, f"{side}_hand_link", model.FLANGE_IN_HAND_LINK)
    for element in robot.iter("limit"):  # PyBullet reads the head's 50000 N m literally
        if float(element.get("velocity", "0")) > 100.0:
            element.set("velocity", str(model.HEAD_VELOCITY))
            element.set("effort", "50")
    return parts.text()


@lru_cache
def urdf_path(robot: RobotModel) -> Path:
    """Write a robot's URDF with its shapes once into the user's cache folder and return its path."""
    text = with_collisions(robot.urdf(), robot.shapes)
    path = cache_folder() / f"robot_{hashlib.sha256(text.encode()).hexdigest()[:12]}.urdf"
    if not path.exists():
        write_atomically(path, text.encode())
    return path


def cache_folder() -> Path:
    """`$XDG_CACHE_HOME/caretree`, or a temporary folder where that cannot be written."""
    home = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "caretree"
    try:
        home.mkdir(parents=True, exist_ok=True)
        if os.access(home, os.W_OK):
            return home
    except OSError:
        pass
    fallback = Path(tempfile.gettempdir()) / f"caretree-{os.getuid() if hasattr(os, 'getuid') else 'user'}"
    fallback.mkdir(parents=True, exist_ok=True)
    return fallback


def write_atomically(path: Path, content: bytes) -> None:
    """Write so that a second process never reads half a file."""
    with tempfile.NamedTemporaryFile(dir=path.parent, delete=False) as stream:
        stream.write(content)
    os.replace(stream.name, path)
