"""Two UR5 arms with Robotiq 2F-85 grippers on a column of the same base that carries Baxter.

The arms are those of `ur5_robot.urdf` in `example-robot-data`, which has no UR5e.  An arm of six joints reaches a place
in up to eight ways, and cannot go from one of them to another where it stands; so the joints' ranges leave one of them.

Mount and way were looked for together: of some 20,000 places and turns of the foot and all eight ways, this is about
the one that keeps the hand poses of Baxter's dressing, in its base's frame, farthest from singular postures.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import dataclass

import numpy as np

from ..mechanics.robot_model import MotionLimits, RobotModel
from ..mechanics.shape import LinkCapsule, Shape
from ..world import CAMERAS, SIDES
from . import model
from .link_capsules import finger_capsules, of_capsule, palm_capsules, upright_capsules
from .shapes import BLACK, STEEL, base_box, finger_shapes, palm_shapes
from .urdf_parts import UrdfParts, description

ARM_JOINTS = tuple(
    f"{name}_joint" for name in ("shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3")
)
_LINKS = ("base", "shoulder", "upper_arm", "forearm", "wrist_1", "wrist_2", "wrist_3")
LIMBS = ("upper_arm_link", "forearm_link", "wrist_1_link", "wrist_2_link", "wrist_3_link", "gripper")
_DISTAL, _HAND = LIMBS[1:], LIMBS[3:]  # these can meet the robot's own body, and those their own upper arm
_FIXED = ("torso", "base", "head")
_ACROSS = (np.pi / 2, 0.0, 0.0)  # along the link's y axis
_COLUMN = 0.10  # its middle, behind the feet of the arms [m]


@dataclass(frozen=True, kw_only=True)
class Mount:
    """How the arms are bolted on: at the ends of a beam, high and leaning outwards, so that hands work low and near.

    Attributes:
        place: of the left arm's foot in the base frame; the right one's is its mirror image [m].
        tilt: of its first axis, outwards from the vertical [rad].
    """

    place: tuple[float, float, float] = (0.10, 0.33, 1.20)
    tilt: float = float(np.deg2rad(50.0))


def mirrored(angles: np.ndarray) -> np.ndarray:
    """Angles (..., 6) of the other arm that are a mirror image [rad]."""
    return np.array((-np.pi, -np.pi, 0.0, np.pi, 0.0, -np.pi)) - angles


MOUNT = Mount()
# Of the right arm [rad]: its elbow stays outside and bent one way, its wrist too.  A choice, as integrators set them:
# what a dressing takes and 0.3 or more beyond, but where elbow or wrist would stretch.  With the shoulder's lift only
# up to -1.2 no hand could hold a sleeve out before an arm that is 0.4 m up, as arms in the bullet world are.
_RIGHT = np.array(((-4.8, -2.0), (-4.4, -0.1), (-2.9, -0.05), (-2.6, 2.6), (0.05, 3.09), (-6.28, -0.3)))
RANGES = {"left": np.sort(mirrored(_RIGHT.T).T, axis=1), "right": _RIGHT}
HEAD_IN_BASE = np.array((0.10, 0.0, 1.54))  # as high as Baxter's, above the column
_HEAD_VELOCITY = 1.0  # [rad/s]


def compose(mount: Mount = MOUNT) -> str:
    """The whole robot as URDF text, without shapes."""
    source = ET.parse(description("ur5_robot.urdf")).getroot()
    links = {link.get("name"): link for link in source.findall("link")}
    joints = {joint.get("name"): joint for joint in source.findall("joint")}
    parts = UrdfParts("caretree_ur5_pair")
    parts.planar_base()
    parts.link("torso", 20.0, (0.2, 0.3, 0.8), (0.0, 0.0, -0.4))
    parts.joint("torso_mount", "fixed", "base", "torso", xyz=(mount.place[0] - _COLUMN, 0.0, mount.place[2]))
    parts.link("head", 1.0)
    limit = (-np.pi / 2, np.pi / 2, 50.0, _HEAD_VELOCITY)
    parts.joint("head_pan", "revolute", "base", "head", xyz=HEAD_IN_BASE, axis="0 0 1", limit=limit)
    parts.head_camera()
    for side, sign in zip(SIDES, (1.0, -1.0), strict=True):
        for name in _LINKS:
            parts.given_link(f"{side}_{name}_link", links[f"{name}_link"])
        x, y, z = mount.place
        foot = f"{side}_base_link"
        parts.joint(f"{side}_mount", "fixed", "base", foot, xyz=(x, sign * y, z), rpy=(-sign * mount.tilt, 0.0, 0.0))
        for name, (lower, upper) in zip(ARM_JOINTS, RANGES[side], strict=True):
            limit = parts.given_joint(joints[name], f"{side}_").find("limit")
            assert limit is not None
            limit.set("lower", repr(float(lower)))
            limit.set("upper", repr(float(upper)))
        parts.link(f"{side}_tool0")
        tool = joints["wrist_3_link-tool0_fixed_joint"]
        parts.given_joint(tool, f"{side}_")
        parts.gripper(side, f"{side}_tool0", 0.0)
    return parts.text()


def shapes() -> dict[str, tuple[Shape, ...]]:
    """Collision shapes of every link that has some: the arm's tubes as capsules."""
    column, foot = MOUNT.place[2] + 0.05 - model.BASE_SIZE[2], MOUNT.place[1]
    found: dict[str, tuple[Shape, ...]] = {
        "base": base_box(),
        "torso": (
            Shape(kind="box", size=(0.16, 0.16, column), xyz=(0.0, 0.0, 0.05 - column / 2), rgb=STEEL),
            Shape(kind="box", size=(0.10, 2 * foot - 0.06, 0.10), xyz=(_COLUMN, 0.0, -0.05), rgb=STEEL),
        ),
        "head": (Shape(kind="capsule", size=(0.06, 0.04), xyz=(0.12, 0.0, 0.08), rgb=BLACK),),
    }
    arm = {
        "shoulder_link": Shape(kind="capsule", size=(0.06, 0.08), xyz=(0.0, 0.07, 0.0), rpy=_ACROSS),
        "upper_arm_link": Shape(kind="capsule", size=(0.06, 0.40), xyz=(0.0, 0.0, 0.21)),
        "forearm_link": Shape(kind="capsule", size=(0.05, 0.36), xyz=(0.0, 0.0, 0.19)),
        "wrist_1_link": Shape(kind="capsule", size=(0.045, 0.07), xyz=(0.0, 0.06, 0.0), rpy=_ACROSS),
        "wrist_2_link": Shape(kind="capsule", size=(0.045, 0.06), xyz=(0.0, 0.0, 0.05)),
        "wrist_3_link": Shape(kind="capsule", size=(0.04, 0.03), xyz=(0.0, 0.045, 0.0), rpy=_ACROSS),
    }
    for side in SIDES:
        found |= {f"{side}_{link}": (shape,) for link, shape in arm.items()}
        found[f"{side}_gripper"] = palm_shapes()
        found |= {f"{side}_finger_{letter}_link": finger_shapes(sign) for letter, sign in (("a", 1.0), ("b", -1.0))}
    return found


def own_pairs() -> tuple[tuple[str, str], ...]:
    """Links that could touch each other."""
    pairs = [(f"left_{a}", f"right_{b}") for a in LIMBS for b in LIMBS]
    for side in SIDES:
        other = SIDES[1 - SIDES.index(side)]
        pairs += [(f"{side}_{a}", b) for a in _DISTAL for b in _FIXED]
        pairs += [(f"{side}_upper_arm_link", b) for b in ("torso", "head")]
        pairs += [(f"{side}_{a}", f"{other}_shoulder_link") for a in _DISTAL]
        pairs += [(f"{side}_{a}", f"{side}_{b}") for a in _HAND for b in ("shoulder_link", "upper_arm_link")]
    return tuple(pairs)


def capsules() -> tuple[LinkCapsule, ...]:
    """Of each arm from the shoulder to the fingers, then column and head; the last of the wrist is called `wrist_2`."""
    made, named = shapes(), ("shoulder", "upper_arm", "forearm", "wrist_0", "wrist_1", "wrist_2")
    links = ("shoulder_link", *LIMBS[:-1])
    found: list[LinkCapsule] = []
    for side in SIDES:
        found += [
            of_capsule(f"{side}_{name}", f"{side}_{link}", made[f"{side}_{link}"][0])
            for name, link in zip(named, links, strict=True)
        ]
        found += palm_capsules(side)
        found += finger_capsules(side)
    found += upright_capsules("torso", "torso", made["torso"][0])
    return (*found, of_capsule("head", "head", made["head"][0]))


# Hands where Baxter's are in the same postures, the one way to reach that.  Left and right are mirror images.
_RIGHT_READY = np.array((-3.121, -2.069, -2.016, -0.533, 0.962, -4.429))
_RIGHT_HELD_UP = np.array((-2.408, -2.397, -1.350, -1.639, 0.965, -3.761))
READY = np.array((mirrored(_RIGHT_READY), _RIGHT_READY))
HELD_UP = np.array((mirrored(_RIGHT_HELD_UP), _RIGHT_HELD_UP))

UR5_PAIR = RobotModel(
    name="ur5-pair",
    urdf=compose,
    arm_joints=ARM_JOINTS,
    ready=READY,
    held_up=HELD_UP,
    hands={side: f"{side}_hand" for side in SIDES},
    fingers={side: model.finger_joints(side) for side in SIDES},
    gripper=model.GRIPPER,
    base_joints=model.BASE_JOINTS,
    head_joint=model.HEAD_JOINT,
    neck_in_base=HEAD_IN_BASE,
    cameras={camera: f"{camera}_camera" for camera in CAMERAS},
    limits=MotionLimits(
        arm_acceleration=np.full(6, 1.5),
        motion_torque=np.array((6.0, 6.0, 6.0, 3.0, 3.0, 3.0)),
        head_velocity=_HEAD_VELOCITY,
        head_acceleration=2.0,
        base_velocity=model.BASE_VELOCITY,
        base_acceleration=model.BASE_ACCELERATION,
        hand_velocity=model.HAND_VELOCITY,
        hand_acceleration=model.HAND_ACCELERATION,
        sources={
            "arm_acceleration": "choice: the 1.4 rad/s^2 (80 degrees/s^2) that a UR's teach pendant offers, about",
            "motion_torque": "choice: as Baxter's; these accelerations take 5.5 N m in the median posture",
            "head_velocity": "choice: as Baxter's",
            "head_acceleration": "choice: it starts and stops gently",
            "base_velocity": "datasheet: Ridgeback, 1.1 m/s at most; half of that indoors beside a bed",
            "base_acceleration": "choice: it starts and stops gently",
            "hand_velocity": "choice: near the person the guard slows it",
            "hand_acceleration": "choice: it starts and stops gently",
        },
    ),
    shapes=shapes(),
    limbs=LIMBS,
    own_pairs=own_pairs(),
    capsules=capsules(),
)
