"""Which eyes a run has: rules on colours, or the same rules on what the network sees; and who chooses pre-grasps."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ...perception.estimates import PreGrasp
from ...perception.learned.pre_grasp_policy import Chooser, chosen_pre_grasp, packaged_policy
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
    if _learned("perception", perception, scripted):
        context.wrap_senses(seen_by_network)


def grasp_with(context: Context, pregrasp: str, *, scripted: bool = False) -> None:
    """Give a run's senses who was asked for to choose how the other hand takes a gown that hangs from one.

    Args:
        context: of the run, whose senses have been offered, and wrapped by `see_with`.
        pregrasp: one of `PERCEPTIONS`.
        scripted: whether its senses are made up, and look at no picture.

    Raises:
        CaretreeError: there is no such choice, or nothing for a policy to look at.
    """
    if _learned("pregrasp", pregrasp, scripted):
        policy = packaged_policy()
        context.wrap_senses(lambda senses: chosen_by_policy(senses, policy))


def _learned(option: str, chosen: str, scripted: bool) -> bool:
    """Whether `--option` asks for a network.

    Raises:
        CaretreeError: there is no such choice, or nothing for a network to look at.
    """
    if chosen not in PERCEPTIONS:
        raise CaretreeError(f"there is no {option} {chosen!r}, only {', '.join(PERCEPTIONS)}")
    if chosen == LEARNED and scripted:
        raise CaretreeError(f"--{option} learned looks at pictures, and scripted senses see none")
    return chosen == LEARNED


def chosen_by_policy(
    senses: Senses,
    policy: Chooser,
    surfaces_in: Callable[[Frame], np.ndarray] = lambda frame: packaged_network().see(frame).surfaces,
) -> Senses:
    """Senses that answer as `senses` do, but for the pre-grasp, which a policy chooses.

    Args:
        senses: for all the rest.
        policy: the trained one.
        surfaces_in: gives the (H, W) `Surface` of each pixel of a frame; the packaged network if omitted.
    """

    def pre_grasp(self: object, frames: Sequence[Frame], **options: Any) -> PreGrasp:
        return chosen_pre_grasp(policy, frames, surfaces_in, **options)

    return _senses_of(
        "SensesOfPolicy",
        {name: _passed_on(senses, name) for name in Senses.__abstractmethods__} | {"pre_grasp": pre_grasp},
    )


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

    return _senses_of("SensesOfNetwork", {name: _passed_on(senses, name, paint) for name in Senses.__abstractmethods__})


def _passed_on(
    senses: Senses, name: str, change: Callable[[Frame], Frame] = lambda frame: frame
) -> Callable[..., object]:
    """A method that asks `senses` the same of a changed picture, or of several."""

    def ask(self: object, frame: Any, *args: Any, **options: Any) -> object:
        shown = [change(each) for each in frame] if isinstance(frame, Sequence) else change(frame)
        return getattr(senses, name)(shown, *args, **options)

    return ask


def _senses_of(name: str, methods: dict[str, Any]) -> Senses:
    """Senses with these methods."""
    return type(name, (Senses,), methods)()
