"""A gown that was laid on the person: whether in this run, and which of its sleeves do not stand."""

from __future__ import annotations

from dataclasses import dataclass, field

from ...sim.world import Side
from ..core.context import Context


@dataclass
class LyingSleeves:
    """The person's sides on which the sleeve was seen not to stand, as the gown was let go of."""

    sides: set[Side] = field(default_factory=set)
    laid: bool = False  # whether it was laid in this run, on bare arms


def lying_sleeves(context: Context) -> set[Side]:
    """The run's memory of the person's sides on which the sleeve of the laid gown does not stand."""
    return context.memory.of(LyingSleeves, LyingSleeves).sides


def laid_here(context: Context) -> bool:
    """Whether a gown was laid on the person in this run, and not by somebody else before it."""
    return context.memory.of(LyingSleeves, LyingSleeves).laid


def remember_laid(context: Context) -> None:
    """A gown has been laid on the person in this run."""
    context.memory.of(LyingSleeves, LyingSleeves).laid = True
