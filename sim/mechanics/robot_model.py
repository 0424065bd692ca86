"""What a robot is made of, as data: skills plan with it, whichever robot it is.

    skill.world.robot.ready              # (2, n) joint angles
    kinematics_of(skill.world.robot)     # where its hands are; `kinematics.py`

A robot has two arms of the same kind on a base that drives any way, two fingers on each, and a camera that pans.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields

import numpy as np

from ..errors import CaretreeError
from .gripper import GripperFacts
from .shape import LinkCapsule, Shape

ARMS = ("left", "right")
RADIUS_MAX = 0.5  # [m] of a capsule; millimetres would be a thousand times that


class RobotError(CaretreeError):
    """What is described is no robot that the tree can move."""


@dataclass(frozen=True, kw_only=True, eq=False)
class MotionLimits:
    """How fast a robot moves, beside the positions and velocities of joints, which its URDF has.

    Attributes:
        arm_acceleration: (n,) of an arm's joints [rad/s^2].
        motion_torque: (n,) that a simulated motor may take for its own motion, beside carrying its arm and what the
            hand presses with [N m].
        head_velocity: [rad/s].
        head_acceleration: [rad/s^2].
        base_velocity: along the floor and turning [m/s, rad/s].
        base_acceleration: [m/s^2, rad/s^2].
        hand_velocity: of a `HandTwist` [m/s, rad/s].
        hand_acceleration: of a `HandTwist` [m/s^2, rad/s^2].
        sources: where each of these numbers comes from.
    """

    arm_acceleration: np.ndarray
    motion_torque: np.ndarray
    head_velocity: float
    head_acceleration: float
    base_velocity: np.ndarray
    base_acceleration: np.ndarray
    hand_velocity: np.ndarray
    hand_acceleration: np.ndarray
    sources: Mapping[str, str]

    def __post_init__(self) -> None:
        """Refuse a limit that is none, and a number without a source."""
        for name in (each.name for each in fields(self) if each.name != "sources"):
            value = np.asarray(getattr(self, name), float)
            if not (np.isfinite(value).all() and (value > 0.0).all()):
                raise RobotError(f"the limit {name} is {value.tolist()}, but more than 0 is asked for")
            if not self.sources.get(name, "").strip():
                raise RobotError(f"the limit {name} has no source: say where {value.tolist()} comes from")


@dataclass(frozen=True, kw_only=True, eq=False)
class RobotModel:
    """A robot with two arms of n joints each.

    Attributes:
        name: as on the command line.
        urdf: its description as text, without shapes; asked for when first needed.  Its root is the link `map`, which
            the planar base joints move on; every arm's joint is called `left_` or `right_` and its name here.
        arms: of the robot; both of them.
        arm_joints: (n,) names of an arm's joints, shoulder to wrist, without the side.
        ready: (2, n) both hands before the chest, palms forward and elbows out: where a search begins [rad].
        held_up: (2, n) each hand held up before the head camera, fingertips down [rad].
        hands: by side, link between the fingertips (z out of the palm, y along the closing direction).
        fingers: by side, the two prismatic joints, each of which opens by half of the opening.
        gripper: the facts about it.
        base_joints: along x and y of the map, and about z.
        head_joint: that pans the head.
        neck_in_base: (3,) where the head turns [m].
        cameras: by name, link whose frame is optical (x right, y down, z forward).
        limits: of its motion.
        shapes: of every link that can touch something, by link.
        limbs: links of an arm, without the side, that keep off the room's boxes.
        own_pairs: links that could touch each other.
        capsules: of every link above the base.  An arm's begin with its side, and by "finger" and "palm" in their
            names, and "wrist_2" for the last of the wrist, it is told how near to the person they may come.

    Raises:
        RobotError: what is described is no such robot.
    """

    name: str
    urdf: Callable[[], str]
    arms: tuple[str, ...] = ARMS
    arm_joints: tuple[str, ...]
    ready: np.ndarray
    held_up: np.ndarray
    hands: Mapping[str, str]
    fingers: Mapping[str, tuple[str, str]]
    gripper: GripperFacts
    base_joints: tuple[str, str, str]
    head_joint: str
    neck_in_base: np.ndarray
    cameras: Mapping[str, str]
    limits: MotionLimits
    shapes: Mapping[str, tuple[Shape, ...]]
    limbs: tuple[str, ...]
    own_pairs: tuple[tuple[str, str], ...]
    capsules: tuple[LinkCapsule, ...]

    def __post_init__(self) -> None:
        """Refuse what skills cannot plan with."""
        if len(self.arms) != len(ARMS):
            raise RobotError(
                f"the robot {self.name} has {_counted(len(self.arms), 'arm')}, but the skills move two, "
                f"{' and '.join(ARMS)}"
            )
        if tuple(self.arms) != ARMS:
            raise RobotError(f"the arms of {self.name} are {', '.join(self.arms)}, but {', '.join(ARMS)} is asked for")
        count = len(self.arm_joints)
        if count < 6 or len(set(self.arm_joints)) < count:
            raise RobotError(f"an arm of {self.name} has {count} joints, but six or more different ones are asked for")
        for what in ("ready", "held_up"):
            if np.shape(getattr(self, what)) != (2, count):
                shape = np.shape(getattr(self, what))
                raise RobotError(f"the posture {what} of {self.name} has shape {shape}, but {(2, count)} is asked for")
            if not np.isfinite(getattr(self, what)).all():
                raise RobotError(f"the posture {what} of {self.name} holds a number that is not finite")
        self._check_capsules()
        for what in ("arm_acceleration", "motion_torque"):
            if (shape := np.shape(getattr(self.limits, what))) != (count,):
                raise RobotError(f"{what} of {self.name} has shape {shape}, but {(count,)} is asked for")

    def _check_capsules(self) -> None:
        """Refuse capsules by which nothing would be kept off the person."""
        for capsule in self.capsules:
            if not (0.0 < capsule.radius < RADIUS_MAX and np.isfinite(capsule.ends).all()):
                raise RobotError(
                    f"the capsule {capsule.name} of {self.name} has a radius of {capsule.radius:g} m and its ends at "
                    f"{np.asarray(capsule.ends).tolist()} m, but finite ends and 0 to {RADIUS_MAX:g} m are asked for"
                )
        names = [capsule.name for capsule in self.capsules]
        for side in ARMS:
            for what in ("finger", "palm"):
                if not any(name.startswith(f"{side}_") and what in name for name in names):
                    raise RobotError(
                        f"no capsule of {self.name} has a name that begins with {side}_ and holds {what!r}: by these "
                        "names hands are kept off the person"
                    )

    @property
    def dof(self) -> int:
        """How many joints an arm has."""
        return len(self.arm_joints)

    def joints_of(self, side: str) -> tuple[str, ...]:
        """Full names (n,) of one arm's joints, shoulder to wrist."""
        return tuple(f"{side}_{joint}" for joint in self.arm_joints)

    @property
    def commanded_joints(self) -> tuple[str, ...]:
        """What a `JointTrajectory` may name: left arm, right arm, head."""
        return (*self.joints_of("left"), *self.joints_of("right"), self.head_joint)

    def place_of(self, joint: str) -> tuple[int, int] | None:
        """Row and column of an arm's joint in `Observation.arm_positions`, or None for any other joint."""
        side, _, name = joint.partition("_")
        if side in ARMS and name in self.arm_joints:
            return ARMS.index(side), self.arm_joints.index(name)
        return None


def _counted(number: int, what: str) -> str:
    words = {0: "no", 1: "one"}
    return f"{words.get(number, str(number))} {what}{'' if number == 1 else 's'}"
