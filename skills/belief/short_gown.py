"""Whose hand the gown did not reach: that arm is spread less next time, which brings its hand nearer to the gown."""

from __future__ import annotations

from dataclasses import dataclass, field

from ...sim.world import Side
from ..core.skill import Skill


@dataclass
class ShortGown:
    """The person's sides on which a sleeve could not be brought before the fingertips."""

    sides: set[Side] = field(default_factory=set)


def short_gown(skill: Skill) -> set[Side]:
    """The run's memory of the person's sides on which the gown did not reach the hand."""
    return skill.context.memory.of(ShortGown, ShortGown).sides
