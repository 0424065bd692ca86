"""Stage C: bring the sleeve from where it lay to the fingertips, its armhole hanging open towards the hand."""

from __future__ import annotations

from collections.abc import Generator, Iterator

import numpy as np

from ..perception.errors import PerceptionFailure
from ..perception.estimates import SleeveHeading
from ..perception.image.cloud import unit
from .belief.person_tracking import careful, watch_arm
from .belief.strap_grasp import STRAP_GRASP, presenting_position
from .control.compliant_hold import while_holding
from .control.hands import cloth_load, hand_now, look_towards, move_hands, until_load
from .core.ports import Input
from .core.reasons import Reason, SkillFailure
from .core.skill import Skill
from .geometry.arm_path import UP, ArmPath
from .geometry.hold import Hold
from .geometry.stances import outwards
from .geometry.strap_grip import StrapGrip, presenting
from .motion.errors import MotionError

RAISE, ASIDE = 0.14, 0.06  # off the bed before anything else [m]
_SHARES = (1.0, 0.6, 0.3)  # of that, as far as is within reach
SPEED = 0.30  # [m/s]
BEFORE, CLEARANCE = 0.10, 0.09  # in the end the strap is this far before and above the fingertips [m]
LOOK = 2.6  # place of the arm that the head looks at: from there the shoulder and a sleeve beyond the hand are in view
HARDER = 1.2  # how much harder a sleeve that does not open is drawn out the second time
HELD = 0.2  # a sleeve in the air pulls at least this hard [N]
CAUGHT = 6.5  # the gown hangs on something: more stretches a hundredth of its threads by a quarter [N]


class PresentSleeve(Skill):
    """Raises the sleeve, carries it to a place beyond the fingertips and turns it there, never over the arm.

    Held by its strap across the arm's direction, the armhole hangs open like a hoop for the hand.  A sleeve that does
    not open is carried out once more, farther.

    Inputs: `grip`, how the strap is held; `hold`, the hand that holds the arm, or None; `taut`, the load at which it
    is carried no farther, lest the gown be drawn off the other arm [N]; `opens`, how far beyond the armhole the cuff
    has to show in the end, along the hand, -inf for anything [m].
    """

    grip = Input(StrapGrip)
    hold = Input(Hold, default=None)
    taut = Input(float, default=np.inf)
    opens = Input(float, default=-np.inf)
    reasons = (
        Reason.UNREACHABLE,
        Reason.MOTION_BLOCKED,
        Reason.CLOTH_SLIPPED,
        Reason.ARM_LOST,
        Reason.COMMAND_LOST,
        Reason.ARM_SLIPPED,
        Reason.FORCE_LIMIT,
        Reason.SLEEVE_FOLDED,
        Reason.SLEEVE_CAUGHT,
    )

    def steps(self) -> Iterator[None]:
        """Up, then beyond the fingertips."""
        arm, hand = self.grip.arm, self.grip.hand
        self.note(f"brings the {arm} sleeve to the fingertips")
        self.context.guard.declare_grip(hand, "cloth")
        yield from while_holding(self, self.hold, self._raise())
        if np.linalg.norm(cloth_load(self, hand)) < HELD:
            raise SkillFailure(Reason.CLOTH_SLIPPED, f"nothing pulls at the {hand} hand")
        path = ArmPath.of(watch_arm(self, arm, hold=self.hold))
        yield from while_holding(self, self.hold, look_towards(self, path.point(LOOK)))
        yield from self._bring(path, self.taut)
        if (folded := (yield from self._folded(path))) is not None and np.isfinite(self.taut):
            self.note(f"brings the {arm} sleeve from farther out")  # on its way back the cuff trails behind
            try:
                yield from self._bring(path, HARDER * self.taut)
            except MotionError:
                raise folded from None
            folded = yield from self._folded(path)
        if folded is not None:
            raise folded

    def _raise(self) -> Iterator[None]:
        """Off the bed and aside; where that is out of reach, as far as is not."""
        hand, start = self.grip.hand, hand_now(self, self.grip.hand)
        for share in _SHARES:
            raised = start.copy()
            raised[:3, 3] += share * (RAISE * UP + ASIDE * outwards(self.grip.arm))
            try:
                yield from move_hands(self, {hand: raised}, speed=careful(self, SPEED), way="either")
                return
            except MotionError:
                if share == _SHARES[-1]:
                    raise

    def _bring(self, path: ArmPath, taut: float) -> Iterator[None]:
        """Out beyond the fingertips, then back before them."""
        hand = self.grip.hand
        yield from while_holding(self, self.hold, self._carry_out(path, taut))
        yield from while_holding(self, self.hold, self.wait(0.3))  # the sleeve stops swinging
        if np.linalg.norm(cloth_load(self, hand)) < HELD:
            raise SkillFailure(Reason.CLOTH_SLIPPED, f"nothing pulls at the {hand} hand")
        path = ArmPath.of(watch_arm(self, self.grip.arm, hold=self.hold))
        place = path.moved(3.0, BEFORE)
        start = path.point(place) + CLEARANCE * path.frame(place)[:, 2]
        goal = presenting(self.grip, path.direction(2.5), start)
        motion = move_hands(self, {hand: goal}, speed=careful(self, SPEED), way="either")
        yield from while_holding(self, self.hold, until_load(self, hand, CAUGHT, motion))
        if (load := float(np.linalg.norm(cloth_load(self, hand)))) > CAUGHT:
            raise SkillFailure(Reason.SLEEVE_CAUGHT, f"the gown pulls with {load:.1f} N")

    def _folded(self, path: ArmPath) -> Generator[None, None, SkillFailure | None]:
        """A sleeve whose back panel lies folded over the strap hangs across the hand, or points back at it.

        One that hides behind its panel cannot be centred on the hand either.
        """
        if not np.isfinite(self.opens):
            return None
        yield from while_holding(self, self.hold, self.wait(0.3))
        try:
            seen = self._heading()
        except PerceptionFailure:  # beside the picture, or truly hidden
            yield from while_holding(self, self.hold, look_towards(self, hand_now(self, self.grip.hand)[:3, 3]))
            try:
                seen = self._heading()
            except PerceptionFailure as hidden:
                return SkillFailure(Reason.SLEEVE_FOLDED, f"{hidden}")
        beyond = float(seen.cuff_from_armhole_in_map @ unit(path.direction(2.5) * (1.0, 1.0, 0.0)))
        if beyond >= self.opens:
            return None
        return SkillFailure(
            Reason.SLEEVE_FOLDED,
            f"the cuff is {beyond * 100:.0f} cm beyond the armhole, {self.opens * 100:.0f} cm are asked for",
        )

    def _heading(self) -> SleeveHeading:
        """Which way the sleeve points, as the head's camera sees it."""
        seen = self.context.senses.sleeve_heading(
            self.world.look("head"),
            side=self.grip.arm,
            near_in_map=hand_now(self, self.grip.hand)[:3, 3],
        )
        return seen

    def _carry_out(self, path: ArmPath, taut: float) -> Iterator[None]:
        """Carry the sleeve beyond the fingertips, as far as the arm reaches."""
        problem: MotionError | None = None
        for beyond in STRAP_GRASP.presenting_distances:
            goal = presenting(self.grip, path.direction(2.5), presenting_position(path, beyond))
            try:
                motion = move_hands(self, {self.grip.hand: goal}, speed=careful(self, SPEED), way="either")
                yield from until_load(self, self.grip.hand, taut, motion)
                return
            except MotionError as stop:
                problem = stop
        assert problem is not None
        raise problem
