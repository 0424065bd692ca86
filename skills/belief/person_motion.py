"""A person who moves of their own accord, told from what the robot does to them.

    yield from while_person_rests(self, self._pull())  # fails with PERSON_MOVED on the tick on which they are noticed

Both arms are watched by the head's camera: skin leaves the place where it was, or where the hand that holds the arm has
taken it, faster than a sleeve drags an arm along.  An arm that a hand holds is felt as well: its pull on the hand jumps
although the hand did not move against it.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from ...perception.errors import PerceptionFailure
from ...sim.quantity import Quantities, quantity
from ...sim.world import SIDES, Frame, Side
from ..core.reasons import Reason, SkillFailure
from ..core.skill import Skill
from ..geometry.person_zone import distance_to_chain
from .person_tracking import doubt_arms, head_view, watch_of


@dataclass(frozen=True, kw_only=True)
class PersonMotionTuning(Quantities):
    """What counts as a motion of the person's own."""

    period: float = quantity(
        0.1, "s", "between two looks", "choice: every second tick, so that two looks fall within the 0.3 s allowed"
    )
    memory: float = quantity(
        0.3, "s", "age of the picture that is compared with, at most", "choice: two looks and a half"
    )
    max_shift: float = quantity(
        0.3,
        "1",
        "share of an arm's skin that may leave its place within `memory`",
        "measured: at most 0.08 in a stage of dressing in which nobody moved, at least 0.39 after 0.13 s of a swing by "
        "0.45 rad/s",
    )
    felt_memory: float = quantity(0.22, "s", "over which a jump of the pull is judged", "choice: three ticks")
    max_jump: float = quantity(
        19.0,
        "N",
        "jump of a held arm's pull within `felt_memory`, as far as the hand does not explain it",
        "measured: at most 14.5 N in a stage of dressing and two lifts, at least 24 N after 0.13 s of a push of 7 N m",
    )
    stiffness: float = quantity(
        20e3,
        "N/m",
        "jump that the hand's own way against it explains",
        "measured: a stiff arm held at the elbow answers with 7 N/mm; three times that, as it answers late",
    )
    at_hand: float = quantity(
        0.05, "m", "of an arm's axis from the fingertips, within which they may move it", "choice: between them"
    )
    held: float = quantity(
        0.15, "m", "of the axis of a held arm from the fingertips at most", "choice: more than its posture is off"
    )


PERSON_MOTION = PersonMotionTuning()


@dataclass(frozen=True)
class Felt:
    """A held arm's pull on a hand, and where the hand was.

    Attributes:
        time: [s].
        pull: (3,) force in the map [N].
        place: (3,) of the hand in the map [m].
        other: (3,) force on the robot's other hand in the map, which may meet the arm [N].
    """

    time: float
    pull: np.ndarray
    place: np.ndarray
    other: np.ndarray


@dataclass(frozen=True)
class Arm:
    """How one of the person's arms was.

    Attributes:
        points: (4, 3) shoulder, elbow, wrist, fingertip in the map [m].
        hand: of the robot that held it, or None.
        grip: (3,) where that hand was in the map [m].
    """

    points: np.ndarray
    hand: Side | None
    grip: np.ndarray


@dataclass(frozen=True)
class Seen:
    """A picture of the head's camera at a time [s], and how the arms were then, by the person's side."""

    time: float
    frame: Frame
    arms: dict[Side, Arm]


@dataclass
class PersonMotion:
    """What was felt and seen within the last moments of a run; shared by its skills."""

    felt: dict[Side, deque[Felt]] = field(default_factory=lambda: {side: deque() for side in SIDES})
    seen: deque[Seen] = field(default_factory=deque)


def while_person_rests(
    skill: Skill, motion: Iterator[None], *, tuning: PersonMotionTuning = PERSON_MOTION
) -> Iterator[None]:
    """Let `motion` go on as long as the person does not move.

    Args:
        skill: that moves.
        motion: of the robot at the person.
        tuning: what counts as a motion of theirs.

    Raises:
        SkillFailure: PERSON_MOVED, before anything else is commanded, and whatever `motion` raises.
    """
    notice_motion(skill, tuning=tuning)
    for _ in motion:
        yield
        notice_motion(skill, tuning=tuning)


def notice_motion(skill: Skill, *, tuning: PersonMotionTuning = PERSON_MOTION) -> None:
    """Feel and look; once the person has moved, nothing that was known of their arms is believed any more.

    Raises:
        SkillFailure: PERSON_MOVED.
        SensorLost: the camera is dead.
    """
    memory = skill.context.memory.of(PersonMotion, PersonMotion)
    told = _feel(skill, memory, tuning) or _look(skill, memory, tuning)
    if told is None:
        return
    memory.seen.clear()
    for felt in memory.felt.values():
        felt.clear()
    doubt_arms(skill)
    raise SkillFailure(Reason.PERSON_MOVED, told)


def unexplained_jump(felt: Sequence[Felt], stiffness: float) -> float:
    """Greatest change of a pull up to its last record, less what the robot itself has done to it [N].

    That is the hand's way against the change, and what the other hand pressed the arm with meanwhile: it comes back
    from there as the opposite force.

    Args:
        felt: records, oldest first.
        stiffness: of the arm [N/m].
    """
    greatest, last = 0.0, felt[-1]
    for before in felt:
        change = last.pull - before.pull
        size = float(np.linalg.norm(change))
        against = -(last.place - before.place) @ change / max(size, 1e-9)
        pressed = -(last.other - before.other) @ change / max(size, 1e-9)
        greatest = max(greatest, size - stiffness * max(float(against), 0.0) - max(float(pressed), 0.0))
    return greatest


def _feel(skill: Skill, memory: PersonMotion, tuning: PersonMotionTuning) -> str | None:
    """What a hand that holds an arm felt, if it was the person's doing."""
    observed = skill.world.observe()
    for n, hand in enumerate(SIDES):
        felt = memory.felt[hand]
        if skill.context.guard.grip(hand) != "arm":
            felt.clear()
            continue
        pull, other = observed.wrench_hand_in_map[n, :3], observed.wrench_hand_in_map[1 - n, :3]
        felt.append(Felt(observed.time, pull, observed.pose_hand_in_map[n, :3, 3], other))
        while felt[0].time < observed.time - tuning.felt_memory:
            felt.popleft()
        jump = unexplained_jump(felt, tuning.stiffness)
        if jump > tuning.max_jump:
            return f"the arm pushed the {hand} hand by {jump:.0f} N"
    return None


def _look(skill: Skill, memory: PersonMotion, tuning: PersonMotionTuning) -> str | None:
    """What the head's camera saw of an arm, if it was the person's doing."""
    now, seen = skill.now(), memory.seen
    if seen and now - seen[-1].time < tuning.period:
        return None
    arms = _arms(skill, tuning)
    if not arms:
        seen.clear()
        return None
    seen.append(Seen(now, head_view(skill), arms))
    while seen[0].time < now - tuning.memory:
        seen.popleft()
    first, last = seen[0], seen[-1]
    if first is last:
        return None
    for side, arm in first.arms.items():
        if side not in last.arms or last.arms[side].hand != arm.hand:
            continue  # it has been taken, or let go of, meanwhile
        grips = None if arm.hand is None else (arm.grip, last.arms[side].grip)
        try:
            shift = skill.context.senses.arm_shift(
                last.frame, before=first.frame, arm_in_map=arm.points, grips_in_map=grips
            )
        except PerceptionFailure:
            continue
        if shift.share > tuning.max_shift:
            return f"{shift.share:.0%} of the {side} arm left its place within {last.time - first.time:.2f} s"
    return None


def _arms(skill: Skill, tuning: PersonMotionTuning) -> dict[Side, Arm]:
    """The arms that are known, but for one that the robot has its fingers round and does not hold yet."""
    hands = skill.world.observe().pose_hand_in_map[:, :3, 3]
    holds = np.array([skill.context.guard.grip(hand) == "arm" for hand in SIDES])
    arms: dict[Side, Arm] = {}
    for side, posture in watch_of(skill).arms.items():
        away = distance_to_chain(hands, posture.points_in_map)
        if (away < np.where(holds, 0.0, tuning.at_hand)).any():
            continue
        n = int(np.argmin(np.where(holds, away, np.inf)))
        held = holds[n] and away[n] < tuning.held
        arms[side] = Arm(posture.points_in_map, SIDES[n] if held else None, hands[n])
    return arms
