"""Compose the robot's URDF from Baxter's description: planar base, torso, head, arms, grippers, camera frames."""

from __future__ import annotations

import hashlib
import importlib.metadata
import os
import tempfile
import xml.etree.ElementTree as ET
from functools import lru_cache
from pathlib import Path

import numpy as np

from ..world import SIDES, Side, WorldError
from . import model
from .shapes import Shape, collision_shapes

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
PLANAR_RANGE = 100.0  # of the planar base joints [m] and [rad]: wide enough never to be met


@lru_cache
def baxter_folder() -> Path:
    """Folder of Baxter's description (`urdf/`, `meshes/`) inside the installed data wheel.

    Raises:
        WorldError: the package `example-robot-data` is missing or holds no Baxter.
    """
    try:
        files = importlib.metadata.files("example-robot-data") or []
    except importlib.metadata.PackageNotFoundError:
        files = []
    for file in files:
        if file.name == "baxter.urdf":
            return Path(str(file.locate())).resolve().parent.parent
    raise WorldError("the robot needs baxter.urdf of the Python package example-robot-data 6.0.0, which is missing")


def compose(*, collisions: bool = True) -> str:
    """The whole robot as URDF text, without visual meshes (`visual.py` has them).

    Args:
        collisions: with collision shapes, as PyBullet wants it; pinocchio's parser knows no capsules.
    """
    source = ET.parse(baxter_folder() / "urdf" / "baxter.urdf").getroot()
    links = {link.get("name"): link for link in source.findall("link")}
    joints = {joint.get("name"): joint for joint in source.findall("joint")}
    shapes = collision_shapes() if collisions else {}
    robot = ET.Element("robot", name="caretree_baxter")

    def link(name: str, mass: float = 1e-4, size=(0.1, 0.1, 0.1), centre=(0, 0, 0)) -> None:
        """Add a link of ours; its inertia is that of a solid box (frames need a little, or PyBullet assumes 1 kg)."""
        element = ET.SubElement(robot, "link", name=name)
        _inertial(element, mass, size, centre)
        _collisions(element, shapes.get(name, ()))

    def baxter_link(name: str) -> None:
        """Add one of Baxter's links: its inertia, our shapes."""
        element = ET.SubElement(robot, "link", name=name)
        inertial = links[name].find("inertial")
        if inertial is not None:
            element.append(inertial)
        _collisions(element, shapes.get(name, ()))

    def baxter_joint(name: str) -> None:
        robot.append(joints[name])

    link("map", 1.0)
    link("base_x_link", 1.0)
    link("base_y_link", 1.0)
    link("base", model.BASE_MASS, model.BASE_SIZE, (0, 0, model.BASE_SIZE[2] / 2))
    for name, kind, parent, child, axis in (
        ("base_x", "prismatic", "map", "base_x_link", "1 0 0"),
        ("base_y", "prismatic", "base_x_link", "base_y_link", "0 1 0"),
        ("base_yaw", "revolute", "base_y_link", "base", "0 0 1"),
    ):
        _joint(robot, name, kind, parent, child, axis=axis, limit=(-PLANAR_RANGE, PLANAR_RANGE, 5000.0, 2.0))
    baxter_link("torso")
    _joint(robot, "torso_mount", "fixed", "base", "torso", xyz=model.TORSO_IN_BASE)
    baxter_link("head")
    baxter_joint("head_pan")
    link("head_camera")
    _joint(
        robot,
        "head_camera_joint",
        "fixed",
        "head",
        "head_camera",
        xyz=model.HEAD_CAMERA_IN_HEAD,
        rpy=(-np.pi / 2 - model.HEAD_CAMERA_PITCH, 0.0, -np.pi / 2),
    )
    for side in SIDES:
        for name in _ARM_LINKS:
            baxter_link(f"{side}_{name}")
        for name in (*_ARM_FIXED, "s0", "s1", "e0", "e1", "w0", "w1", "w2"):
            baxter_joint(f"{side}_{name}")
        _gripper(robot, link, side)
    for element in robot.iter("limit"):  # PyBullet reads the head's 50000 N m literally
        if float(element.get("velocity", "0")) > 100.0:
            element.set("velocity", str(model.HEAD_VELOCITY))
            element.set("effort", "50")
    ET.indent(robot)
    return ET.tostring(robot, encoding="unicode")


@lru_cache
def urdf_path() -> Path:
    """Write the composed URDF once into the user's cache folder and return its path."""
    text = compose()
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


def _gripper(robot: ET.Element, link, side: Side) -> None:
    palm_z = model.FLANGE_IN_HAND_LINK
    tip_z = palm_z + model.FLANGE_TO_FINGERTIP
    link(f"{side}_gripper", model.PALM_MASS, model.PALM_SIZE, (0, 0, model.PALM_SIZE[2] / 2))
    _joint(robot, f"{side}_gripper_joint", "fixed", f"{side}_hand_link", f"{side}_gripper", xyz=(0, 0, palm_z))
    for letter, sign in (("a", 1), ("b", -1)):
        centre = (0, sign * model.FINGER_SIZE[1] / 2, -model.FINGER_SIZE[2] / 2)
        link(f"{side}_finger_{letter}_link", model.FINGER_MASS, model.FINGER_SIZE, centre)
        _joint(
            robot,
            f"{side}_finger_{letter}",
            "prismatic",
            f"{side}_hand_link",
            f"{side}_finger_{letter}_link",
            xyz=(0, 0, tip_z),
            axis=f"0 {sign} 0",
            limit=(0.0, model.GRIPPER_STROKE / 2, model.GRIPPER_FORCE[1], model.GRIPPER_SPEED / 2),
        )
    link(f"{side}_hand")
    _joint(robot, f"{side}_hand_frame", "fixed", f"{side}_hand_link", f"{side}_hand", xyz=(0, 0, tip_z))
    link(f"{side}_hand_camera")
    # Image right is the hand's -y: seen from behind the palm the fingers close left-right.
    _joint(
        robot,
        f"{side}_hand_camera_joint",
        "fixed",
        f"{side}_hand_link",
        f"{side}_hand_camera",
        xyz=model.HAND_CAMERA_IN_HAND_LINK,
        rpy=(model.HAND_CAMERA_TILT, 0.0, -np.pi / 2),
    )


def _joint(
    robot: ET.Element,
    name: str,
    kind: str,
    parent: str,
    child: str,
    *,
    xyz=(0, 0, 0),
    rpy=(0, 0, 0),
    axis: str | None = None,
    limit: tuple[float, float, float, float] | None = None,
) -> None:
    element = ET.SubElement(robot, "joint", name=name, type=kind)
    ET.SubElement(element, "origin", xyz=_numbers(xyz), rpy=_numbers(rpy))
    ET.SubElement(element, "parent", link=parent)
    ET.SubElement(element, "child", link=child)
    if axis:
        ET.SubElement(element, "axis", xyz=axis)
    if limit:
        keys = ("lower", "upper", "effort", "velocity")
        ET.SubElement(element, "limit", {key: repr(float(value)) for key, value in zip(keys, limit, strict=True)})


def _inertial(element: ET.Element, mass: float, size, centre) -> None:
    x, y, z = np.square(np.asarray(size, float)) * mass / 12.0
    inertial = ET.SubElement(element, "inertial")
    ET.SubElement(inertial, "origin", xyz=_numbers(centre), rpy="0 0 0")
    ET.SubElement(inertial, "mass", value=repr(float(mass)))
    ET.SubElement(
        inertial,
        "inertia",
        ixx=repr(float(y + z)),
        iyy=repr(float(x + z)),
        izz=repr(float(x + y)),
        ixy="0",
        ixz="0",
        iyz="0",
    )


def _collisions(element: ET.Element, shapes: tuple[Shape, ...]) -> None:
    for shape in shapes:
        collision = ET.SubElement(element, "collision")
        ET.SubElement(collision, "origin", xyz=_numbers(shape.xyz), rpy=_numbers(shape.rpy))
        geometry = ET.SubElement(collision, "geometry")
        if shape.kind == "box":
            ET.SubElement(geometry, "box", size=_numbers(shape.size))
        else:
            ET.SubElement(geometry, "capsule", radius=repr(shape.size[0]), length=repr(shape.size[1]))


def _numbers(values) -> str:
    return " ".join(repr(float(value)) for value in values)
