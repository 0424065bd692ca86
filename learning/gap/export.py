"""The found effects in the robot's own file: URDF and MJCF say friction, damping, armature and mass of some of them.

The file is changed where the model says so and nowhere else: numbers are added to those there are, as an effect is what
the model lacked.  What such a file cannot say (an offset, a backlash, a delay) is returned, and stands in model.yaml.
"""

from __future__ import annotations

import json
import xml.etree.ElementTree as ET
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from ...sim.effects.joint.link_inertia import BODY_TERMS
from ...sim.effects.model_file import EffectModel, load_model
from .errors import GapError
from .joints.robot_files import find_urdf
from .own.find_system import find_system
from .own.system import System

# what the registry's effects are in a robot's file: name -> (what, parameter)
SAID = {
    "viscous_friction": ("damping", "coefficient"),
    "coulomb_friction": ("friction", "level"),
    "armature": ("armature", "inertia"),
}
MOMENTS = ("mass_com_x", "mass_com_y", "mass_com_z")  # first moments of an added mass [kg m]
INERTIA = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
IN_URDF = {"damping": "damping", "friction": "friction"}
IN_MJCF = {"damping": "damping", "friction": "frictionloss", "armature": "armature"}


class Change(NamedTuple):
    """A number to add.

    Attributes:
        what: `damping`, `friction`, `armature` of a joint; `mass` of a body; `link mass`, scaled with its inertia, or
            `point mass` of the link after a joint.
        target: joint or body.
        value: SI.
        at: where a point mass sits in the joint's frame [m].
    """

    what: str
    target: str
    value: float
    at: tuple[float, float, float] = (0.0, 0.0, 0.0)


def changes_of(model: EffectModel, system: System | None = None) -> tuple[list[Change], list[str]]:
    """What a robot's file can say of a model file, and the effects it cannot.

    Args:
        model: the checked model file.
        system: the user's simulator, where the model is of one.
    """
    own = {} if system is None else {e.key: (e.exports, e.parameters[0].name) for e in system.effects if e.exports}
    out: list[Change] = []
    left: list[str] = []
    for e in (*model.recalibration, *model.effects):
        said = own.get((e.name, e.target)) if system else SAID.get(e.name)
        if said:
            out.append(Change(said[0], e.target, e.parameters[said[1]]))
        elif system is None and e.name in BODY_TERMS and e.parameters["mass"]:
            mass = e.parameters["mass"]
            x, y, z = (e.parameters[k] / mass for k in MOMENTS)
            out.append(Change("point mass", e.target, mass, (x, y, z)))
        elif system is None and e.name == "mass":
            out.append(Change("link mass", e.target, e.parameters["mass"]))
        else:
            left.append(f"{e.name} on {e.target}")
    return out, left


def export(folder: Path, robot: str | None, to: Path) -> list[str]:
    """Write the robot file of a results folder's model, and say what it cannot hold.

    Args:
        folder: holds model.yaml.
        robot: file to start from; None takes the URDF that model.yaml names.
        to: file to write.

    Raises:
        GapError: there is nothing to start from, or it cannot be used.
    """
    file = folder / "model.yaml"
    model = load_model(file)
    simulator = model.base.get("simulator")
    if robot is None and "robot" not in model.base:
        raise GapError(f"{file}: names no robot, --robot must give a URDF or MJCF")
    source = Path(robot) if robot else find_urdf(str(model.base["robot"]), folder, *_set_of(folder))
    return write_robot_file(file, source, to, find_system(str(simulator)) if simulator else None)


def _set_of(folder: Path) -> list[Path]:
    """Folder of the measurement set that a results folder is of, where it says so."""
    try:
        return [Path(json.loads((folder / "find.json").read_text(encoding="utf-8"))["set"])]
    except (OSError, ValueError, KeyError, TypeError):
        return []


def write_robot_file(model: Path | str, source: Path | str, out: Path | str, system: System | None = None) -> list[str]:
    """Write a robot file with the effects of a model file in it.

    Args:
        model: model.yaml.
        source: URDF or MJCF (by its root element) the model was made with.
        out: file to write.
        system: the user's simulator, where the model is of one.

    Returns:
        Effects the format cannot say, as "name on target".

    Raises:
        EffectError: the model file cannot be read.
        GapError: the robot file cannot, or it has no such joint or body.
    """
    source, out = Path(source), Path(out)
    wanted, left = changes_of(load_model(model), system)
    try:
        tree = ET.parse(source, parser=ET.XMLParser(target=ET.TreeBuilder(insert_comments=True)))
    except (ET.ParseError, OSError) as error:
        raise GapError(f"{source}: no XML that can be read ({error})") from None
    root = tree.getroot()
    if root.tag not in ("robot", "mujoco"):
        raise GapError(f"{source}: its root is <{root.tag}>, a URDF has <robot> and an MJCF <mujoco>")
    for change in wanted:
        if not (_into_urdf if root.tag == "robot" else _into_mjcf)(source, root, change):
            left.append(f"{change.what} of {change.target}")
    out.parent.mkdir(parents=True, exist_ok=True)
    tree.write(out, encoding="utf-8", xml_declaration=root.tag == "robot")
    return left


def _into_urdf(source: Path, root: ET.Element, change: Change) -> bool:
    if change.what == "mass":
        link = _named(source, root.findall("link"), change.target, "link")
        return _scaled(source, link, change.value)
    joint = _named(source, root.findall("joint"), change.target, "joint")
    if change.what in ("link mass", "point mass"):
        child = joint.find("child")
        link = _named(source, root.findall("link"), "" if child is None else child.get("link", ""), "link")
        if change.what == "link mass":
            return _scaled(source, link, change.value)
        return _with_point(source, link, change)
    if change.what not in IN_URDF:
        return False
    dynamics = joint.find("dynamics")
    if dynamics is None:
        dynamics = ET.SubElement(joint, "dynamics", {"damping": "0", "friction": "0"})
    _add(source, dynamics, IN_URDF[change.what], change.value)
    return True


def _scaled(source: Path, link: ET.Element, more: float) -> bool:
    """Add mass to a link, its shape of mass kept."""
    mass, inertia = link.find("inertial/mass"), link.find("inertial/inertia")
    if mass is None or inertia is None:
        return False
    before = _number(source, mass, "value")
    _add(source, mass, "value", more)
    for name in INERTIA:
        inertia.set(name, f"{_number(source, inertia, name) * (before + more) / before:.9g}")
    return True


def _with_point(source: Path, link: ET.Element, change: Change) -> bool:
    """Add a point mass to a link: its mass, centre and inertia about the new centre, in the link's own directions."""
    inertial = link.find("inertial")
    if inertial is None:
        inertial = ET.SubElement(link, "inertial")
    parts = {}
    for tag in ("origin", "mass", "inertia"):
        found = inertial.find(tag)
        parts[tag] = ET.SubElement(inertial, tag) if found is None else found
    origin, mass, inertia = parts["origin"], parts["mass"], parts["inertia"]
    m, dm = _number(source, mass, "value"), change.value
    if m + dm <= 0.0:
        raise GapError(f"{source}: link {link.get('name')} weighs {m:g} kg, {-dm:g} kg cannot be taken from it")
    c, p = _numbers(source, origin, "xyz"), np.array(change.at)
    R = Rotation.from_euler("xyz", _numbers(source, origin, "rpy")).as_matrix()
    xx, xy, xz, yy, yz, zz = (_number(source, inertia, name) for name in INERTIA)
    about = R @ np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) @ R.T
    centre = (m * c + dm * p) / (m + dm)
    for part, away in ((m, c - centre), (dm, p - centre)):
        about = about + part * (away @ away * np.eye(3) - np.outer(away, away))
    origin.set("xyz", " ".join(f"{x:.9g}" for x in centre))
    origin.set("rpy", "0 0 0")
    mass.set("value", f"{m + dm:.9g}")
    for name, (i, j) in zip(INERTIA, ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)), strict=True):
        inertia.set(name, f"{about[i, j]:.9g}")
    return True


def _into_mjcf(source: Path, root: ET.Element, change: Change) -> bool:
    if change.what == "mass":
        body = _named(source, list(root.iter("body")), change.target, "body")
        inertial = body.find("inertial")
        if inertial is None:
            return False  # its mass follows from its shapes; there is no one number to change
        _add(source, inertial, "mass", change.value)
        return True
    if change.what not in IN_MJCF:
        return False  # a place in a URDF's joint frame is none in an MJCF body's
    joint = _named(source, [j for b in root.iter("body") for j in b.findall("joint")], change.target, "joint")
    _add(source, joint, IN_MJCF[change.what], change.value)
    return True


def _named(source: Path, elements: Sequence[ET.Element], name: str, kind: str) -> ET.Element:
    for element in elements:
        if element.get("name") == name:
            return element
    known = ", ".join(e.get("name") or "" for e in elements if e.get("name"))
    raise GapError(f"{source}: there is no {kind} named {name!r} (there are {known[:200]})")


def _add(source: Path, element: ET.Element, attribute: str, value: float) -> None:
    element.set(attribute, f"{_number(source, element, attribute) + value:.9g}")


def _number(source: Path, element: ET.Element, attribute: str) -> float:
    try:
        return float(element.get(attribute, "0"))
    except ValueError:
        raise GapError(f"{source}: {attribute}={element.get(attribute)!r} is no number") from None


def _numbers(source: Path, element: ET.Element, attribute: str) -> np.ndarray:
    """Three numbers of an attribute, zeros where it is absent."""
    try:
        x = np.array([float(v) for v in element.get(attribute, "0 0 0").split()])
    except ValueError:
        x = np.zeros(0)
    if x.shape != (3,):
        raise GapError(f"{source}: {attribute}={element.get(attribute)!r}, three numbers are needed")
    return x
