"""Send a trajectory and wait until the joints have followed it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...sim.mechanics.robot_model import RobotModel
from ...sim.quantity import Quantities, quantity
from ...sim.world import JointTrajectory, Observation
from ..core.reasons import Reason, SkillFailure
from ..core.skill import Skill


@dataclass(frozen=True, kw_only=True)
class FollowTuning(Quantities):
    """When a trajectory has been followed, and when it has failed."""

    tolerance: float = quantity(0.05, "rad", "largest error of a joint at the end", "choice: the hand is 3 cm off")
    patience: float = quantity(2.0, "s", "for the joints to arrive after the trajectory's end", "choice: arms lag")
    min_motion: float = quantity(
        0.2, "1", "share of the way below which nothing has moved", "choice: tells a lost command from a blocked motion"
    )


FOLLOW = FollowTuning()


def joint_values(robot: RobotModel, observation: Observation, joints: tuple[str, ...]) -> np.ndarray:
    """Measured angles (n,) of named joints of a robot [rad]."""
    places = [robot.place_of(joint) for joint in joints]
    return np.array([observation.head_pan if place is None else observation.arm_positions[place] for place in places])


def follow(
    skill: Skill,
    trajectory: JointTrajectory,
    *,
    tolerance: float = FOLLOW.tolerance,
    patience: float = FOLLOW.patience,
    retreat: bool = False,
    tuning: FollowTuning = FOLLOW,
) -> Iterator[None]:
    """Send `trajectory` and wait until it is done and has arrived; used with `yield from`.

    Args:
        skill: that moves.
        trajectory: may run slower than asked for, as far as the guard slows it.
        tolerance: largest error of a joint at the end [rad].
        patience: how long the joints may take to arrive after the trajectory's end [s].
        retreat: the motion takes load off the person.
        tuning: what tells a lost command from a blocked motion.

    Raises:
        SkillFailure: COMMAND_LOST when nothing moved, MOTION_BLOCKED when it did not arrive.
    """
    robot = skill.world.robot
    start = joint_values(robot, skill.world.observe(), trajectory.joints)
    goal = np.asarray(trajectory.positions, float)[-1]
    sent = skill.world.send(trajectory, retreat=retreat)
    assert isinstance(sent, JointTrajectory)
    yield from skill.wait(float(sent.times[-1]))
    end = skill.now() + patience
    while (
        error := float(np.abs(joint_values(robot, skill.world.observe(), trajectory.joints) - goal).max())
    ) > tolerance:
        if skill.now() >= end:
            moved = float(np.abs(joint_values(robot, skill.world.observe(), trajectory.joints) - start).max())
            lost = moved < tuning.min_motion * float(np.abs(goal - start).max())
            raise SkillFailure(Reason.COMMAND_LOST if lost else Reason.MOTION_BLOCKED, f"{error:.2f} rad short")
        yield
