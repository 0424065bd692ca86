"""The base in motion: a generator that skills use with `yield from`.

    yield from drive_to(self, "bed_right")                     # a waypoint of the map, round what is in the way
    yield from drive_to(self, np.array((0.8, 0.3, -1.57)))     # x, y [m], yaw [rad] in the map
    yield from drive_to(self, pose, straight=True, speed=0.2)  # the straight line, whatever the map says
    yield from stand_for(self, "right", point)                 # to where that hand reaches `point` with ease

Loads on the hands still count: the guard stops the base when the cloth pulls too hard.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ...sim.mechanics.planar import planar_pose
from ...sim.quantity import Quantities, quantity
from ...sim.world import SIDES, BaseVelocity, Side
from ..core.reasons import Reason, SkillFailure
from ..core.skill import Skill
from ..motion.drive import PathFollower
from ..motion.errors import PathBlocked
from ..motion.path import path_length, plan_path


@dataclass(frozen=True, kw_only=True)
class BaseTuning(Quantities):
    """Numbers of driving the base and of choosing where to stand."""

    speed: float = quantity(
        0.5, "m/s", "of the base", "choice: half of what a Ridgeback can do by its datasheet, for indoors"
    )
    ease: tuple[float, float] = quantity(
        (0.95, 0.22),
        "m",
        "ahead of the base's centre and to the hand's own side, where a hand turns freely",
        "choice: middle of the workspace of an arm",
    )
    stand_tolerance: float = quantity(
        0.06, "m", "from a place to stand at which the base stays where it is", "choice: within the arm's ease"
    )
    stuck_time: float = quantity(
        2.0, "s", "without motion after which the base does not obey", "choice: longer than it takes to start"
    )
    min_motion: float = quantity(
        0.01, "m or rad", "that counts as motion of the base", "choice: above the noise of where it is"
    )
    timeout: float = quantity(20.0, "s", "for any path, however short", "choice: turning round and settling")
    timeout_factor: float = quantity(
        4.0, "1", "of the time that the path would take at full speed, added to that", "choice: the guard slows it"
    )
    settle_time: float = quantity(0.2, "s", "after arrival", "choice: the last command runs out")
    wide: float = quantity(
        0.35,
        "m",
        "that a base with empty hands goes back where the guard stopped it beside the person, before it goes round",
        "choice: the hands ahead are then beyond an arm that is raised beside the bed (131)",
    )


BASE = BaseTuning()


def waypoint(skill: Skill, goal: str | np.ndarray) -> np.ndarray:
    """Pose (3,) of a waypoint's name, or the pose itself.

    Raises:
        PathBlocked: the map has no such waypoint.
    """
    if not isinstance(goal, str):
        return np.asarray(goal, float)
    known = skill.world.room.waypoints
    if goal not in known:
        raise PathBlocked(f"the map has no waypoint {goal!r}; it has {', '.join(known) or 'none'}")
    return np.asarray(known[goal], float)


def drive_to(
    skill: Skill,
    goal: str | np.ndarray,
    *,
    speed: float = BASE.speed,
    straight: bool = False,
    via: Sequence[np.ndarray] = (),
    turn_from: float = np.inf,
    retreat: bool = False,
    tuning: BaseTuning = BASE,
) -> Iterator[None]:
    """Drive the base to a waypoint or pose, turning on the way; both hands are carried along.

    Where the guard stops it, as a link comes too near to the person, a base whose hands hold nothing goes back once,
    away from what it faces, and goes on from there.

    Args:
        skill: that drives.
        goal: name of a waypoint, or pose (3,) in the map: x, y [m], yaw [rad].
        speed: of the base [m/s]; the guard slows it near the person.
        straight: do not plan round obstacles, for short slides beside the bed.
        via: places (2,) in the map on such a slide, whose corners are rounded by a few cm [m].
        turn_from: distance to the end at which turning begins [m].
        retreat: the motion takes load off the person.
        tuning: when it has failed.

    Raises:
        PathBlocked: no free way, or no such waypoint.
        SkillFailure: COMMAND_LOST when the base does not move, TIMEOUT when it never arrives.
    """
    goal = waypoint(skill, goal)

    def drive() -> Iterator[None]:
        start = skill.world.observe().pose_base_in_map
        path = np.stack((start[:2], *via, goal[:2])) if straight else plan_path(skill.world.room, start, goal)
        follower = PathFollower(path, float(goal[2]), skill.world.robot.limits, speed=speed, turn_from=turn_from)
        return _along(skill, follower, path, start, goal, speed, retreat=retreat, tuning=tuning)

    try:
        yield from drive()
    except _Held:
        if straight or any(skill.context.guard.grip(side) != "nothing" for side in SIDES):
            raise
        x, y, yaw = skill.world.observe().pose_base_in_map
        back = np.array((x - tuning.wide * math.cos(yaw), y - tuning.wide * math.sin(yaw), yaw))
        yield from drive_to(skill, back, straight=True, speed=speed, retreat=True, tuning=tuning)
        yield from drive()
    yield from skill.wait(tuning.settle_time)


class _Held(SkillFailure):
    """The guard lets the base go no farther."""


def _along(
    skill: Skill,
    follower: PathFollower,
    path: np.ndarray,
    start: np.ndarray,
    goal: np.ndarray,
    speed: float,
    *,
    retreat: bool,
    tuning: BaseTuning,
) -> Iterator[None]:
    end = skill.now() + tuning.timeout + tuning.timeout_factor * path_length(path) / speed
    anchor, since, held = start, skill.now(), False
    while not follower.done(pose := skill.world.observe().pose_base_in_map):
        if np.abs(pose - anchor).max() > tuning.min_motion:
            anchor, since = pose, skill.now()
        if skill.now() - since > tuning.stuck_time:
            failure = _Held if held else SkillFailure
            raise failure(Reason.COMMAND_LOST, f"the base stands at {np.round(pose[:2], 2).tolist()} m")
        if skill.now() > end:
            raise SkillFailure(Reason.TIMEOUT, f"the base is still {np.linalg.norm(goal[:2] - pose[:2]):.2f} m away")
        sent = skill.world.send(follower.command(pose), retreat=retreat)
        held = isinstance(sent, BaseVelocity) and not np.any(np.abs(sent.velocity) > tuning.min_motion)
        yield


def stand_for(skill: Skill, side: Side, position_in_map: np.ndarray, *, tuning: BaseTuning = BASE) -> Iterator[None]:
    """Drive without turning to where the hand on `side` reaches a position (3,) [m] with ease.

    Raises:
        PathBlocked: the base cannot stand there.
        SkillFailure: COMMAND_LOST when the base does not move.
    """
    pose = skill.world.observe().pose_base_in_map
    ahead, aside = tuning.ease
    offset = planar_pose(pose)[:2, :2] @ np.array((ahead, aside if side == "left" else -aside))
    goal = np.append(np.asarray(position_in_map)[:2] - offset, pose[2])
    if np.linalg.norm(goal[:2] - pose[:2]) > tuning.stand_tolerance:
        yield from drive_to(skill, goal, speed=tuning.speed, tuning=tuning)
