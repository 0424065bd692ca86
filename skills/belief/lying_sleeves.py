"""Which sleeves of a gown that was laid on the person do not stand: such a one goes on at the first try, or not yet."""

from __future__ import annotations

from dataclasses import dataclass, field

from ...sim.world import Side
from ..core.context import Context


@dataclass
class LyingSleeves:
    """The person's sides on which the sleeve was seen not to stand, as the gown was let go of."""

    sides: set[Side] = field(default_factory=set)


def lying_sleeves(context: Context) -> set[Side]:
    """The run's memory of the person's sides on which the sleeve of the laid gown does not stand."""
    return context.memory.of(LyingSleeves, LyingSleeves).sides
