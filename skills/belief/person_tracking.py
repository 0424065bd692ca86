"""Where the person is while the robot works: the arms tracked from the head camera, the guard told of every change.

    posture = watch_arm(self, "right")                       # looks when the last look is older than PERIOD
    posture = watch_arm(self, "right", hold=Hold("left", 0.9))  # the left hand holds the arm near the elbow
    see_person(self)                                         # both arms, head and trunk, as far as they are seen

A look costs about 20 ms of computing, so skills that tick faster share one look for several ticks.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field, replace

import numpy as np

from ...perception.errors import PerceptionFailure, Problem
from ...perception.estimates import ArmPosture
from ...perception.image.projection import pixels_of
from ...perception.image.surfaces import Surface, surfaces_at
from ...perception.person.arm_fit import turned_about_shoulder
from ...perception.person.lying_body import body_of
from ...perception.person.person_facts import PERSON
from ...sim.quantity import Quantities, quantity
from ...sim.world import SIDES, Frame, Side
from ..core.skill import Skill
from ..geometry.arm_path import ArmPath
from ..geometry.hold import Hold
from ..geometry.person_zone import body_parts


@dataclass(frozen=True, kw_only=True)
class PersonTrackingTuning(Quantities):
    """Numbers of tracking the person, and of what the guard is told."""

    period: float = quantity(0.25, "s", "between two looks", "choice: a look costs about 20 ms of computing")
    search_period: float = quantity(
        2.0, "s", "between two searches for an arm that is not where it was", "choice: each costs 0.3 s of computing"
    )
    patience: float = quantity(
        300.0,
        "s",
        "for which an arm that is hidden is taken to stay where it was",
        "choice: under the gown its owner cannot move it",
    )
    min_visible: float = quantity(
        0.75, "1", "share of the arm that has to be in view for a picture to count", "choice: a tracker follows cloth"
    )
    visible_from: float = quantity(
        0.3, "1", "arm coordinate from which the arm has to be in view", "choice: the gown covers the shoulder"
    )
    visible_to: float = quantity(3.0, "1", "arm coordinate up to which it has to be", "choice: the fingertip")
    hand_from: float = quantity(
        2.0,
        "1",
        "arm coordinate from which an arm that the gown hides shows whether it has stayed",
        "choice: the wrist",
    )
    visible_points: int = quantity(28, "1", "points of the arm's axis that are looked at", "choice: some cm apart")
    sure_deviation: float = quantity(
        0.035, "m", "of any joint, up to which an arm is known well", "choice: well enough to take the arm"
    )
    agrees_within: tuple[float, float] = quantity(
        (3.0, 0.12),
        "1, m",
        "of what is known well: deviations, and distance, of every joint of an arm that is seen less well",
        "measured: half hidden, an arm that had not moved was seen with its hand 0.11 m aside, and begun again (175)",
    )
    hidden_behind: float = quantity(
        0.06, "m", "behind what is seen, from which a point of the arm's axis is hidden", "choice: just over its radius"
    )
    near_speed: float = quantity(
        0.13, "m/s", "of a hand near the person", "choice: just below the 0.135 m/s that the guard commands at most"
    )
    near_distance: float = quantity(
        0.34, "m", "from the person's surface at which a hand is near", "choice: a little more than the guard's 0.30 m"
    )
    front_margin: float = quantity(
        0.005, "m", "of the chest's front above what is seen of it", "measured: 2 to 4 mm too low on seeds 0, 101, 105"
    )
    arm_radius: float = quantity(0.037, "m", "of an arm, as the guard is told", "choice: an adult's, without room")


PERSON_TRACKING = PersonTrackingTuning()


@dataclass
class Watch:
    """What was seen of the person last, shared by the skills of a run.

    Attributes:
        arms: latest posture by the person's side.
        seen: when that arm was last seen or felt [s].
        looked: when the camera was last asked [s].
        searched: when that arm was last looked for elsewhere than where it was [s].
        doubted: arms that have moved since, of which nothing is believed until they are seen anew.
        before: where doubted arms were; their shoulders are still there.
        front: (2,) heights of the chest's front above the mattress, at its highest and on the midline; the lowest that
            were seen, as cloth only adds to them [m].
        view: the head camera's last picture, and when it was asked for [s].
    """

    arms: dict[Side, ArmPosture] = field(default_factory=dict)
    seen: dict[Side, float] = field(default_factory=dict)
    looked: float = -np.inf
    searched: dict[Side, float] = field(default_factory=dict)
    doubted: set[Side] = field(default_factory=set)
    before: dict[Side, ArmPosture] = field(default_factory=dict)
    front: np.ndarray | None = None
    view: tuple[float, Frame] | None = None


def watch_of(skill: Skill) -> Watch:
    """The run's memory of the person."""
    return skill.context.memory.of(Watch, Watch)


def head_view(skill: Skill) -> Frame:
    """The head camera's picture of now; those who ask within one tick share it.

    Raises:
        SensorLost: the camera is dead.
        SkillFailure: its picture is stale.
    """
    watch, now = watch_of(skill), skill.now()
    if watch.view is None or watch.view[0] != now:
        watch.view = now, skill.world.look("head")
    return watch.view[1]


def doubt_arms(skill: Skill) -> None:
    """The person has moved: their arms are unknown until each of them is found all over again."""
    watch = watch_of(skill)
    watch.doubted |= watch.arms.keys()
    watch.before.update(watch.arms)
    for side in watch.arms:
        skill.context.guard.zone.forget(f"{side} arm")
    watch.arms.clear()
    watch.seen.clear()


def watch_arm(
    skill: Skill,
    side: Side,
    *,
    hold: Hold | None = None,
    period: float = PERSON_TRACKING.period,
    patience: float = PERSON_TRACKING.patience,
    tuning: PersonTrackingTuning = PERSON_TRACKING,
) -> ArmPosture:
    """Posture of one arm, no older than `period` [s] when the arm can be seen.

    Args:
        skill: that asks.
        side: of the person.
        hold: the hand that holds this arm, if one does.
        period: between two looks; 0 looks at once [s].
        patience: how long an arm that cannot be seen counts as staying where it was [s].
        tuning: when an arm counts as seen, and how often it is looked for elsewhere.

    Raises:
        PerceptionFailure: it was never found, or has been lost for longer than `patience`.
        SensorLost: the camera is dead.
        SkillFailure: its picture is stale.
    """
    watch, now = watch_of(skill), skill.now()
    if side not in watch.arms or now - watch.looked >= period:
        watch.looked = now
        frame = head_view(skill)
        if hold is not None and side in watch.arms:
            # it has moved with the hand: where it was, it would count as hidden and be lost
            watch.arms[side] = _turned(skill, watch.arms[side], hold)
        try:
            if side not in watch.arms or visible_share(frame, watch.arms[side], tuning=tuning) >= tuning.min_visible:
                _take(skill, frame, side, hold, tuning)
            elif hold is not None:
                raise PerceptionFailure(Problem.ARM_LOST, f"{side} arm")
            else:
                _search(skill, frame, side, tuning)
        except PerceptionFailure:
            if side in watch.arms and hold is None and hand_share(frame, watch.arms[side]) >= tuning.min_visible:
                watch.seen[side] = now
            if now - watch.seen.get(side, -np.inf) > patience:
                raise
    return watch.arms[side]


def posture_in_hand(skill: Skill, side: Side, hold: Hold) -> ArmPosture | None:
    """An arm that a hand holds, by where the hand is, and its shoulder by where it was; None where it was never found.

    Whoever has moved still has the arm between the fingers: a hand that lowers it need not wait until it is found.

    Args:
        skill: that asks.
        side: of the person.
        hold: the hand that holds this arm.
    """
    watch = watch_of(skill)
    known = watch.arms.get(side, watch.before.get(side))
    return None if known is None else _turned(skill, known, hold)


def keep_with_hand(skill: Skill, side: Side, hold: Hold) -> None:
    """Take what is known of an arm along with the hand that holds it, before the hand lets go of it.

    Args:
        skill: that asks.
        side: of the person.
        hold: the hand that still holds this arm.
    """
    for known in (watch_of(skill).arms, watch_of(skill).before):
        if side in known:
            known[side] = _turned(skill, known[side], hold)


def take_from_hand(
    skill: Skill, side: Side, hold: Hold, *, tuning: PersonTrackingTuning = PERSON_TRACKING
) -> ArmPosture:
    """Posture of an arm where a hand has brought it, however little of it shows.

    A tracker that was not told of the way looks for the arm where it was before, and finds it there under cloth.

    Args:
        skill: that asks.
        side: of the person.
        hold: the hand that still holds this arm.
        tuning: what the guard is told.

    Raises:
        PerceptionFailure: it was never found.
        SensorLost: the camera is dead.
        SkillFailure: its picture is stale.
    """
    _take(skill, skill.world.look("head"), side, hold, tuning)
    return watch_of(skill).arms[side]


def swung_to(
    skill: Skill, side: Side, coordinate: float, place: np.ndarray, *, tuning: PersonTrackingTuning = PERSON_TRACKING
) -> ArmPosture:
    """Posture of an arm that has swung about its shoulder, as one place of it was seen closely; the guard is told.

    Args:
        skill: that has looked.
        side: of the person.
        coordinate: arm coordinate of what was seen.
        place: (3,) of the arm's axis there in the map [m].
        tuning: what the guard is told.
    """
    known = watch_of(skill).arms[side]
    posture = replace(known, points_in_map=turned_about_shoulder(known.points_in_map, coordinate, place))
    _keep(skill, side, posture, tuning, moves=True)
    return posture


def visible_share(frame: Frame, posture: ArmPosture, *, tuning: PersonTrackingTuning = PERSON_TRACKING) -> float:
    """Share of an arm in front of which a picture shows nothing: under cloth, a tracker follows what is not the arm.

    Args:
        frame: that may show the arm.
        posture: where the arm is, or was.
        tuning: where it is looked at, and when it is hidden.
    """
    axis = ArmPath.of(posture).at(np.linspace(tuning.visible_from, tuning.visible_to, tuning.visible_points))
    rows, columns, depth, inside = pixels_of(frame, axis)
    seen = frame.depth[rows, columns]
    skin = surfaces_at(frame.rgb, rows, columns) == Surface.SKIN  # an arm in front of where it was is not hidden
    return float((inside & (skin | (seen > depth - tuning.hidden_behind))).mean())


def bare_share(frame: Frame, posture: ArmPosture, *, tuning: PersonTrackingTuning = PERSON_TRACKING) -> float:
    """Share of an arm where a picture shows skin: cloth that lies right on it hides nothing by its depth."""
    axis = ArmPath.of(posture).at(np.linspace(tuning.visible_from, tuning.visible_to, tuning.visible_points))
    rows, columns, _, inside = pixels_of(frame, axis)
    return float((inside & (surfaces_at(frame.rgb, rows, columns) == Surface.SKIN)).mean())


def hand_share(frame: Frame, posture: ArmPosture, *, tuning: PersonTrackingTuning = PERSON_TRACKING) -> float:
    """Share of a hand that a picture shows where it was: an arm in its sleeve, whose hand does, has stayed.

    Args:
        frame: that may show the hand.
        posture: where the arm was.
        tuning: from where on it is looked at, and how far from there its skin may be.
    """
    axis = ArmPath.of(posture).at(np.linspace(tuning.hand_from, tuning.visible_to, tuning.visible_points))
    rows, columns, depth, inside = pixels_of(frame, axis)
    there = np.abs(frame.depth[rows, columns] - depth) < tuning.hidden_behind
    skin = surfaces_at(frame.rgb, rows, columns) == Surface.SKIN
    return float((inside & skin & there).mean())


def see_person(skill: Skill, *, tuning: PersonTrackingTuning = PERSON_TRACKING) -> list[Side]:
    """Look once and tell the guard of everything that is seen; returns the arms found.

    Raises:
        PerceptionFailure: nobody is seen at all.
        SensorLost: the camera is dead.
        SkillFailure: its picture is stale.
    """
    frame, watch, found = head_view(skill), watch_of(skill), []
    watch.looked = skill.now()
    for side in SIDES:
        try:
            if side in watch.arms and visible_share(frame, watch.arms[side], tuning=tuning) < tuning.min_visible:
                _search(skill, frame, side, tuning)
            else:
                _take(skill, frame, side, None, tuning)
            found.append(side)
        except PerceptionFailure:
            continue
    try:
        _tell_body(skill, frame, tuning)
    except PerceptionFailure:
        if not found:
            raise PerceptionFailure(Problem.NOTHING_SEEN, "person") from None
    return found


def _search(skill: Skill, frame: Frame, side: Side, tuning: PersonTrackingTuning) -> None:
    """Look for one arm elsewhere than where it was, every now and then, and tell the guard."""
    watch, now = watch_of(skill), skill.now()
    if now - watch.searched.get(side, -np.inf) < tuning.search_period:
        raise PerceptionFailure(Problem.ARM_LOST, f"{side} arm")
    watch.searched[side] = now
    _keep(skill, side, skill.context.senses.relocalised_arm(frame, side=side), tuning)


def _take(skill: Skill, frame: Frame, side: Side, hold: Hold | None, tuning: PersonTrackingTuning) -> None:
    """Update one arm from a frame and tell the guard."""
    if side in watch_of(skill).doubted:
        posture = skill.context.senses.relocalised_arm(frame, side=side, moved=True)
        watch_of(skill).doubted.discard(side)
    elif hold is None:
        posture = skill.context.senses.arm(frame, side=side)
    else:
        posture = skill.context.senses.arm(
            frame, side=side, grip_in_map=_held_at(skill, hold), arm_coordinate=hold.coordinate
        )
    _keep(skill, side, posture, tuning, moves=hold is not None)


def _keep(skill: Skill, side: Side, posture: ArmPosture, tuning: PersonTrackingTuning, *, moves: bool = False) -> None:
    """Remember one arm as it was seen now and tell the guard.

    Where too little of an arm shows, and what does agrees with how it was known, it has stayed: its owner cannot move
    it, and no hand `moves` it.
    """
    watch = watch_of(skill)
    known = watch.arms.get(side)
    if known is not None and not moves and _only_seen_less_well(known, posture, tuning):
        posture = replace(known, stamp=posture.stamp)
    watch.arms[side], watch.seen[side] = posture, skill.now()
    skill.context.guard.update_person(posture.points_in_map, part=f"{side} arm", radius=tuning.arm_radius)


def _only_seen_less_well(known: ArmPosture, seen: ArmPosture, tuning: PersonTrackingTuning) -> bool:
    if float(known.deviation.max()) > tuning.sure_deviation or float(seen.deviation.max()) <= tuning.sure_deviation:
        return False
    deviations, most = tuning.agrees_within
    off = np.linalg.norm(seen.points_in_map - known.points_in_map, axis=1)
    return bool((off <= np.minimum(deviations * np.maximum(seen.deviation, known.deviation), most)).all())


def _turned(skill: Skill, posture: ArmPosture, hold: Hold) -> ArmPosture:
    """An arm turned about its shoulder to where the hand that holds it is."""
    points = turned_about_shoulder(posture.points_in_map, hold.coordinate, _held_at(skill, hold))
    return replace(posture, points_in_map=points)


def _held_at(skill: Skill, hold: Hold) -> np.ndarray:
    return skill.world.observe().pose_hand_in_map[SIDES.index(hold.hand), :3, 3]


def _tell_body(skill: Skill, frame: Frame, tuning: PersonTrackingTuning) -> None:
    """Tell the guard of head, trunk and legs, as far as they follow from the head and the front of the chest."""
    head, mattress = skill.context.senses.head(frame), float(skill.world.room.bed[1, 2])
    body, watch = body_of(head, mattress), watch_of(skill)
    shoulders = np.array((body.middle, body.shoulder_y, mattress + PERSON.shoulder_height))
    with suppress(PerceptionFailure):
        chest = skill.context.senses.chest_front(frame, shoulders_in_map=shoulders)
        seen = np.array((chest.height, chest.breastbone)) + tuning.front_margin
        watch.front = seen if watch.front is None else np.minimum(watch.front, seen)
    front = {} if watch.front is None else {"front": float(watch.front[0]), "breastbone": float(watch.front[1])}
    parts = body_parts(head.middle, float(head.crown_in_map[1]), mattress, scale=body.scale, **front)
    for part, (points, radius) in parts.items():
        skill.context.guard.update_person(points, part=part, radius=radius)


def chest_top(skill: Skill) -> float:
    """Height of the front of the chest in the map, as the guard knows it; an adult's where it was not seen [m]."""
    front = watch_of(skill).front
    return float(skill.world.room.bed[1, 2]) + (PERSON.front_height if front is None else float(front[0]))


def careful(
    skill: Skill, fast: float, *, tuning: PersonTrackingTuning = PERSON_TRACKING
) -> Callable[[np.ndarray], np.ndarray]:
    """Limits (k,) on a hand's speed [m/s] at positions (k, 3) in the map: `fast` in the open, slow near the person.

    Planned with it, a motion is slow only where it must be; the guard would slow all of it.
    """
    zone = skill.context.guard.zone

    def limit(positions: np.ndarray) -> np.ndarray:
        return np.where(zone.distance(positions) < tuning.near_distance, min(fast, tuning.near_speed), fast)

    return limit
