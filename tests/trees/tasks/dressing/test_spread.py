"""The stage `spread`, rehearsed with sleeves that are low and a collar that is off its place."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.sleeve.sleeve_profile import DEFAULT
from caretree.sim.world import SIDES
from caretree.skills.core.reasons import Reason, SkillFailure
from caretree.skills.geometry.stances import stance_at_head
from caretree.skills.retreat import Retreat
from caretree.skills.scripted.scripted_senses import ScriptedSenses
from caretree.skills.seat_sleeves import SeatSleeves
from caretree.trees.run.runner import run
from caretree.trees.run.task import load_task
from caretree.trees.run.worlds import prepare_stage

SEATED, FLAT = "gown/sleeves/seat", "fold/draw flat"
LAID = tuple(f"gown/{when}/spread" for when in ("then", "collar", "again", "off the face", "anew"))
PULLED = {f"{side} sleeve/pull up": side for side in SIDES}
ALONE = {f"{side} alone/seat": side for side in SIDES}
ON_FACE = -0.15  # along y, a collar so far headward lies over mouth and nose [m]
DRAWN_UP = 0.15  # how much farther up the arm a sleeve is after it was drawn up


class WornGown(ScriptedSenses):
    """Armholes at `reach` of the upper arms until they are drawn up, a collar that is `off` (x, y) until it is laid.

    Attributes:
        done: what was done to it, in turn.
        stands: where the robot stood then, but for folds.
        shown: how much of the neckline is seen.
        closely: where the hands' cameras see the collar, if that is another place.
        pulled: how much farther up a sleeve is after it was pulled by its strap.
        hidden: side of the sleeve that does not show.
        comes_on: whether it shows once that arm is dressed again.
        beside: side of the sleeve that the hands see beside its arm, until that arm is dressed again.
        near: how much higher the hands' cameras see an armhole than it is; None: it does not show to them.
        lower: how much lower an armhole is seen from the head of the bed, not from beside.
    """

    def __init__(
        self,
        world,
        reach,
        off,
        *,
        stays=False,
        outside=1.0,
        shown=1.0,
        closely=None,
        pulled=0.0,
        hidden=None,
        comes_on=False,
        lower=0.0,
        near=None,
        beside=None,
    ):
        super().__init__(world)
        self.near, self.beside = near, beside
        self.pulled, self.hidden, self.comes_on, self.lower = pulled, hidden, comes_on, lower
        self.outside, self.shown, self.closely = outside, shown, closely
        self.stands = []
        self.low, self.off, self.stays, self.done = dict(zip(SIDES, reach, strict=True)), off, stays, []

    def worn_sleeve(self, frame, *, side, arm_in_map):
        if side == self.hidden:
            raise PerceptionFailure(Problem.NOTHING_SEEN, "bindings")
        at_head = abs(self._world.observe().pose_base_in_map[0]) < 0.5
        seen = super().worn_sleeve(frame, side=side, arm_in_map=arm_in_map)
        seen = replace(seen, reach=self.low[side] - at_head * self.lower)
        return replace(seen, round_arm=0.2) if side == self.beside else seen

    def sleeve_profile(self, frame, *, side, arm_in_map):
        """None shows to the hands, unless they see it at its place but for an error of `near`."""
        if self.near is None or side == self.hidden:
            raise PerceptionFailure(Problem.NOTHING_SEEN, "armhole")
        base, *changes = DEFAULT.from_mean
        at = 1.0 - (self.low[side] + self.near - base - changes[1]) / changes[0]
        seen = super().sleeve_profile(frame, side=side, arm_in_map=arm_in_map)
        cuff = np.full(24, at + 0.5)
        if side == self.beside:
            cuff[:-4] = np.nan
        return replace(seen, armhole_at=np.full(24, at), cuff_at=cuff)

    def drawn(self, progress):
        """Told of what goes on: what was drawn up is higher up, what was laid straight lies there."""
        if progress.status == "success" and self.hidden and progress.name == f"{self.hidden} new/pull up":
            self.done.append(progress.name)
            self.hidden = None if self.comes_on else self.hidden
        if progress.status == "success" and self.beside and progress.name == f"{self.beside} new/pull up":
            self.done.append(progress.name)
            self.beside = None
        if progress.status == "success" and progress.name in PULLED and self.pulled:
            self.done.append(progress.name)
            self.low[PULLED[progress.name]] += self.pulled
        if progress.status == "success" and progress.name in ALONE:
            self.done.append(f"{ALONE[progress.name]} alone")
            self.low[ALONE[progress.name]] += DRAWN_UP
        if progress.status != "success" or progress.name not in (SEATED, FLAT, *LAID):
            return
        self.done.append(progress.name.rpartition("/")[2])
        if progress.name != FLAT:
            self.stands.append(self._world.observe().pose_base_in_map)
        if progress.name == SEATED:
            self.low = {side: low + DRAWN_UP for side, low in self.low.items()}
        if progress.name in LAID and not self.stays:
            self.off, self.closely = (0.0, 0.0), None
        if progress.name == FLAT and not self.stays:
            self.outside = 1.0
            self.low = {side: low - DRAWN_UP for side, low in self.low.items()}

    def skin_cover(self, frame, *, points_in_map):
        seen = super().skin_cover(frame, points_in_map=points_in_map)
        return replace(seen, share=1.0) if seen.share == 0.0 and self.off[1] < ON_FACE else seen

    def chest_cover(self, frame, *, shoulders_in_map):
        return replace(super().chest_cover(frame, shoulders_in_map=shoulders_in_map), outside=self.outside)

    def collar_middle(self, frame, *, near_in_map, away=(0.0, 0.0), beside=()):
        seen = super().collar_middle(frame, near_in_map=near_in_map, away=away, beside=beside)
        off = np.add(self.closely if self.closely and frame.camera != "head" else self.off, away)
        return replace(seen, confidence=self.shown, position_in_map=near_in_map + (*off, 0.13))


def rehearsed(reach, off=(0.0, 0.0), *, on_progress=None, **gown):
    """How the stage ends, and what was done to the gown in turn; `reach` of both armholes, or (2,)."""
    task = load_task("dressing")
    world, _ = task.scripted(1)
    prepare_stage(world, task, "spread")
    senses = WornGown(world, np.broadcast_to(reach, 2), off, **gown)

    def told(progress):
        senses.drawn(progress)
        if on_progress is not None:
            on_progress(progress)

    result = run(task, world, seed=1, senses=senses, params=task.parameters("spread"), on_progress=told)
    for stand in senses.stands:
        assert stand[:2] == pytest.approx(stance_at_head()[:2], abs=0.05), "drawn from the bed's head"
    return result.outcome, senses.done


@pytest.mark.parametrize(
    ("reach", "near", "lower", "done"),
    [
        (0.80, 0.0, 0.0, []),
        (0.80, 0.0, 0.3, []),  # seen low from the head of the bed
        (0.80, -0.12, 0.0, ["seat"]),
        (0.68, 0.05, 0.0, []),
        ((0.80, 0.60), 0.0, -0.3, ["seat"]),
        (0.60, 0.0, -0.3, ["seat"]),
    ],
)
def test_what_the_hands_see_of_the_sleeves_counts_where_they_do(reach, near, lower, done):
    went = []

    def on_progress(progress):
        went.append(progress.name)

    ends = rehearsed(reach, near=near, lower=lower, on_progress=on_progress)
    assert ends == ("success", done)
    assert not [name for name in went if "by/go" in name or "cuff" in name], "nobody has to look from beside the bed"


@pytest.mark.no_cover  # counting lines doubles its time
@pytest.mark.parametrize(
    ("reach", "ends", "done"),
    [
        (0.85, "success", []),
        (0.65, "success", ["seat"]),
        (0.50, "success", ["seat", "seat"]),
        ((0.85, 0.50), "success", ["seat", "seat"]),
        ((0.50, 0.85), "success", ["seat", "seat"]),
        (0.35, "success", ["seat", "seat", "seat"]),
        (0.05, "success", ["seat"] * 5),
        (-0.10, "success", ["seat"] * 6),
        (-0.40, "success", ["seat"] * 8),
        (-0.80, "success", [*["seat"] * 9, "spread", "seat", "seat"]),
    ],
)
def test_low_sleeves_are_drawn_up_and_once_more_where_that_was_not_enough(reach, ends, done):
    assert rehearsed(reach) == (ends, done)


@pytest.mark.parametrize(
    ("reach", "done"),
    [
        ((0.85, 0.05), ["right sleeve/pull up"]),
        ((0.05, 0.85), ["left sleeve/pull up"]),
        ((-0.60, 0.85), ["left sleeve/pull up"] * 2),
        ((0.45, 0.85), ["seat", "seat"]),
    ],
)
def test_a_sleeve_that_has_slipped_down_the_arm_is_pulled_up_before_the_gown_is_put_straight(reach, done):
    assert rehearsed(reach, pulled=0.70) == ("success", done)


@pytest.mark.parametrize(("right", "gone"), [(0.45, False), (0.35, True)])
def test_the_first_sleeve_is_gone_to_only_where_it_is_not_seen_up_from_the_head_of_the_bed(right, gone):
    leaves = []
    rehearsed((0.85, right), on_progress=lambda progress: leaves.append(progress.name))
    assert "left sleeve/go round to its side" in leaves
    assert ("right sleeve/go round to its side" in leaves) == gone


def test_a_hand_that_meets_the_person_as_it_draws_back_from_a_sleeve_draws_back_once_more(monkeypatch):
    def meets(skill, leaf):
        steps = skill.steps

        def once(self):
            if self.name == leaf and leaf not in met:
                met.append(leaf)
                raise SkillFailure(Reason.FORCE_LIMIT, "")
            yield from steps(self)

        monkeypatch.setattr(skill, "steps", once)

    met, went = [], []
    meets(SeatSleeves, SEATED)
    meets(Retreat, "gown/sleeves/leave them")
    ends = rehearsed(0.65, on_progress=lambda progress: went.append(progress.name))
    assert ends == ("success", ["seat"])
    back = went.index("gown/sleeves/on/leave them")
    assert went.index("gown/sleeves/leave them") < back < went.index("gown/sleeves/left/go up")


@pytest.mark.parametrize("side", SIDES)
def test_a_sleeve_that_does_not_show_is_not_claimed(side):
    assert rehearsed(0.85, hidden=side) == ("safe_stop", [f"{side} new/pull up"] * 6)


@pytest.mark.parametrize("side", SIDES)
def test_an_arm_whose_sleeve_does_not_show_is_dressed_again(side):
    assert rehearsed(0.85, hidden=side, comes_on=True) == ("success", [f"{side} new/pull up"])


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("reach", [0.80, 0.66])
def test_an_arm_whose_sleeve_lies_beside_it_as_seen_closely_is_dressed_again_and_not_drawn_up(side, reach):
    done = [f"{side} new/pull up"] if reach > 0.7 else [f"{side} new/pull up", "seat"]
    assert rehearsed(reach, near=0.0, beside=side) == ("success", done)


@pytest.mark.parametrize("off", [(0.14, 0.0), (-0.14, 0.0), (0.0, -0.18)])
def test_a_collar_that_is_off_its_place_is_laid_straight(off):
    assert rehearsed(0.85, off) == ("success", ["spread"])


def test_a_collar_over_the_face_is_laid_straight_before_a_sleeve_is_drawn_up():
    assert rehearsed(0.65, (0.0, -0.18)) == ("success", ["spread", "seat"])


def test_a_collar_over_the_face_is_laid_straight_however_little_of_it_shows():
    assert rehearsed(0.85, (0.0, -0.18), shown=0.5)[1][:1] == ["spread"]


def test_with_a_collar_that_stays_over_the_face_nothing_is_claimed_and_no_sleeve_drawn():
    outcome, done = rehearsed(0.65, (0.0, -0.18), stays=True)
    assert outcome == "safe_stop"
    assert set(done) == {"spread"}


def test_the_collar_is_laid_straight_once_the_sleeves_that_hide_it_are_up():
    assert rehearsed(0.65, (0.14, 0.0)) == ("success", ["seat", "spread"])


def test_a_sleeve_that_looks_a_little_low_from_the_head_of_the_bed_and_up_from_beside_is_left_alone():
    assert rehearsed(0.76, lower=0.06) == ("success", [])  # 0.715 in the mean


def test_a_sleeve_that_looks_low_from_the_head_of_the_bed_is_drawn_up_although_it_looks_up_from_beside():
    assert rehearsed(0.78, lower=0.12) == ("success", ["seat"])  # 0.70 in the mean


@pytest.mark.parametrize(
    ("reach", "ends", "done"),
    [
        ((0.80, 0.62), "success", ["right alone"]),
        ((0.80, 0.67), "success", ["right alone"]),  # 0.74 in the mean
        ((0.62, 0.80), "success", ["left alone"]),
        ((0.62, 0.62), "success", ["right alone", "left alone"]),
    ],
)
def test_a_sleeve_that_looks_up_from_the_head_of_the_bed_and_low_from_beside_is_drawn_up_alone(reach, ends, done):
    assert rehearsed(reach, lower=-0.14) == (ends, done)


def test_a_sleeve_that_stays_low_from_beside_the_bed_is_not_claimed():
    outcome, done = rehearsed((0.80, 0.10), lower=-0.65)
    assert (outcome, set(done)) == ("safe_stop", {"right alone", "spread"})


def test_a_sleeve_a_little_too_low_to_be_claimed_is_drawn_up():
    assert rehearsed(0.67) == ("success", ["seat"])


def test_a_gown_of_which_a_part_is_folded_over_ends_the_task_without_a_claim():
    outcome, done = rehearsed(0.85, outside=0.8, stays=True)
    assert outcome == "safe_stop"
    assert set(done) == {"draw flat"}


def test_a_front_that_is_folded_over_is_drawn_flat_before_the_sleeves_that_come_down_by_that():
    assert rehearsed(0.80, outside=0.8) == ("success", ["draw flat", "seat"])


def test_a_collar_that_stays_on_the_throat_ends_the_task_without_a_claim():
    outcome, done = rehearsed(0.85, (0.0, -0.25), stays=True)
    assert outcome == "safe_stop"
    assert done == ["spread"] * 18, "two after each of ten looks but the last"


@pytest.mark.parametrize(
    ("shown", "ends"), [(0.95, "success"), (0.82, "success"), (0.78, "safe_stop"), (0.60, "safe_stop")]
)
def test_a_collar_of_which_too_little_shows_closely_is_not_claimed(shown, ends):
    assert rehearsed(0.85, shown=shown)[0] == ends


@pytest.mark.parametrize(("aside", "done"), [(0.04, []), (-0.01, []), (0.07, ["spread"]), (-0.06, ["spread"])])
def test_a_collar_that_is_seen_aside_closely_is_laid_however_it_looks_from_the_head(aside, done):
    """It is seen 0.018 m too far to the right, closely as from the head."""
    assert rehearsed(0.85, closely=(aside, 0.0)) == ("success", done)
