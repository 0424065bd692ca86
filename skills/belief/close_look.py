"""What the hands' cameras saw closely of a worn gown, until a hand comes down to it."""

from __future__ import annotations

from dataclasses import dataclass, field

from ...perception.estimates import GraspPoint
from ...sim.quantity import Quantities, quantity
from ...sim.world import Side
from ..core.skill import Skill


@dataclass(frozen=True, kw_only=True)
class CloseLookTuning(Quantities):
    """How long a close look tells."""

    collar_lasts: float = quantity(60.0, "s", "of the collar", "choice: nobody touches what it saw")
    sleeves_last: float = quantity(
        120.0, "s", "of the sleeves", "choice: they are up as long as nobody touches them; both are gone to meanwhile"
    )


CLOSE_LOOK = CloseLookTuning()


@dataclass(frozen=True)
class SleeveSeen:
    """How a sleeve was seen to sit.

    Attributes:
        reach: how far up its armhole is, share of the upper arm.
        round_arm: share of the way round the arm that its cuff shows, but for the widest gap.
        when: it was seen [s].
    """

    reach: float
    round_arm: float
    when: float


@dataclass
class CloseLook:
    """The last close looks, until a hand comes down to the gown.

    Attributes:
        seen: where the collar's middle lies; None where it may lie elsewhere by now.
        sleeves: how each of them sits.
        before: how each of them was seen to sit the last time, from wherever; known until its sleeve is drawn.
    """

    seen: GraspPoint | None = None
    sleeves: dict[Side, SleeveSeen] = field(default_factory=dict)
    before: dict[Side, SleeveSeen] = field(default_factory=dict)

    @staticmethod
    def of(skill: Skill) -> CloseLook:
        """The run's."""
        return skill.context.memory.of(CloseLook, CloseLook)

    def forget(self) -> None:
        """The gown is touched: it may lie elsewhere by now."""
        self.seen = None
        self.sleeves.clear()


def close_look(skill: Skill, max_age: float = CLOSE_LOOK.collar_lasts) -> GraspPoint | None:
    """Where the neckline's middle was seen closely within `max_age` [s], if no hand came down to the gown since."""
    seen = CloseLook.of(skill).seen
    return seen if seen is not None and skill.now() - seen.stamp < max_age else None


def sleeve_seen(skill: Skill, side: Side, max_age: float = CLOSE_LOOK.sleeves_last) -> SleeveSeen | None:
    """How a sleeve was seen closely to sit within `max_age` [s], if no hand came down to the gown since."""
    seen = CloseLook.of(skill).sleeves.get(side)
    return seen if seen is not None and skill.now() - seen.when < max_age else None


def reach_before(skill: Skill, side: Side, max_age: float = CLOSE_LOOK.sleeves_last) -> float:
    """How far up an armhole was seen the last time within `max_age` [s], from wherever; 0 where nobody has seen it."""
    seen = CloseLook.of(skill).before.get(side)
    return seen.reach if seen is not None and skill.now() - seen.when < max_age else 0.0
