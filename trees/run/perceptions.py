"""Which eyes a run has: the rules on colours, or the same rules on what the network sees."""

from __future__ import annotations

from ...sim.errors import CaretreeError
from ...skills.core.context import Context

CLASSICAL, LEARNED = "classical", "learned"
PERCEPTIONS = (CLASSICAL, LEARNED)


def see_with(context: Context, perception: str, *, scripted: bool = False) -> None:
    """Give a run's senses the eyes that were asked for.

    Args:
        context: of the run, whose senses have been offered.
        perception: one of `PERCEPTIONS`.
        scripted: whether its senses are made up, and look at no picture.

    Raises:
        CaretreeError: there is no such perception, or nothing for a network to look at.
    """
    if perception not in PERCEPTIONS:
        raise CaretreeError(f"there is no perception {perception!r}, only {', '.join(PERCEPTIONS)}")
    if perception == CLASSICAL:
        return
    if scripted:
        raise CaretreeError("--perception learned looks at pictures, and scripted senses see none")
    from ...perception.learned.relabelled import seen_by_network

    context.wrap_senses(seen_by_network)
