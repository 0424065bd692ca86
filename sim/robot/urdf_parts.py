"""Parts of a robot's URDF that every robot here is put together from."""

from __future__ import annotations

import importlib.metadata
import xml.etree.ElementTree as ET
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from ..mechanics.shape import Shape
from ..world import Side, WorldError
from . import model

PLANAR_RANGE = 100.0  # of the planar base joints [m] and [rad]: wide enough never to be met


@lru_cache
def description(file: str) -> Path:
    """A file of the installed data wheel.

    Raises:
        WorldError: the package `example-robot-data` is missing, or does not hold it.
    """
    try:
        files = importlib.metadata.files("example-robot-data") or []
    except importlib.metadata.PackageNotFoundError:
        files = []
    for each in files:
        if each.name == file:
            return Path(str(each.locate())).resolve()
    raise WorldError(f"the robot needs {file} of the Python package example-robot-data 6.0.0, which is missing")


class UrdfParts:
    """A robot that grows part by part.

    Args:
        name: of the robot.

    Attributes:
        robot: root element.
    """

    def __init__(self, name: str) -> None:
        self.robot = ET.Element("robot", name=name)

    def link(
        self, name: str, mass: float = 1e-4, size: ArrayLike = (0.1, 0.1, 0.1), centre: ArrayLike = (0, 0, 0)
    ) -> None:
        """Add a link of ours; its inertia is that of a solid box (frames need a little, or PyBullet assumes 1 kg)."""
        element = ET.SubElement(self.robot, "link", name=name)
        _inertial(element, mass, size, centre)

    def given_link(self, name: str, source: ET.Element) -> None:
        """Add a link of another robot: its inertia."""
        element = ET.SubElement(self.robot, "link", name=name)
        inertial = source.find("inertial")
        if inertial is not None:
            element.append(inertial)

    def given_joint(self, source: ET.Element, prefix: str) -> ET.Element:
        """Add a joint of another robot, with `prefix` before its name and the names of its links; what was added."""
        element = ET.fromstring(ET.tostring(source))  # nosec: of the installed package
        element.set("name", prefix + element.get("name", ""))
        for end in (element.find("parent"), element.find("child")):
            assert end is not None
            end.set("link", prefix + end.get("link", ""))
        self.robot.append(element)
        return element

    def planar_base(self) -> None:
        """Add the base, which drives any way."""
        self.link("map", 1.0)
        self.link("base_x_link", 1.0)
        self.link("base_y_link", 1.0)
        self.link("base", model.BASE_MASS, model.BASE_SIZE, (0, 0, model.BASE_SIZE[2] / 2))
        for name, kind, parent, child, axis in (
            ("base_x", "prismatic", "map", "base_x_link", "1 0 0"),
            ("base_y", "prismatic", "base_x_link", "base_y_link", "0 1 0"),
            ("base_yaw", "revolute", "base_y_link", "base", "0 0 1"),
        ):
            self.joint(name, kind, parent, child, axis=axis, limit=(-PLANAR_RANGE, PLANAR_RANGE, 5000.0, 2.0))

    def head_camera(self) -> None:
        """Add the camera on top of the link `head`."""
        self.link("head_camera")
        self.joint(
            "head_camera_joint",
            "fixed",
            "head",
            "head_camera",
            xyz=model.HEAD_CAMERA_IN_HEAD,
            rpy=(-np.pi / 2 - model.HEAD_CAMERA_PITCH, 0.0, -np.pi / 2),
        )

    def gripper(self, side: Side, parent: str, palm_z: float) -> None:
        """Add a gripper with its camera, whose palm begins `palm_z` [m] along the z axis of `parent`."""
        tip_z = palm_z + model.FLANGE_TO_FINGERTIP
        self.link(f"{side}_gripper", model.PALM_MASS, model.PALM_SIZE, (0, 0, model.PALM_SIZE[2] / 2))
        self.joint(f"{side}_gripper_joint", "fixed", parent, f"{side}_gripper", xyz=(0, 0, palm_z))
        for letter, sign in (("a", 1), ("b", -1)):
            centre = (0, sign * model.FINGER_SIZE[1] / 2, -model.FINGER_SIZE[2] / 2)
            self.link(f"{side}_finger_{letter}_link", model.FINGER_MASS, model.FINGER_SIZE, centre)
            self.joint(
                f"{side}_finger_{letter}",
                "prismatic",
                parent,
                f"{side}_finger_{letter}_link",
                xyz=(0, 0, tip_z),
                axis=f"0 {sign} 0",
                limit=(0.0, model.GRIPPER_STROKE / 2, model.GRIPPER_FORCE[1], model.GRIPPER_SPEED / 2),
            )
        self.link(f"{side}_hand")
        self.joint(f"{side}_hand_frame", "fixed", parent, f"{side}_hand", xyz=(0, 0, tip_z))
        self.link(f"{side}_hand_camera")
        # Image right is the hand's -y: seen from behind the palm the fingers close left-right.
        self.joint(
            f"{side}_hand_camera_joint",
            "fixed",
            parent,
            f"{side}_hand_camera",
            xyz=model.HAND_CAMERA_IN_HAND_LINK + (0.0, 0.0, palm_z - model.FLANGE_IN_HAND_LINK),
            rpy=(model.HAND_CAMERA_TILT, 0.0, -np.pi / 2),
        )

    def joint(
        self,
        name: str,
        kind: str,
        parent: str,
        child: str,
        *,
        xyz: ArrayLike = (0, 0, 0),
        rpy: ArrayLike = (0, 0, 0),
        axis: str | None = None,
        limit: tuple[float, float, float, float] | None = None,
    ) -> None:
        """Add a joint; `limit` is lower, upper, effort and velocity."""
        element = ET.SubElement(self.robot, "joint", name=name, type=kind)
        ET.SubElement(element, "origin", xyz=_numbers(xyz), rpy=_numbers(rpy))
        ET.SubElement(element, "parent", link=parent)
        ET.SubElement(element, "child", link=child)
        if axis:
            ET.SubElement(element, "axis", xyz=axis)
        if limit:
            keys = ("lower", "upper", "effort", "velocity")
            ET.SubElement(element, "limit", {key: repr(float(value)) for key, value in zip(keys, limit, strict=True)})

    def text(self) -> str:
        """All of it."""
        ET.indent(self.robot)
        return ET.tostring(self.robot, encoding="unicode")


def with_collisions(text: str, shapes: Mapping[str, tuple[Shape, ...]]) -> str:
    """A robot's description with shapes that its links collide with, by link."""
    robot = ET.fromstring(text)  # nosec: composed by ourselves
    for link in robot.iter("link"):
        _collisions(link, shapes.get(link.get("name", ""), ()))
    ET.indent(robot)
    return ET.tostring(robot, encoding="unicode")


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
