"""Carry a sleeve to where its arm can take it: from the other side of the bed, or from off the trunk."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import product

import numpy as np

from ..perception.errors import PerceptionFailure
from ..perception.estimates import SleeveOpening
from ..perception.image.cloud import main_direction, unit
from ..sim.quantity import Quantities, quantity
from ..sim.world import Side
from .belief.person_tracking import bare_share, careful, watch_arm
from .belief.refused_stands import REFUSED, refused_stands
from .belief.sleeve_search import SleeveMemory
from .control.base import drive_to
from .control.fingers import let_cloth_go
from .control.hands import hand_now, move_hands, until_load
from .control.head import look_towards
from .control.pinch import PinchTuning, back_off, pinch_or_back_off, reach_in
from .core.ports import Input
from .core.reasons import Reason
from .core.skill import Skill
from .core.tries import Tries
from .geometry.arm_path import UP
from .geometry.stances import HEADWARD, LIFTING, PULLING, STANCES, outwards
from .motion.errors import MotionError

GENTLY = 0.2  # share of the speed on the way in; at half of it the trunk was met with 58 N before the hand stood (166)


@dataclass(frozen=True, kw_only=True)
class CarrySleeveTuning(Quantities):
    """Where a stray sleeve lies, and how it is carried back.  Places are given from the middle of the mattress."""

    stray_place: tuple[float, float] = quantity(
        (0.28, 0.35),
        "m",
        "about where such a sleeve lies: towards the other side, feetward",
        "choice: where the first pull draws it",
    )
    stray_distance: float = quantity(
        0.02,
        "m",
        "beyond the middle of the bed, from which on a sleeve is on the wrong side",
        "choice: more than noise",
    )
    trunk_place: tuple[float, float] = quantity(
        (0.12, 0.2), "m", "about where one on the trunk lies: outwards, feetward", "measured: at 0.13, 0.13 (166)"
    )
    trunk_distance: float = quantity(
        0.2, "m", "from the middle of the bed, up to which a sleeve lies on the trunk", "choice: `LaySleeve` has 0.26"
    )
    headward_distance: float = quantity(
        0.11,
        "m",
        "from the fingertips towards the head, up to which a sleeve lies by the hand",
        "measured: from 0.12 to 0.21 m 0 of 6 were taken and opened at once, from 0.03 to 0.10 m 7 of 7 (165-186)",
    )
    min_bare: float = quantity(
        0.7,
        "1",
        "share of the arm that has to show skin, or its sleeve lies over it",
        "measured: of arms of which 0.22 to 0.75 was bare, 0 of 5 were dressed at once; of bare ones 7 of 9 (165-186)",
    )
    depths: tuple[float, ...] = quantity(
        (0.017, 0.010, 0.004),
        "m",
        "of the fingertips beyond the strap, tried in turn",
        "measured: 0.017 m deep, straight down or leaning, from three places of the base, no posture kept clear of the "
        "person where the strap lay right on a thigh or over a hand; 0.005 m deep it was taken, at 0 and by 0.005 m "
        "less the fingers closed on air (135)",
    )
    leans: tuple[float, ...] = quantity(
        tuple(math.radians(lean) for lean in (0.0, 25.0, 40.0, 55.0)),
        "rad",
        "of the approach off the vertical, from the robot's side, tried in turn",
        "measured: where the strap lay on the side of a thigh, straight down and leaning by 45 degrees the fingers met "
        "it at any depth; by 55 degrees, square to it, they kept clear 0.004 m deep (138)",
    )
    min_across: float = quantity(
        0.3,
        "1",
        "part of the strap's width across the approach from which on the fingers close along it, else along the bed",
        "choice: a strap that stands up towards the hand has no width across it",
    )
    rim_top: float = quantity(
        0.95, "1", "of what shows of the rim, by height, above which is its top", "choice: no noise"
    )
    rim_above: float = quantity(
        0.04,
        "m",
        "of the rim's top above the strap, from which on it is taken where the strap is out of reach",
        "choice: clear of the body; a strap on the hip lay within what is known of the trunk, the rim 0.08 m higher "
        "(151)",
    )
    rim_reach: float = quantity(
        0.04, "m", "of the rim round its top, which tells how it runs", "choice: a hand's width"
    )
    opening: float = quantity(
        0.06, "m", "between the fingers around the strap", "choice: 5 mm more than the strap's width"
    )
    reaching_speed: float = quantity(
        0.15, "m/s", "of the hand to before the strap; a fifth of it on the way in", "choice: the trunk lies below it"
    )
    pinch: PinchTuning = field(default_factory=lambda: PinchTuning(inwards_share=GENTLY))
    height: float = quantity(0.25, "m", "of the way across, above where it begins and ends", "choice: over the person")
    speed: float = quantity(0.25, "m/s", "of the hand away from the person", "choice: the sleeve hardly swings")
    max_load: float = quantity(
        5.0,
        "N",
        "load, weight and all, from which the sleeve goes no farther",
        "choice: the other sleeve is on its arm",
    )
    laid_place: tuple[float, float] = quantity(
        (0.33, 0.16), "m", "where it is laid down: outwards, feetward", "choice: beyond the arm's hand"
    )
    laid_heights: tuple[float, ...] = quantity(
        (0.06, 0.14, 0.22),
        "m",
        "of the hand above the mattress when it lets go, the first that is free",
        "choice: an arm that reaches across keeps off the trunk",
    )
    laid_beyond: tuple[float, float] = quantity(
        (0.26, 0.30),
        "m",
        "where it is laid down from its own side: outwards, feetward",
        "choice: as far out as `LaySleeve`, or what hangs over the edge draws the gown after it, and a hand's length "
        "farther feetward than it, so that the gown comes off the hand",
    )
    laid_from: tuple[float, float] = quantity(
        (0.16, 0.12),
        "m",
        "outwards and feetward of there, from where it is laid down",
        "choice: as `LaySleeve`; what hangs below the strap touches the bed first, so that the cuff comes to lie "
        "outwards; let down straight, it came to lie inwards (179, 183)",
    )
    back_off_distance: float = quantity(
        0.3, "m", "of the base from the sleeve it has laid down", "choice: the arms then turn freely"
    )


class CarrySleeve(Skill):
    """Looks for the sleeve beyond the middle of the bed; takes it there from above and lays it beyond the arm's hand.

    The robot stands on the other side of the bed.  From the sleeve's own side it carries one that lies on the trunk,
    where a hand that comes from beside meets the body (166), one that lies headward of the hand, and one under which
    the arm does not show: such an arm could neither be lifted nor found again (179).

    A sleeve that does not lie there is no failure; it fails where the sleeve is out of reach, where the fingers close
    on nothing, and where something is in the way.
    """

    side = Input(Side, doc="arm of the person that the sleeve belongs to")
    own_side = Input(bool, default=False, doc="whether the robot stands on that side of the bed")
    tuning = Input(CarrySleeveTuning, default=CarrySleeveTuning(), doc="numbers of this skill")
    reasons = (
        Reason.PATH_BLOCKED,
        Reason.UNREACHABLE,
        Reason.MOTION_BLOCKED,
        Reason.GRASP_MISSED,
        Reason.COMMAND_LOST,
        Reason.TIMEOUT,
    )

    def steps(self) -> Iterator[None]:
        """Look; drive, take, carry, let go, drive back."""
        where = "beside its arm" if self.own_side else "on its side"
        self.note(f"looks whether the {self.side} sleeve is {where}")
        yield from look_towards(self, self._stray_place())
        seen = self._stray()
        if seen is None:
            return
        self.note(f"carries the {self.side} sleeve {'out' if self.own_side else 'across'}")
        hand = (PULLING if self.own_side else LIFTING)[self.side]
        beside = STANCES.lane * outwards(self.side)[0] * (1.0 if self.own_side else -1.0)
        lane = np.array((beside, seen.position_in_map[1] + STANCES.ahead, STANCES.heading))
        yield from drive_to(self, lane)
        yield from self._reach(hand, seen)
        yield from pinch_or_back_off(self, hand)
        yield from self._carry(hand)
        back = self.tuning.back_off_distance * np.append(HEADWARD[:2], 0.0)
        yield from drive_to(self, lane - back, straight=True, retreat=True)

    def _reach(self, hand: Side, sleeve: SleeveOpening) -> Iterator[None]:
        """Bring open fingers around the strap, as deep as they keep clear of the person, and leaning where they must.

        Raises:
            MotionError: out of reach, or something is in the way.
        """
        tuning, tries = self.tuning, Tries(MotionError)
        for position, approach, closing, depth in self._grips(sleeve):
            with tries:
                yield from reach_in(
                    self,
                    hand,
                    position,
                    approach,
                    closing,
                    opening=tuning.opening,
                    depth=depth,
                    speed=tuning.reaching_speed,
                    tuning=tuning.pinch,
                )
                return
        raise tries.last

    def _grips(self, sleeve: SleeveOpening) -> Iterator[tuple[np.ndarray, np.ndarray, np.ndarray, float]]:
        """Where the sleeve may be taken, best first: position (3,), approach (3,), closing direction (3,), depth [m].

        By the strap; where that lies right on the body, and its armhole stands up beside it, by the highest of its rim.
        """
        tuning = self.tuning
        inwards = outwards(self.side) * (-1.0 if self.own_side else 1.0)
        for depth, lean in product(tuning.depths, tuning.leans):
            approach = -math.cos(lean) * UP + math.sin(lean) * inwards
            closing = sleeve.closing_in_map - (sleeve.closing_in_map @ approach) * approach
            if np.linalg.norm(closing) < tuning.min_across:
                closing = HEADWARD
            yield sleeve.position_in_map, approach, unit(closing), depth
        rim = sleeve.armhole_points_in_map
        top = np.median(rim[rim[:, 2] >= np.quantile(rim[:, 2], tuning.rim_top)], axis=0)
        if top[2] < sleeve.position_in_map[2] + tuning.rim_above:
            return
        near = rim[np.linalg.norm(rim - top, axis=1) < tuning.rim_reach]
        along = main_direction(near)
        across = np.cross(UP, along)
        if np.linalg.norm(across) > tuning.min_across:
            for depth in tuning.depths:
                yield top, -UP, unit(across), depth

    def _go(self, hand: Side, there: np.ndarray) -> Iterator[None]:
        """Bring what the hand holds to a position (3,), as far as it goes."""
        pose = hand_now(self, hand)
        pose[:3, 3] = there
        motion = move_hands(self, {hand: pose}, speed=careful(self, self.tuning.speed), free="any", way="either")
        yield from until_load(self, hand, self.tuning.max_load, motion)

    def _place(self, out: float, feetward: float, above: float) -> np.ndarray:
        """(3,) from the middle of the mattress [m]."""
        bed = self.world.room.bed
        middle = np.array((*bed[:, :2].mean(axis=0), bed[1, 2]))
        return middle + out * outwards(self.side) - feetward * HEADWARD + above * UP

    def _stray_place(self) -> np.ndarray:
        """(3,) where a stray sleeve is looked for [m]."""
        if not self.own_side:
            beyond, feetward = self.tuning.stray_place
            return self._place(-beyond, feetward, 0.0)
        last = self.context.memory.of(SleeveMemory, SleeveMemory).last
        return last.get(self.side, self._place(*self.tuning.trunk_place, 0.0))

    def _stray(self) -> SleeveOpening | None:
        """The sleeve, where it lies beyond the middle of the bed; from its own side, where its arm cannot take it."""
        near = self._stray_place()
        try:
            seen = self.context.senses.sleeve_opening(self.world.look("head"), side=self.side, near_in_map=near)
        except PerceptionFailure:
            return None
        out = float((seen.position_in_map - self._place(0.0, 0.0, 0.0)) @ outwards(self.side))
        if not self.own_side:
            return seen if out < -self.tuning.stray_distance else None
        return seen if out < self.tuning.trunk_distance or not self._at_hand(seen) else None

    def _at_hand(self, sleeve: SleeveOpening) -> bool:
        """Whether the sleeve lies by the hand, not out of reach, and the arm beside it is bare."""
        if len(refused_stands(self, self.side)) >= REFUSED:
            return False
        try:
            posture = watch_arm(self, self.side)
        except PerceptionFailure:
            return False
        headward = float((sleeve.position_in_map - posture.points_in_map[3]) @ HEADWARD)
        bare = bare_share(self.world.look("head"), posture)
        return headward < self.tuning.headward_distance and bare > self.tuning.min_bare

    def _laid(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Where it is let down from, and where it comes to lie, each outwards and feetward [m]."""
        tuning = self.tuning
        if not self.own_side:
            return tuning.laid_place, tuning.laid_place
        (out, feetward), (more_out, more_feetward) = tuning.laid_beyond, tuning.laid_from
        return (out + more_out, feetward + more_feetward), tuning.laid_beyond

    def _carry(self, hand: Side) -> Iterator[None]:
        """Up, across, down, as far as the sleeve goes; let go of it and rise."""
        memory = self.context.memory.of(SleeveMemory, SleeveMemory)
        memory.sleeves.pop(self.side, None)
        tuning = self.tuning
        first, last = self._laid()
        yield from self._go(hand, hand_now(self, hand)[:3, 3] + tuning.height * UP)
        yield from self._go(hand, self._place(*first, tuning.laid_heights[0] + tuning.height))
        for above in tuning.laid_heights:
            with suppress(MotionError):
                yield from self._go(hand, self._place(*last, above))
                break
        memory.last[self.side] = hand_now(self, hand)[:3, 3]
        refused_stands(self, self.side).clear()
        yield from let_cloth_go(self, hand)
        with suppress(MotionError):  # it is open, and the next motion begins with a way out
            yield from back_off(self, hand)
