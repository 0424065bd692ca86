"""How hard sleeves pulled back as they were drawn up their arms: one with no arm in it hardly does."""

from __future__ import annotations

from dataclasses import dataclass, field

from ...sim.world import Side
from ..core.context import Context


@dataclass
class PulledSleeves:
    """Side of the person -> load [N] at which the last pull to the shoulder ended, if it came to its end."""

    loads: dict[Side, float] = field(default_factory=dict)


def pull_loads(context: Context) -> dict[Side, float]:
    """The run's memory of the load [N] at which the last pull of each sleeve to the shoulder ended."""
    return context.memory.of(PulledSleeves, PulledSleeves).loads
