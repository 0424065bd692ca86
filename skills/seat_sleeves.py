"""Draw the armholes of worn sleeves that are low up to the shoulders, both at once, by their front edges."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from ..perception.errors import PerceptionFailure
from ..perception.estimates import GraspPoint
from ..sim.quantity import Quantities, quantity
from ..sim.world import SIDES, Side
from .belief.person_motion import while_person_rests
from .belief.person_tracking import chest_top, watch_arm
from .control.carry import Carry, carry
from .control.fingers import open_gripper
from .control.hands import gap_between_arms, hand_now
from .control.head import look_towards
from .control.take_from_above import FromAbove, take_from_above
from .control.together import together
from .control.withdraw import withdraw
from .core.ports import Input
from .core.reasons import Reason
from .core.skill import Skill
from .core.tries import Tries
from .geometry.arm_path import UP
from .geometry.stances import HEADWARD, outwards
from .motion.errors import MotionError


@dataclass(frozen=True, kw_only=True)
class SeatSleevesTuning(Quantities):
    """Numbers of `SeatSleeves`."""

    grasp: FromAbove = field(default_factory=FromAbove)
    leans: tuple[float, ...] = quantity(
        (0.45, 0.25, 0.0),
        "rad",
        "of the hands outwards, off the vertical, tried in turn",
        "choice: upright hands come no nearer to the midline than 0.15 m before their wrists meet; leaning ones missed "
        "the front of an armhole 0.26 m outside the shoulder by 2 mm of their reach (101)",
    )
    lift: float = quantity(0.04, "m", "of the cloth off the arm before it is drawn", "choice: the hand clears the arm")
    drawn_to: tuple[float, float, float] = quantity(
        (0.12, -0.02, 0.27),
        "m",
        "inwards, headward and up from each shoulder, where the front edge of its armhole is drawn to: until it is "
        "taut, and its far side, below the arm, comes along",
        "measured with ideal hands: drawn 0.12 m inwards they came to rest at 0.79 and 0.83 (103) and at 0.83 and 0.82 "
        "(101), 0.05 m inwards at 0.78 and 0.62 (103)",
    )
    laid_at: tuple[float, float] = quantity(
        (0.03, 0.13),
        "m",
        "footward of where it was drawn to, and up from the shoulder, where that edge is laid down and let go of",
        "measured: let go of where it is taut, it springs back by 0.1 more; laid headward, the collar went along",
    )
    apart: float = quantity(
        0.04,
        "m",
        "between the robot's arms, at which the hands come no nearer to each other",
        "choice: nothing else keeps them apart while they are driven by velocities; at 0.10 m from the shoulders hands "
        "that leaned inwards were 8 cm inside each other",
    )
    laying_speed: float = quantity(0.06, "m/s", "of the hands on their way down", "choice: they may meet the chest")
    above_chest: float = quantity(
        0.03,
        "m",
        "of the hands there, above the front of the chest, at least",
        "measured: 0.01 m above it fingers met the trunk with 76 N as they opened (101), below it with 64 to 85 N; "
        "from higher, the sleeve slides back farther",
    )
    # at 6.5 N, with 8.1 N for a moment, 1 % of the cloth's edges were 28 % longer, at 6 N and 7.5 N 23 and 25 % (101)
    carry: Carry = field(default_factory=lambda: Carry(max_load=5.5))
    withdrawal: float = quantity(0.12, "m", "by which the open hands are drawn back", "choice: clear of the sleeves")


class SeatSleeves(Skill):
    """Takes each low armhole by its front edge, draws it up and to the shoulder until it is taut, and lays it down.

    Drawn one after the other, two of them take the collar to their side and the other sleeve down its arm; drawn
    together they share the front between them.  A sleeve that is high enough is left alone.  Drawn by the strap, an
    armhole is drawn long, and goes back as the strap is let go of; its front edge takes the whole armhole along.  The
    robot stands at the head of the bed, each hand on its side, and the arms have to lie.  The hands end open and drawn
    back, after a missed grasp too.
    """

    enough = Input(
        float, unit="1", default=0.72, doc="how far up the upper arm an armhole is left alone: 0 elbow, 1 shoulder"
    )
    tuning = Input(SeatSleevesTuning, default=SeatSleevesTuning(), doc="numbers of this skill")
    reasons = (
        Reason.NOTHING_SEEN,
        Reason.ARM_LOST,
        Reason.UNREACHABLE,
        Reason.MOTION_BLOCKED,
        Reason.GRASP_MISSED,
        Reason.PERSON_MOVED,
        Reason.FORCE_LIMIT,
        Reason.COMMAND_LOST,
    )

    def steps(self) -> Iterator[None]:
        """Draw as long as the person does not move."""
        yield from while_person_rests(self, self._seat())

    def _seat(self) -> Iterator[None]:
        """Look at both, take one after the other, lift, draw, lay down, let go."""
        tuning = self.tuning
        shoulders, fronts = {}, {}
        for side in SIDES:  # before a hand comes in between
            arm = watch_arm(self, side).points_in_map
            shoulders[side] = arm[0]
            yield from look_towards(self, np.mean(arm[:2], axis=0))
            if self._low(side, arm):
                fronts[side] = self.context.senses.armhole_front(self.world.look("head"), side=side, arm_in_map=arm)
        for side, front in fronts.items():
            self.note(f"takes the front of the {side} armhole")
            yield from self._take(side, front)
        self.note(f"draws the {' and the '.join(fronts)} armhole up" if fronts else "leaves both as they are")
        yield from self._carry({side: hand_now(self, side)[:3, 3] + tuning.lift * UP for side in fronts})
        yield from self._carry({side: _place(side, shoulders[side], tuning.drawn_to) for side in fronts})
        footward, up = tuning.laid_at
        laid: dict[Side, np.ndarray] = {}
        for side in fronts:
            laid[side] = hand_now(self, side)[:3, 3] - footward * HEADWARD
            laid[side][2] = max(shoulders[side][2] + up, chest_top(self) + tuning.above_chest)
        yield from together(*(carry(self, side, laid[side], tuning.carry, tuning.laying_speed) for side in fronts))
        # at once, so that neither side gives way to the other; wider, a finger would come down to the chest
        yield from together(*(open_gripper(self, side, tuning.grasp.opening) for side in fronts))
        yield from withdraw(self, list(fronts), tuning.withdrawal)

    def _low(self, side: Side, arm: np.ndarray) -> bool:
        """Whether a sleeve is too far down the arm (4, 3) [m]; one of which too little shows is let pass."""
        try:
            seen = self.context.senses.worn_sleeve(self.world.look("head"), side=side, arm_in_map=arm)
        except PerceptionFailure:
            return False
        return seen.reach < self.enough

    def _take(self, side: Side, front: GraspPoint) -> Iterator[None]:
        """Grasp one front, leaning outwards as far as the arm reaches it that way."""
        outward, tries = outwards(side), Tries(MotionError)
        for lean in self.tuning.leans:
            leaning = replace(front, approach_in_map=-np.cos(lean) * UP - np.sin(lean) * outward)
            with tries:
                yield from take_from_above(self, side, leaning, outward, self.tuning.grasp)
                return
        raise tries.last

    def _carry(self, places: dict[Side, np.ndarray]) -> Iterator[None]:
        """Both hands at once, each to its place (3,), as long as the arms stay apart [m]."""
        for _ in together(*(carry(self, side, place, self.tuning.carry) for side, place in places.items())):
            if gap_between_arms(self) < self.tuning.apart:
                return
            yield


def _place(side: Side, shoulder: np.ndarray, place: tuple[float, float, float]) -> np.ndarray:
    """(3,) in the map of a place inwards, headward and up from the shoulder [m]."""
    inward, headward, up = place
    return shoulder - inward * outwards(side) + headward * HEADWARD + up * UP
