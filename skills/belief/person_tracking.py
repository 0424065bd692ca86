"""Where the person is while the robot works: the arms tracked from the head camera, the guard told of every change.

    posture = watch_arm(self, "right")                       # looks when the last look is older than PERIOD
    posture = watch_arm(self, "right", hold=Hold("left", 0.9))  # the left hand holds the arm near the elbow
    see_person(self)                                         # both arms, head and trunk, as far as they are seen

A look costs about 20 ms of computing, so skills that tick faster share one look for several ticks.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from ...perception.errors import PerceptionFailure, Problem
from ...perception.estimates import ArmPosture, Head
from ...perception.image.projection import pixels_of
from ...perception.image.surfaces import Surface, surfaces
from ...perception.person.arm_fit import turned_about_shoulder
from ...sim.world import SIDES, Frame, Side
from ..core.skill import Skill
from ..geometry.arm_path import ArmPath
from ..geometry.hold import Hold

PERIOD = 0.25  # between two looks [s]
SEARCHING = 2.0  # between two searches for an arm that does not show where it was, 0.3 s of computing each [s]
PATIENCE = 300.0  # an arm under the gown, which its owner cannot move, is taken to stay for this long [s]
VISIBLE = 0.75  # share of the arm that has to be in view for a picture to count
_BEHIND = 0.06  # a sample of the axis this far behind what is seen is hidden [m]
NEAR_SPEED, _NEAR = 0.13, 0.34  # of a hand this near to the person; the guard's limits are 0.135 and 0.30 [m/s], [m]
_ARM_RADIUS, _TRUNK_RADIUS, _HEAD_RADIUS = 0.05, 0.16, 0.11  # [m]
_CROWN_TO_SHOULDER, _TRUNK, _LEGS = 0.31, 0.55, 0.85  # along the body [m]


@dataclass
class Watch:
    """What was seen of the person last, shared by the skills of a run.

    Attributes:
        arms: latest posture by the person's side.
        seen: when that arm was last seen or felt [s].
        looked: when the camera was last asked [s].
        searched: when that arm was last looked for elsewhere than where it was [s].
        parts: what the guard was told, chains of points (n, 3) with a radius [m].
    """

    arms: dict[Side, ArmPosture] = field(default_factory=dict)
    seen: dict[Side, float] = field(default_factory=dict)
    looked: float = -np.inf
    searched: dict[Side, float] = field(default_factory=dict)
    parts: dict[str, tuple[np.ndarray, float]] = field(default_factory=dict)


def watch_of(skill: Skill) -> Watch:
    """The run's memory of the person."""
    return skill.context.memory.of(Watch, Watch)


def watch_arm(
    skill: Skill, side: Side, *, hold: Hold | None = None, period: float = PERIOD, patience: float = PATIENCE
) -> ArmPosture:
    """Posture of one arm, no older than `period` [s] when the arm can be seen.

    Args:
        skill: that asks.
        side: of the person.
        hold: the hand that holds this arm, if one does.
        period: between two looks; 0 looks at once [s].
        patience: how long an arm that cannot be seen counts as staying where it was [s].

    Raises:
        PerceptionFailure: it was never found, or has been lost for longer than `patience`.
        SensorLost: the camera is dead.
        SkillFailure: its picture is stale.
    """
    watch, now = watch_of(skill), skill.now()
    if side not in watch.arms or now - watch.looked >= period:
        watch.looked = now
        frame = skill.world.look("head")
        if hold is not None and side in watch.arms:
            # looked for where it was, a moving arm has something in front of it, and is never found again
            points = turned_about_shoulder(watch.arms[side].points_in_map, hold.place, _held_at(skill, hold))
            watch.arms[side] = replace(watch.arms[side], points_in_map=points)
        try:
            if side not in watch.arms or visible_share(frame, watch.arms[side]) >= VISIBLE:
                _take(skill, frame, side, hold)
            elif hold is not None or now - watch.searched.get(side, -np.inf) < SEARCHING:
                raise PerceptionFailure(Problem.ARM_LOST, f"{side} arm")
            else:
                watch.searched[side] = now
                _keep(skill, side, skill.context.senses.relocalised_arm(frame, side=side))
        except PerceptionFailure:
            if now - watch.seen.get(side, -np.inf) > patience:
                raise
    return watch.arms[side]


def visible_share(frame: Frame, posture: ArmPosture) -> float:
    """Share of an arm in front of which a picture shows nothing: under cloth, a tracker follows what is not the arm."""
    path = ArmPath.of(posture)
    axis = np.array([path.point(float(place)) for place in np.linspace(0.3, 3.0, 28)])
    rows, columns, depth, inside = pixels_of(frame, axis)
    seen = frame.depth[rows, columns]
    skin = surfaces(frame.rgb)[rows, columns] == Surface.SKIN  # an arm in front of where it was is not hidden
    return float((inside & (skin | (seen > depth - _BEHIND))).mean())


def see_person(skill: Skill) -> list[Side]:
    """Look once and tell the guard of everything that is seen; returns the arms found.

    Raises:
        PerceptionFailure: nobody is seen at all.
        SensorLost: the camera is dead.
        SkillFailure: its picture is stale.
    """
    frame, found = skill.world.look("head"), []
    watch_of(skill).looked = skill.now()
    for side in SIDES:
        try:
            _take(skill, frame, side, None)
            found.append(side)
        except PerceptionFailure:
            continue
    try:
        _tell_body(skill, skill.context.senses.head(frame))
    except PerceptionFailure:
        if not found:
            raise PerceptionFailure(Problem.NOTHING_SEEN, "person") from None
    return found


def _take(skill: Skill, frame: Frame, side: Side, hold: Hold | None) -> None:
    """Update one arm from a frame and tell the guard."""
    if hold is None:
        posture = skill.context.senses.arm(frame, side=side)
    else:
        posture = skill.context.senses.arm(
            frame, side=side, grip_in_map=_held_at(skill, hold), arm_coordinate=hold.place
        )
    _keep(skill, side, posture)


def _keep(skill: Skill, side: Side, posture: ArmPosture) -> None:
    """Remember one arm as it was seen now and tell the guard."""
    watch = watch_of(skill)
    watch.arms[side], watch.seen[side] = posture, skill.now()
    _tell(skill, f"{side} arm", posture.points_in_map, _ARM_RADIUS)


def _held_at(skill: Skill, hold: Hold) -> np.ndarray:
    return skill.world.observe().pose_hand_in_map[SIDES.index(hold.hand), :3, 3]


def _tell_body(skill: Skill, head: Head) -> None:
    crown, middle = head.crown_in_map, head.middle
    level = skill.world.room.bed[1, 2] + 0.11
    shoulders = crown[1] + _CROWN_TO_SHOULDER
    trunk = np.array([(middle, shoulders + down, level) for down in (0.0, _TRUNK, _TRUNK + _LEGS)])
    _tell(skill, "trunk", trunk, _TRUNK_RADIUS)
    _tell(skill, "head", np.array((crown + (0.0, _HEAD_RADIUS, 0.0), (middle, shoulders, level))), _HEAD_RADIUS)


def _tell(skill: Skill, part: str, points: np.ndarray, radius: float) -> None:
    skill.context.guard.update_person(points, part=part, radius=radius)
    watch_of(skill).parts[part] = points, radius


def careful(skill: Skill, fast: float) -> Callable[[np.ndarray], float]:
    """A limit on a hand's speed [m/s] by its place (3,): `fast` in the open, slow near the person.

    Planned with it, a motion is slow only where it must be; the guard would slow all of it.
    """
    parts = list(watch_of(skill).parts.values())

    def limit(place: np.ndarray) -> float:
        near = any(_gap(place, points) < radius + _NEAR for points, radius in parts)
        return min(fast, NEAR_SPEED) if near or not parts else fast

    return limit


def _gap(place: np.ndarray, points: np.ndarray) -> float:
    """Distance from a place (3,) to a chain of points (n, 3) [m]."""
    start, edge = points[:-1], np.diff(points, axis=0)
    share = np.clip(np.einsum("ij,ij->i", place - start, edge) / np.maximum((edge**2).sum(axis=1), 1e-12), 0.0, 1.0)
    return float(np.linalg.norm(start + share[:, None] * edge - place, axis=1).min())
