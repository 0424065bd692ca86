"""See in time that the whole gown comes along with the sleeve that a hand carries."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from ...perception.errors import PerceptionFailure
from ...sim.quantity import Quantities, quantity
from ...sim.world import SIDES, Side
from ..control.hands import HANDS, hand_now
from ..core.reasons import Reason, SkillFailure
from ..core.skill import Skill
from ..geometry.stances import outwards


@dataclass(frozen=True, kw_only=True)
class GownWatchTuning(Quantities):
    """When a gown comes along."""

    interval: float = quantity(0.4, "s", "between two looks", "choice: a hand goes 0.1 m meanwhile")
    least_out: float = quantity(
        0.08,
        "m",
        "of the other sleeve from the middle of the bed, below which the gown comes along",
        "measured: first sleeves that were held out left the other one 0.2 to 0.45 m out, 12 of 12; where the gown "
        "fell off the bed it came from 0.22 m out to 0.34 m beyond the middle (190), seen to 0.08 m all the way",
    )
    looks: int = quantity(2, "1", "in turn that show it there", "choice: one may be wrong")


GOWN_WATCH = GownWatchTuning()


def while_gown_stays(
    skill: Skill, arm: Side, hand: Side, motion: Iterator[None], *, tuning: GownWatchTuning = GOWN_WATCH
) -> Iterator[None]:
    """Let `motion` go on as long as the other sleeve lies on its own side of the bed, as far as it shows.

    Args:
        skill: that moves.
        arm: whose sleeve is carried.
        hand: that carries it, from where it lay; the other one lies as far on the other side.
        motion: of that hand.
        tuning: what counts as coming along.

    Raises:
        SkillFailure: GOWN_SHIFTED, the hands at rest; MOTION_BLOCKED where they do not come to rest, and whatever
            `motion` raises.
    """
    other, middle = SIDES[1 - SIDES.index(arm)], skill.world.room.bed[:, :2].mean(axis=0)
    near = hand_now(skill, hand)[:3, 3].copy()
    near[0] = 2.0 * middle[0] - near[0]
    looked, beyond = skill.now(), 0
    for _ in motion:
        yield
        if skill.now() - looked < tuning.interval:
            continue
        looked = skill.now()
        try:
            seen = skill.context.senses.sleeve_opening(skill.world.look("head"), side=other, near_in_map=near)
        except PerceptionFailure:
            continue
        near = seen.position_in_map
        out = float((near[:2] - middle) @ outwards(other)[:2])
        beyond = beyond + 1 if out < tuning.least_out else 0
        if beyond >= tuning.looks:
            skill.world.stop()
            still = skill.context.guard.still
            yield from skill.until(still, timeout=HANDS.stop_timeout, reason=Reason.MOTION_BLOCKED)
            raise SkillFailure(Reason.GOWN_SHIFTED, f"the {other} sleeve lies {out * 100:.0f} cm out")
