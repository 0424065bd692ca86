"""Draw the sleeves of a worn gown up to the shoulders, one after the other, by the seams over the shoulders."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace

import numpy as np

from ..perception.errors import PerceptionFailure
from ..perception.estimates import ArmPosture, GraspPoint
from ..sim.quantity import Quantities, quantity
from ..sim.world import SIDES, Frame, Side
from .belief.close_look import CloseLook, reach_before, sleeve_seen
from .belief.face import FACE, cover_of, face_points
from .belief.person_motion import while_person_rests
from .belief.person_tracking import watch_arm
from .control.carry import Carry
from .control.fingers import let_cloth_go
from .control.hands import hand_now
from .control.head import look_towards
from .control.take_from_above import FromAbove, take_from_above
from .control.two_hands import carry_each
from .control.withdraw import withdraw
from .core.ports import Input
from .core.reasons import Reason, SkillFailure
from .core.skill import Skill
from .core.tries import Tries
from .geometry.arm_path import UP, ArmPath
from .geometry.stances import HEADWARD, outwards
from .motion.errors import MotionError


@dataclass(frozen=True, kw_only=True)
class SeatSleevesTuning(Quantities):
    """Numbers of `SeatSleeves`."""

    # deeper than on the body, as the mattress is 6 cm below: flat cloth at the very fingertips was missed (104)
    grasp: FromAbove = field(default_factory=lambda: FromAbove(depth=0.02))
    leans: tuple[float, ...] = quantity(
        (0.45, 0.25, 0.0),
        "rad",
        "of the hands outwards, off the vertical, tried in turn",
        "choice: upright hands come no nearer to the midline than 0.15 m before their wrists meet",
    )
    taken_at: tuple[float, ...] = quantity(
        (0.0, 0.03, 0.06),
        "m",
        "footward of where a seam is seen, where it is taken, the next one after each miss",
        "measured: taken where it was seen, the fingers closed 0.023 m headward and 0.016 m outside of cloth that was "
        "there, five times alike (0)",
    )
    beside: float = quantity(
        0.07,
        "m",
        "off the arm's axis to the side, to which a seam that was taken below that axis is drawn before it is lifted",
        "measured: lifted straight up from 0.047 m beside it, 0.05 m below, cloth in the hand went 16 and 18 mm into "
        "the arm (189, 190); from 0.061 m on it went into none (22 draws)",
    )
    lift: float = quantity(0.12, "m", "of the seams before they are drawn", "choice: they clear the shoulders")
    drawn_to: tuple[float, float] = quantity(
        (0.10, 0.10),
        "m",
        "inwards and headward from the shoulder, where the end of the seam of a low armhole is drawn to, and of one "
        "that was drawn before: it then goes round the shoulder, not the arm",
        "measured, the right one alone: from 0.44 and 0.59 to 0.93 and 0.78, the collar 0.08 m headward (106, 112); "
        "drawn 0.16 m headward to 0.77 and 0.74, the collar 0.09 m",
    )
    drawn_less: tuple[float, float] = quantity(
        (0.05, 0.07),
        "m",
        "likewise, of an armhole that is almost up",
        "choice: between 0.09 m headward, at which left ones went from 0.62 to 0.92 and from 0.72 to 0.87 (106, 142), "
        "and 0.03 and 0.05 m, at which one went from 0.70 to 0.75 (106)",
    )
    low_and_almost: tuple[float, float] = quantity(
        (0.49, 0.64),
        "1",
        "of the upper arm, between which the way of the left one goes from all of it to less",
        "choice: as measured, by a look that told 0.04 less than now",
    )
    low_and_almost_right: tuple[float, float] = quantity(
        (0.62, 0.77),
        "1",
        "likewise of the right one, which was pulled on first, and slid down as the left one was",
        "measured: drawn like left ones, right ones at 0.55 to 0.62 came to rest at 0.67 to 0.75 (five first draws), "
        "those below 0.52, drawn all the way, at 0.73 to 0.81 (nine); left ones at 0.72 to 0.94",
    )
    up_already: float = quantity(
        0.80,
        "1",
        "of the upper arm, from which an armhole is left alone while the other one is lower",
        "measured: drawn up with the other one, an armhole at 0.87 came to 1.00 and the collar 0.15 m headward (106)",
    )
    up_by_now: float = quantity(
        0.72,
        "1",
        "likewise, of one that was drawn up before",
        "measured: a left one at 0.71 that was drawn up alone came to 0.79, and the right one, at 0.75, and the collar "
        "stayed; with both drawn, 0.04 m aside and headward went the collar, and four rounds followed (157)",
    )
    enough_draws: int = quantity(
        2,
        "1",
        "after which an armhole that is most likely up, and was brought no higher by the last one, is left as it is; "
        "asked for once more, it is drawn again",
        "measured: right ones seen at 0.66 to 0.72, at 0.71 to 0.80 in truth, were drawn up five times more, seen no "
        "higher, and had the collar 0.12 m headward each time (159, 161); left alone each time, one at 0.69 was never "
        "claimed (258)",
    )
    likely_up: float = quantity(
        0.70,
        "1",
        "of the upper arm, from which an armhole is most likely up, as it is seen",
        "choice: what is seen is 0.006 too low on average",
    )
    brought_higher: float = quantity(
        0.03, "1", "of the upper arm, by which a draw raises an armhole that is drawn again", "choice: half of an error"
    )
    chin_covered: float = quantity(
        0.5,
        "1",
        "share of the chin that does not show skin, from which seams are carried no farther",
        "measured: 0 in draws whose collar came 0.13 m headward (176, 177), 1 half a second before the one of 178 was "
        "over the mouth",
    )
    back: float = quantity(
        0.08,
        "m",
        "footward, by which seams are carried back then",
        "measured: let down where they were, they drew the collar on by 0.06 m, over the mouth (178)",
    )
    on_shoulder: float = quantity(
        0.13,
        "m",
        "above where it is laid behind the shoulder, to which it is let down then",
        "measured: as low as there, hands met the shoulders with 36 and 47 N (178); 0.10 m above it, fingers that "
        "opened met the trunk with 123 N (150)",
    )
    laid_at: float = quantity(
        0.0,
        "m",
        "above the shoulder, where it is let go of",
        "measured: 0.04 m lower, 0.10 m headward, a hand met the shoulder with 49 N (106)",
    )
    apart: float = quantity(
        0.04,
        "m",
        "between the robot's arms, at which the hands come no nearer to each other",
        "choice: nothing else keeps them apart while they are driven by velocities; at 0.10 m from the shoulders hands "
        "that leaned inwards were 8 cm inside each other",
    )
    # at 6.5 N, with 8.1 N for a moment, 1 % of the cloth's edges were 28 % longer, at 6 N and 7.5 N 23 and 25 % (101)
    carry: Carry = field(default_factory=lambda: Carry(max_load=5.5))
    withdrawal: float = quantity(0.12, "m", "by which the open hands are drawn back", "choice: clear of the sleeves")


@dataclass
class Drawn:
    """How often each sleeve was drawn up in this run, how far up it was seen before, and which were left as they were.

    Attributes:
        times: by the person's side.
        reach: before the last time, share of the upper arm.
        left: those that were not drawn up the last time, as they would come no higher.
        missed: how often in turn each seam was not between the fingers, by side.
    """

    times: dict[Side, int] = field(default_factory=lambda: dict.fromkeys(SIDES, 0))
    reach: dict[Side, float] = field(default_factory=dict)
    left: set[Side] = field(default_factory=set)
    missed: dict[Side, int] = field(default_factory=lambda: dict.fromkeys(SIDES, 0))


class SeatSleeves(Skill):
    """Takes the outer end of the seam over a shoulder, and lays it down behind that shoulder.

    An armhole that lies on the arm has its front at the chest and its lower end in the armpit; what hangs low is the
    seam above it, outside the shoulder.  Drawn over the shoulder it stays there.  Drawn by the front edge instead, the
    cloth was stretched, and the armhole went back down the arm by 0.2 as it was let go of.  The left one is drawn
    first, then the right one, each as far as it is low: drawn at once, both took the collar headward by 0.08 m and more
    between them, and laid down from there it took the right one along.  One that is up already is left alone, and so is
    one that is most likely up and comes no higher; once they were drawn, one that is up is left.  One that is missed
    does not keep the other from being drawn.
    The robot stands at the head of the bed, each hand on its side, and the arms have to lie.  The hands end open and
    drawn back, after a missed grasp too.
    """

    side = Input(Side, default=None, doc="whose sleeve is drawn up, alone and however high it is; None: both, if low")
    up = Input(float, unit="1", default=0.0, doc="of the upper arm, from which an armhole seen closely is left alone")
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
        """Look at both, then draw up those that are low, one after the other."""
        drawn = self.context.memory.of(Drawn, Drawn)
        shoulders = np.array([watch_arm(self, side).points_in_map[0] for side in SIDES])
        reach: dict[Side, float] = {}
        left_before = set(drawn.left)
        drawn.left.clear()
        for n, side in enumerate(SIDES):  # before a hand comes in between
            yield from look_towards(self, shoulders[n])
            reach[side] = self._reach(self.world.look("head"), side)
        low: list[Side] = [side for side in SIDES if self._is_drawn(side, reach[side], drawn, left_before)]
        if not low:
            self.note("both are up already, or come no higher")
            return
        turns, problems = self._turns(low, reach, drawn), list[PerceptionFailure | MotionError | SkillFailure]()
        for side in turns:
            try:
                yield from self._draw_up(side, reach[side], shoulders, followed=side != turns[-1])
            except (PerceptionFailure, MotionError, SkillFailure) as problem:
                # one that does not show, or is missed, does not keep the other from being drawn
                if isinstance(problem, SkillFailure) and problem.reason != Reason.GRASP_MISSED:
                    raise
                problems.append(problem)
        if len(problems) == len(turns):
            raise problems[-1]

    def _draw_up(self, side: Side, reach: float, shoulders: np.ndarray, *, followed: bool) -> Iterator[None]:
        """Take the seam over one shoulder, lift it, draw it over the shoulder, lay it down, let go.

        Args:
            side: whose sleeve.
            reach: of the upper arm, as it is seen.
            shoulders: (2, 3) in the map [m].
            followed: the other sleeve is drawn up next.
        """
        tuning, drawn, n = self.tuning, self.context.memory.of(Drawn, Drawn), SIDES.index(side)
        arm = watch_arm(self, side)
        yield from look_towards(self, shoulders[n])
        seam = self.context.senses.shoulder_seam(self.world.look("head"), side=side, shoulders_in_map=shoulders)
        yield from self._take(side, seam)
        self.note(f"draws the {side} sleeve up")
        yield from self._off_the_arm(side, arm)
        yield from self._carry(side, hand_now(self, side)[:3, 3] + tuning.lift * UP)
        inward, headward = self._drawn_to(side, reach, again=followed or drawn.times[side] > 0)
        drawn.times[side] += 1
        drawn.reach[side] = reach
        CloseLook.of(self).before.pop(side, None)
        laid = shoulders[n] - inward * outwards(side) + headward * HEADWARD + tuning.laid_at * UP
        yield from self._draw(side, laid, np.mean(shoulders, axis=0))
        yield from let_cloth_go(self, side)
        yield from withdraw(self, [side], tuning.withdrawal)

    def _carry(self, side: Side, place: np.ndarray) -> Iterator[None]:
        yield from carry_each(self, {side: place}, self.tuning.carry, self.tuning.apart)

    def _off_the_arm(self, side: Side, arm: ArmPosture) -> Iterator[None]:
        """Draw a seam that was taken low beside the arm away from it: lifted from there, it would come up in it."""
        hand, path = hand_now(self, side)[:3, 3], ArmPath.of(arm)
        at = path.coordinate_of(hand)
        across, off = path.frame(at)[:, 0], hand - path.point(at)
        missing = self.tuning.beside - abs(float(off @ across))
        if missing > 0.0 and off @ UP < 0.0:
            yield from self._carry(side, hand + math.copysign(missing, float(off @ across)) * across)

    def _draw(self, side: Side, laid: np.ndarray, middle: np.ndarray) -> Iterator[None]:
        """Carry a seam over the shoulder and lay it down, no farther headward than the chin shows.

        It lifts the collar: over mouth and nose, it lay there until it was laid straight (178, 267).
        """
        yield from look_towards(self, middle)
        over = np.append(laid[:2], hand_now(self, side)[2, 3])
        for place in (over, laid):
            for _ in self._carry(side, place):
                if self._chin_covered(middle):
                    yield from self._draw_back(side, laid)
                    return
                yield

    def _draw_back(self, side: Side, laid: np.ndarray) -> Iterator[None]:
        """Carry the seam a little footward, and lay it down there, over the shoulder behind which it was `laid`.

        Let down where it is, behind the shoulder, it draws the collar on by 0.06 m.
        """
        tuning = self.tuning
        self.note("the collar has come to the chin")
        hand = hand_now(self, side)[:3, 3]
        # up first: drawn back from behind the shoulder, a hand met the trunk from there with 49 N (118)
        above = np.append(hand[:2], max(hand[2], laid[2] + tuning.on_shoulder))
        back = above - tuning.back * HEADWARD
        for place in (above, back, np.append(back[:2], laid[2] + tuning.on_shoulder)):
            yield from self._carry(side, place)

    def _chin_covered(self, middle: np.ndarray) -> bool:
        """Whether cloth is about to come over mouth and nose; a face that does not show now was looked at before."""
        with suppress(PerceptionFailure):
            return cover_of(self, face_points(self, middle, FACE.chin)).share > self.tuning.chin_covered
        return False

    def _reach(self, frame: Frame, side: Side) -> float:
        """How far up the upper arm an armhole is seen, closely if it was.

        One that does not show is where it was seen last, before it was drawn: one at 0.95, hidden behind its shoulder,
        was taken for the lower one, and drawn down to 0.39 (311).  Where nobody has seen it, it is low: somebody asked
        for this skill.
        """
        closely = sleeve_seen(self, side)
        if closely is not None:
            return closely.reach
        arm = watch_arm(self, side).points_in_map
        try:
            return self.context.senses.worn_sleeve(frame, side=side, arm_in_map=arm).reach
        except PerceptionFailure:
            return reach_before(self, side)

    def _is_drawn(self, side: Side, reach: float, drawn: Drawn, left_before: set[Side]) -> bool:
        """Whether an armhole seen at `reach` is to be drawn up; one that is left for once is noted.

        Where it was looked at closely, that tells.  Else one that is most likely up is left, every other time.
        """
        if self.side is not None:
            return side == self.side
        if self.up > 0.0 and sleeve_seen(self, side) is not None:
            return reach < self.up
        if side not in left_before and self._as_high_as_it_gets(side, reach, drawn):
            drawn.left.add(side)
            return False
        return reach < self.tuning.up_already

    def _as_high_as_it_gets(self, side: Side, reach: float, drawn: Drawn) -> bool:
        """Whether an armhole seen at `reach` is most likely up, and was seen no lower before it was drawn last."""
        tuning = self.tuning
        often, likely = drawn.times[side] >= tuning.enough_draws, reach >= tuning.likely_up
        return often and likely and reach < drawn.reach.get(side, 0.0) + tuning.brought_higher

    def _turns(self, low: list[Side], reach: Mapping[Side, float], drawn: Drawn) -> list[Side]:
        """Of those that may be drawn up, which are, the left one first.

        The right one, drawn first, came to rest 0.04 lower in the mean, as the left one took it along, and the left one
        0.05 higher: the lower of both was at 0.67 to 0.75 then, at 0.70 to 0.76 this way (108, 115, 118, 125, 134, each
        from one state both ways).  One that was drawn before and is up by now is left, unless it is the lowest.  A left
        one that is almost up waits while the right one is lower: drawn alone, that came to rest at 0.93, with a left
        one drawn up from 0.72 after it at 0.72 (106).
        """
        still_low = [side for side in low if not drawn.times[side] or reach[side] < self.tuning.up_by_now]
        turns = still_low or [min(low, key=lambda side: reach[side])]
        if self.tuning.low_and_almost[1] <= reach["left"] and reach["right"] < reach["left"] and "right" in turns:
            return ["right"]
        return [side for side in SIDES if side in turns]

    def _drawn_to(self, side: Side, reach: float, *, again: bool) -> tuple[float, float]:
        """Inwards and headward from the shoulder [m]: the first time the less the higher the armhole is.

        All of it for one that the other one takes along as it is drawn after it: a left one at 0.62 came to 0.73 by
        that, to 0.68 by less (134).
        """
        tuning = self.tuning
        if self.side or again:
            return tuning.drawn_to
        between = tuning.low_and_almost if side == "left" else tuning.low_and_almost_right
        less, all_of_it = np.array(tuning.drawn_less), np.array(tuning.drawn_to)
        inward, headward = less + np.interp(reach, between, (1.0, 0.0)) * (all_of_it - less)
        return float(inward), float(headward)

    def _take(self, side: Side, seam: GraspPoint) -> Iterator[None]:
        """Grasp one seam, leaning outwards as far as the arm reaches it that way."""
        self.note(f"takes the seam over the {side} shoulder")
        outward, tries, missed = outwards(side), Tries(MotionError), self.context.memory.of(Drawn, Drawn).missed
        footward = self.tuning.taken_at[missed[side] % len(self.tuning.taken_at)]
        place = seam.position_in_map - footward * HEADWARD
        for lean in self.tuning.leans:
            approach = -math.cos(lean) * UP - math.sin(lean) * outward
            leaning = replace(seam, position_in_map=place, approach_in_map=approach)
            with tries:
                try:
                    yield from take_from_above(self, side, leaning, outward, self.tuning.grasp)
                except SkillFailure as failure:
                    missed[side] += failure.reason == Reason.GRASP_MISSED
                    raise
                missed[side] = 0
                return
        raise tries.last
