"""Which eyes a run has: the rules on colours, or the same rules on what the network sees."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ...perception.learned.repainted import repainted
from ...perception.learned.sight import packaged_network
from ...perception.senses import Senses
from ...sim.errors import CaretreeError
from ...sim.world import Frame
from ...skills.core.context import Context

CLASSICAL, LEARNED = "classical", "learned"
PERCEPTIONS = (CLASSICAL, LEARNED)
KEPT = 4  # repainted pictures: as many cameras may be asked of in one tick, several times each


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
    context.wrap_senses(seen_by_network)


def seen_by_network(
    senses: Senses, surfaces_in: Callable[[Frame], np.ndarray] = lambda frame: packaged_network().see(frame).surfaces
) -> Senses:
    """Senses that answer as `senses` do of the repainted pictures.

    Args:
        senses: that read colours.
        surfaces_in: gives the (H, W) `Surface` of each pixel of a frame; the packaged network if omitted.
    """
    painted: list[tuple[Frame, Frame]] = []

    def paint(frame: Frame) -> Frame:
        for before, after in painted:
            if before is frame:
                return after
        painted.append((frame, repainted(frame, surfaces_in(frame))))
        del painted[:-KEPT]
        return painted[-1][1]

    def passed_on(name: str) -> Callable[..., object]:
        def ask(self: object, frame: Any, *args: Any, **options: Any) -> object:
            shown = [paint(each) for each in frame] if isinstance(frame, Sequence) else paint(frame)
            return getattr(senses, name)(shown, *args, **options)

        return ask

    methods: dict[str, Any] = {name: passed_on(name) for name in Senses.__abstractmethods__}
    return type("SensesOfNetwork", (Senses,), methods)()
