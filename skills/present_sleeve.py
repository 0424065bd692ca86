"""Bring the sleeve from where it lay to the fingertips, its armhole hanging open towards the hand."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Generator, Iterator
from dataclasses import dataclass

import numpy as np

from ..perception.errors import PerceptionFailure
from ..perception.estimates import SleeveHeading
from ..perception.image.cloud import unit
from ..sim.quantity import Quantities, quantity
from .belief.person_motion import while_person_rests
from .belief.person_tracking import careful, watch_arm
from .belief.short_gown import short_gown
from .belief.strap_grasp import STRAP_GRASP, presenting_position
from .belief.strap_turn import strap_turns, turned_strap
from .control.compliant_hold import while_holding
from .control.hands import cloth_load, hand_now, move_hands, until_load
from .control.head import look_towards
from .core.ports import Input
from .core.reasons import Reason, SkillFailure
from .core.skill import Skill
from .core.tries import Tries
from .geometry.arm_path import UP, ArmPath
from .geometry.hold import Hold
from .geometry.stances import outwards
from .geometry.strap_grip import StrapGrip, presenting
from .motion.errors import MotionError


@dataclass(frozen=True, kw_only=True)
class PresentSleeveTuning(Quantities):
    """Numbers of bringing a sleeve before the hand."""

    raise_height: float = quantity(
        0.14, "m", "off the bed, before anything else", "choice: clear of the arm that lies there"
    )
    raise_outwards: float = quantity(
        0.06, "m", "from the body, on that way", "choice: clear of the arm that lies there"
    )
    raise_shares: tuple[float, ...] = quantity(
        (1.0, 0.6, 0.3, 0.0),
        "1",
        "of that way, tried one after the other",
        "choice: as far as the robot's arm reaches and the person's hand, lifted over the sleeve, leaves room",
    )
    speed: float = quantity(0.30, "m/s", "of the hand away from the person", "choice: the sleeve hardly swings")
    settle_time: float = quantity(
        0.3, "s", "waited for a sleeve to stop swinging", "choice: it hardly moves after that"
    )
    before_fingertips: float = quantity(
        0.10, "m", "from the fingertips to the strap in the end, along the hand", "choice: room to centre the armhole"
    )
    clearance: float = quantity(
        0.09, "m", "of the strap above the hand's axis in the end", "choice: half a hoop, which hangs below the strap"
    )
    look_coordinate: float = quantity(
        2.6,
        "1",
        "arm coordinate that the head looks at",
        "choice: from there the shoulder and a sleeve beyond the hand are in view",
    )
    hand_coordinate: float = quantity(
        2.5, "1", "arm coordinate whose direction counts as that of the hand", "design: the middle of the hand"
    )
    second_load: float = quantity(
        1.2,
        "1",
        "greatest load the next times, in times of `max_load`, for a sleeve that did not open",
        "choice: carried in from farther out, the cuff trails behind",
    )
    attempts: int = quantity(3, "1", "to bring it open before the hand", "choice: the strap is turned between them")
    min_pointing: float = quantity(
        0.06, "m", "level way from armhole to cuff that has a direction", "choice: a sleeve that hangs has none"
    )
    turn_shares: tuple[float, ...] = quantity(
        (1.0, 0.6, 0.0),
        "1",
        "of the angle by which the sleeve points elsewhere that the strap is turned, tried one after the other",
        "choice: as far as the wrist turns",
    )
    min_load: float = quantity(
        0.2, "N", "load below which no sleeve hangs from the hand", "choice: a sleeve in the air pulls harder"
    )
    caught_load: float = quantity(
        4.5,
        "N",
        "load from which the gown hangs on something",
        "measured: 5.4 N stretched a hundredth of the threads by 28 % (134), 4.5 to 5 N by 26 %; 25 % are allowed",
    )
    max_short: float = quantity(
        0.15,
        "m",
        "of its place before the fingertips, by which a sleeve that pulls hard may stop",
        "measured: 0.36 and 0.40 m short, pulling with 4.4 N, two went past the hand (178, 193); of three that were "
        "0.08 to 0.13 m short two went over it (163, 185, 187), of 61 that were brought all the way 52",
    )
    back_attempts: int = quantity(
        2, "1", "at the way back before the fingertips, which may lead farther out", "choice: the second way is shorter"
    )


@dataclass(frozen=True)
class _Folded:
    """A sleeve that does not open: why, and by which angle about the vertical it would have to be turned [rad]."""

    failure: SkillFailure
    angle: float


class PresentSleeve(Skill):
    """Raises the sleeve, carries it to a place beyond the fingertips and turns it there, never over the arm.

    Held by its strap across the arm's direction, the armhole hangs open like a hoop for the hand.  A sleeve that does
    not open is carried out once more, farther, and its strap is turned by as much as the sleeve points elsewhere.

    It fails where the sleeve still does not open, where the gown is caught on something, where the strap or the arm
    slips out of the fingers, where a place is out of reach, and where the person moves.
    """

    grip = Input(StrapGrip, doc="how the strap is held")
    hold = Input(Hold, default=None, doc="the hand that holds the arm, or None")
    max_load = Input(
        float,
        unit="N",
        default=np.inf,
        doc="load at which the sleeve is carried no farther, lest the gown be drawn off the other arm",
    )
    min_cuff_distance = Input(
        float,
        unit="m",
        default=-np.inf,
        doc="how far beyond the armhole, along the hand, the cuff has to show in the end; -inf to let anything pass",
    )
    tuning = Input(PresentSleeveTuning, default=PresentSleeveTuning(), doc="numbers of this skill")
    reasons = (
        Reason.UNREACHABLE,
        Reason.MOTION_BLOCKED,
        Reason.CLOTH_SLIPPED,
        Reason.ARM_LOST,
        Reason.COMMAND_LOST,
        Reason.ARM_SLIPPED,
        Reason.PERSON_MOVED,
        Reason.FORCE_LIMIT,
        Reason.SLEEVE_FOLDED,
        Reason.SLEEVE_CAUGHT,
    )

    def steps(self) -> Iterator[None]:
        """Present the sleeve as long as the person does not move."""
        yield from while_person_rests(self, self._present())

    def _present(self) -> Iterator[None]:
        """Up, then beyond the fingertips."""
        arm, hand = self.grip.arm, self.grip.hand
        self.note(f"brings the {arm} sleeve to the fingertips")
        self.context.guard.declare_grip(hand, "cloth")
        yield from while_holding(self, self.hold, self._raise())
        if np.linalg.norm(cloth_load(self, hand)) < self.tuning.min_load:
            raise SkillFailure(Reason.CLOTH_SLIPPED, f"nothing pulls at the {hand} hand")
        path = ArmPath.of(watch_arm(self, arm, hold=self.hold))
        yield from while_holding(self, self.hold, look_towards(self, path.point(self.tuning.look_coordinate)))
        yield from self._bring(path, self.max_load)
        folded = yield from self._folded(path)
        for again in range(self.tuning.attempts - 1 if np.isfinite(self.max_load) else 0):
            if folded is None or (again and not folded.angle):
                break
            self.note(f"brings the {arm} sleeve from farther out")  # on its way back the cuff trails behind
            try:
                yield from self._bring_turned(path, folded.angle)
            except MotionError:
                break
            folded = yield from self._folded(path)
        if folded is not None:
            raise folded.failure

    def _raise(self) -> Iterator[None]:
        """Off the bed and aside; where that is out of reach, as far as is not."""
        tuning, hand, start = self.tuning, self.grip.hand, hand_now(self, self.grip.hand)
        tries = Tries(MotionError)
        for share in tuning.raise_shares:
            raised = start.copy()
            raised[:3, 3] += share * (tuning.raise_height * UP + tuning.raise_outwards * outwards(self.grip.arm))
            with tries:
                yield from move_hands(self, {hand: raised}, speed=careful(self, tuning.speed), way="either")
                return
        raise tries.last

    def _bring_turned(self, path: ArmPath, angle: float) -> Iterator[None]:
        """Bring it from farther out, the strap turned by an angle [rad] about the vertical, or as far as can be."""
        turns, hand, tries = strap_turns(self), self.grip.hand, Tries(MotionError)
        before = turns[hand]
        for share in self.tuning.turn_shares if angle else (0.0,):
            turns[hand] = before + share * angle
            with tries:
                yield from self._bring(path, self.tuning.second_load * self.max_load)
                return
        raise tries.last

    def _bring(self, path: ArmPath, max_load: float) -> Iterator[None]:
        """Out beyond the fingertips, then back before them."""
        tuning, hand = self.tuning, self.grip.hand
        yield from while_holding(self, self.hold, self._carry_out(path, max_load))
        yield from while_holding(self, self.hold, self.wait(tuning.settle_time))  # the sleeve stops swinging
        if np.linalg.norm(cloth_load(self, hand)) < tuning.min_load:
            raise SkillFailure(Reason.CLOTH_SLIPPED, f"nothing pulls at the {hand} hand")
        path = ArmPath.of(watch_arm(self, self.grip.arm, hold=self.hold))
        place = path.moved(3.0, tuning.before_fingertips)
        start = path.point(place) + tuning.clearance * path.frame(place)[:, 2]
        goal = presenting(turned_strap(self, self.grip), path.direction(tuning.hand_coordinate), start)
        load = short = np.inf
        for _ in range(tuning.back_attempts):
            motion = move_hands(self, {hand: goal}, speed=careful(self, tuning.speed), way="either")
            yield from while_holding(self, self.hold, until_load(self, hand, tuning.caught_load, motion))
            load = float(np.linalg.norm(cloth_load(self, hand)))
            short = float(np.linalg.norm(hand_now(self, hand)[:3, 3] - goal[:3, 3]))
            if load <= tuning.caught_load and short <= tuning.max_short:
                return
        short_gown(self).add(self.grip.arm)
        raise SkillFailure(Reason.SLEEVE_CAUGHT, f"{short:.2f} m before its place the gown pulls with {load:.1f} N")

    def _folded(self, path: ArmPath) -> Generator[None, None, _Folded | None]:
        """A sleeve whose back panel lies folded over the strap hangs across the hand, or points back at it.

        One that hides behind its panel cannot be centred on the hand either.  Where the armhole shows and the cuff does
        not, the cuff may be behind it: of three such sleeves two were open before the hand, and laid down again their
        gowns slid off the bed (0, 196); a pull that misses the hand costs no more than that.
        """
        if not np.isfinite(self.min_cuff_distance):
            return None
        yield from while_holding(self, self.hold, self.wait(self.tuning.settle_time))
        try:
            seen = self._heading()
        except PerceptionFailure:  # beside the picture, or truly hidden
            yield from while_holding(self, self.hold, look_towards(self, hand_now(self, self.grip.hand)[:3, 3]))
            try:
                seen = self._heading()
            except PerceptionFailure as hidden:
                if self._armhole_shows():
                    return None
                return _Folded(SkillFailure(Reason.SLEEVE_FOLDED, f"{hidden}"), 0.0)
        heading = unit(path.direction(self.tuning.hand_coordinate) * (1.0, 1.0, 0.0))
        beyond = float(seen.cuff_from_armhole_in_map @ heading)
        if beyond >= self.min_cuff_distance:
            return None
        failure = SkillFailure(
            Reason.SLEEVE_FOLDED,
            f"the cuff is {beyond * 100:.0f} cm beyond the armhole, "
            f"{self.min_cuff_distance * 100:.0f} cm are asked for",
        )
        aside = float(seen.cuff_from_armhole_in_map @ np.cross(UP, heading))
        points = math.hypot(aside, beyond) > self.tuning.min_pointing
        return _Folded(failure, -math.atan2(aside, beyond) if points else 0.0)

    def _armhole_shows(self) -> bool:
        """Whether either camera that steers a pull sees the armhole."""
        hand = self.grip.hand
        for camera in ("head", f"{hand}_hand"):
            with contextlib.suppress(PerceptionFailure):
                self.context.senses.held_armhole(
                    self.world.look(camera), side=self.grip.arm, near_in_map=hand_now(self, hand)[:3, 3]
                )
                return True
        return False

    def _heading(self) -> SleeveHeading:
        """Which way the sleeve points, as the head's camera sees it."""
        seen = self.context.senses.sleeve_heading(
            self.world.look("head"),
            side=self.grip.arm,
            near_in_map=hand_now(self, self.grip.hand)[:3, 3],
        )
        return seen

    def _carry_out(self, path: ArmPath, max_load: float) -> Iterator[None]:
        """Carry the sleeve beyond the fingertips, as far as the arm reaches."""
        tuning, hand, tries = self.tuning, self.grip.hand, Tries(MotionError)
        grip = turned_strap(self, self.grip)
        for beyond in STRAP_GRASP.presenting_distances:
            goal = presenting(grip, path.direction(tuning.hand_coordinate), presenting_position(path, beyond))
            with tries:
                motion = move_hands(self, {hand: goal}, speed=careful(self, tuning.speed), way="either")
                yield from until_load(self, hand, max_load, motion)
                return
        raise tries.last
