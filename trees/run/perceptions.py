"""Which eyes a run has: rules on colours, or the same rules on what the network sees; and who chooses pre-grasps.

Of a gown on its hook that shows no tapes, the network answers itself which side shows and where the corners are
(`HungGown`), and of one that lies where the strap of a sleeve is (`strap_in`); the rules that ask more of a gown
without tapes are shown its surfaces in their colours.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ...perception.errors import PerceptionFailure
from ...perception.estimates import GraspPoint, PreGrasp, SleeveOpening
from ...perception.image.garment import tapes_show
from ...perception.image.surfaces import Surface
from ...perception.learned.hung_gown import HungGown
from ...perception.learned.learned_sight import LearnedSight
from ...perception.learned.pre_grasp_policy import Chooser, chosen_pre_grasp, packaged_policy
from ...perception.learned.repainted import gown_repainted, repainted
from ...perception.learned.sight import Sight, packaged_network
from ...perception.learned.strap import AFAR, strap_in
from ...perception.senses import Senses
from ...sim.errors import CaretreeError
from ...sim.world import Frame, Side
from ...skills.core.context import Context

CLASSICAL, LEARNED = "classical", "learned"
PERCEPTIONS = (CLASSICAL, LEARNED)
KEPT = 4  # repainted pictures: as many cameras may be asked of in one tick, several times each
# Confidence in skin from which on it tells whether an arm has moved; of such pixels in 32 pictures of the head in runs
# 0.005 were something else, of those from 0.6 to 0.8 0.22, and cloth that comes over an arm looks as if that had moved.
SURE = 0.9
# Asked of a person, with or without a gown; and `hang_point` of towels too, which the network takes for gowns, or for
# none: it is asked of the picture itself first.  All other senses are asked of a gown alone.
NOT_OF_A_GOWN = ("head", "arm", "relocalised_arm", "arm_shift", "chest_front", "hang_point")


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
        sight = LearnedSight(bed_in_map=context.world.room.bed)
        context.wrap_senses(lambda senses: seen_by_network(senses, sight))


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


def seen_by_network(senses: Senses, sight: LearnedSight) -> Senses:
    """Senses that answer as `senses` do of the repainted pictures, but for sides and corners of a gown without tapes.

    Args:
        senses: that read colours.
        sight: what the network sees.
    """
    skin = _kept(lambda frame: repainted(frame, sight.sight(frame).surfaces))
    sure_skin = _kept(lambda frame: repainted(frame, _surely_skin(sight.sight(frame))))
    all_of_it = _kept(lambda frame: gown_repainted(skin(frame), sight.sight(frame).surfaces))

    def in_colour(frame: Frame) -> Frame:
        """Tapes tell more than what the network takes for them."""
        return skin(frame) if tapes_show(frame) else all_of_it(frame)

    asked: dict[str, Any] = {
        name: _passed_on(senses, name, skin if name in NOT_OF_A_GOWN else in_colour)
        for name in Senses.__abstractmethods__
    }
    by_colours = asked["hang_point"]

    def hang_point(self: object, frame: Frame) -> object:
        try:
            return by_colours(self, frame)
        except PerceptionFailure:
            return senses.hang_point(all_of_it(frame))

    asked["hang_point"] = hang_point
    asked["arm_shift"] = _passed_on(senses, "arm_shift", sure_skin)
    hung = HungGown(sight)

    def of_network(name: str, answer: Callable[..., object]) -> Callable[..., object]:
        by_rules = asked[name]

        def ask(self: object, frame: Frame, **options: Any) -> object:
            return by_rules(self, frame, **options) if tapes_show(frame) else answer(frame, **options)

        return ask

    def shown_corner(frame: Frame, *, hook_in_map: np.ndarray, side: Side | None = None) -> GraspPoint:
        return hung.shown_corner(frame, hook_in_map, side)

    def hung_corner(
        frame: Frame,
        *,
        side: Side,
        hook_in_map: np.ndarray,
        other_length: float | None = None,
        near_in_map: np.ndarray | None = None,
    ) -> GraspPoint:
        return hung.corner(frame, side, hook_in_map, near_in_map, beside_matters=other_length is None)

    def sleeve_strap(frame: Frame, *, side: Side, near_in_map: np.ndarray) -> SleeveOpening:
        return strap_in(frame, sight.sight(frame), side, near_in_map)

    def sleeve_opening(frame: Frame, *, side: Side, near_in_map: np.ndarray) -> SleeveOpening:
        return strap_in(frame, sight.sight(frame), side, near_in_map, AFAR)

    answers = {
        "gown_side": hung.side,
        "hung_side": hung.side,
        "shown_corner": shown_corner,
        "hung_corner": hung_corner,
        "sleeve_opening": sleeve_opening,
        "sleeve_strap": sleeve_strap,
    }
    asked |= {name: of_network(name, answer) for name, answer in answers.items()}
    return _senses_of("SensesOfNetwork", asked)


def _surely_skin(seen: Sight) -> np.ndarray:
    """(H, W) surfaces; what is hardly skin is something else."""
    return np.where((seen.surfaces == Surface.SKIN) & (seen.confidence < SURE), Surface.OTHER, seen.surfaces)


def _kept(paint: Callable[[Frame], Frame]) -> Callable[[Frame], Frame]:
    """The same for a frame that is painted again: the last few are kept."""
    painted: list[tuple[Frame, Frame]] = []

    def again(frame: Frame) -> Frame:
        for before, after in painted:
            if before is frame:
                return after
        painted.append((frame, paint(frame)))
        del painted[:-KEPT]
        return painted[-1][1]

    return again


def _passed_on(
    senses: Senses, name: str, change: Callable[[Frame], Frame] = lambda frame: frame
) -> Callable[..., object]:
    """A method that asks `senses` the same of a changed picture, or of several, such as one before and one after."""

    def shown(given: Any) -> Any:
        if isinstance(given, Frame):
            return change(given)
        several = isinstance(given, Sequence) and any(isinstance(each, Frame) for each in given)
        return [shown(each) for each in given] if several else given

    def ask(self: object, frame: Any, *args: Any, **options: Any) -> object:
        return getattr(senses, name)(shown(frame), *args, **{key: shown(each) for key, each in options.items()})

    return ask


def _senses_of(name: str, methods: dict[str, Any]) -> Senses:
    """Senses with these methods."""
    return type(name, (Senses,), methods)()
