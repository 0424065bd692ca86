"""Worn sleeves are taken by the seams over the shoulders, the right one first, and laid down behind the shoulders."""

import math

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.estimates import Cover, Estimate, GraspPoint, WornSleeve
from caretree.sim.world import SIDES
from caretree.skills.belief.close_look import CloseLook, SleeveSeen
from caretree.skills.control.hands import gap_between_arms
from caretree.skills.core.reasons import Reason
from caretree.skills.geometry.arm_path import UP, ArmPath
from caretree.skills.geometry.stances import HEADWARD, outwards, stance_at_head
from caretree.skills.scripted.scripted_person import lying_posture
from caretree.skills.seat_sleeves import Drawn, SeatSleeves, SeatSleevesTuning

from .bench import LeafBench, beside_bed, pulls

SHOULDERS = {side: lying_posture(side).points_in_map[0] for side in SIDES}
SEAMS = {side: shoulder + 0.15 * outwards(side) + 0.10 * HEADWARD for side, shoulder in SHOULDERS.items()}  # [m]
HIDDEN = PerceptionFailure(Problem.NOTHING_SEEN, "cloth")
BED = 0.6  # [m]
LEANS = SeatSleevesTuning().leans  # [rad]
HELD = Estimate(stamp=0.0, confidence=0.9)


def bench(
    *,
    cloth=HELD,
    hidden=(),
    leans=LEANS,
    reach=None,
    side=None,
    up=0.0,
    each_tick=lambda bench: None,
    chin=lambda: 0.0,
    seams=SEAMS,
):
    reaches = dict.fromkeys(SIDES, 0.3) if reach is None else reach

    def worn(frame, side, arm_in_map):
        if reaches[side] is None:
            raise HIDDEN
        seen = {"armhole_at": 0.4, "cuff_at": 0.6, "reach": reaches[side], "round_arm": 0.6}
        return WornSleeve(stamp=0.0, confidence=0.9, side=side, **seen)

    def seam(frame, side, shoulders_in_map):
        if side in hidden:
            raise HIDDEN
        assert shoulders_in_map == pytest.approx(np.array(list(SHOULDERS.values())), abs=0.02)
        return GraspPoint(
            stamp=0.0,
            confidence=0.9,
            target=f"sleeve_{side}",
            position_in_map=seams[side],
            approach_in_map=np.array((0.0, 0.0, -1.0)),
            closing_in_map=np.array((0.0, 1.0, 0.0)),
        )

    return LeafBench(
        lambda context: SeatSleeves("seat", context, side=side, up=up, tuning=SeatSleevesTuning(leans=leans)),
        beside_bed(
            stand=stance_at_head(),
            shoulder_seam=seam,
            worn_sleeve=worn,
            gripped_cloth=cloth,
            skin_cover=lambda frame, points_in_map: Cover(stamp=0.0, confidence=0.9, share=chin()),
            arm=lambda frame, side, **_: lying_posture(side),
        ),
        each_tick=each_tick,
    )


def drawn(run, side):
    """Positions (n, 3) of a hand while its fingers were closed [m]."""
    return run.way(side)[run.openings(side) < 0.005]


def last_held(run, side):
    """Position (3,) of a hand where it lets go [m]."""
    return run.way(side)[run.openings(side) < 0.005][-1]


def test_both_are_taken_outside_the_shoulders_drawn_over_them_and_laid_down_behind_them():
    run = bench()
    assert run.ended() is None
    for side in SIDES:
        way, shoulder = drawn(run, side), SHOULDERS[side]
        assert way[0] == pytest.approx(SEAMS[side], abs=0.03)
        off = way - shoulder
        outside = off @ outwards(side)
        crossing = np.argmin(np.abs(outside))
        assert off[crossing, 2] > 0.08, "over the shoulder, not through it"
        assert outside[-1] == pytest.approx(-0.10, abs=0.03)
        assert off[-1] @ HEADWARD > 0.08, "behind the shoulder"
        assert BED + 0.02 < way[-1, 2] < shoulder[2], "just above the mattress"
        assert run.way(side)[-1, 2] - way[-1, 2] > 0.08, "drawn back"


def test_seams_that_take_the_collar_to_the_chin_are_drawn_back_and_laid_down():
    looks = []

    def chin():
        looks.append(None)
        return float(len(looks) % 9 == 0)

    run = bench(chin=chin)
    assert run.ended() is None
    assert len(looks) == 18, "once it is covered, each seam goes back and down"
    for side in SIDES:
        off = last_held(run, side) - SHOULDERS[side]
        farthest = (drawn(run, side) - SHOULDERS[side]) @ HEADWARD
        assert off @ HEADWARD == pytest.approx(farthest.max() - 0.08, abs=0.02)
        assert off[2] == pytest.approx(0.13, abs=0.02), "over the shoulder"


def test_a_hand_that_is_behind_the_shoulder_by_then_goes_up_before_it_is_drawn_back():
    def chin():
        off = run.skill.world.observe().pose_hand_in_map[SIDES.index("left"), :3, 3] - SHOULDERS["left"]
        return float(off @ HEADWARD > 0.06 and off[2] < 0.05)

    run = bench(chin=chin, side="left")
    assert run.ended() is None
    off = drawn(run, "left") - SHOULDERS["left"]
    back = (off @ HEADWARD > 0.0) & (np.gradient(off @ HEADWARD) < -0.001)  # per tick [m]
    assert back.any()
    assert np.all(off[back, 2] > 0.07)  # [m] above the shoulder


@pytest.mark.parametrize("lean", [0.0, 0.45])  # of the hands, outwards [rad]
def test_the_arms_stay_apart(lean):
    gaps = []
    run = bench(leans=(lean,), each_tick=lambda bench: gaps.append(gap_between_arms(bench.skill)))
    assert run.ended() is None
    assert min(gaps) > 0.02  # [m]


def test_the_left_one_is_let_go_of_before_the_right_one_is_taken():
    run = bench()
    assert run.ended() is None
    left, right = (np.flatnonzero(run.openings(side) < 0.005) for side in SIDES)
    assert left[-1] < right[0]


@pytest.mark.parametrize(("below", "aside"), [(0.01, 0.07), (-0.05, 0.045)])
def test_a_seam_that_is_taken_low_beside_the_arm_is_drawn_off_it_before_it_is_lifted(below, aside):
    arm = ArmPath.of(lying_posture("left"))
    across, axis = arm.frame(0.3)[:, 0], arm.point(0.3)
    low = axis + math.copysign(0.045, across @ outwards("left")) * across - below * UP
    run = bench(seams=SEAMS | {"left": low}, side="left")
    assert run.ended() is None
    way = run.way("left")[run.openings("left") < 0.005]
    risen = way[way[:, 2] > way[0, 2] + 0.01][0]
    assert abs((risen - axis) @ across) == pytest.approx(aside, abs=0.008)  # [m]


def test_a_sleeve_that_pulls_back_is_drawn_no_farther_and_the_other_one_is():
    inwards = -outwards("right")

    def taut(bench):
        here = bench.world.observe().pose_hand_in_map[1, :3, 3]
        pulls(bench.world, "right", -9.0 * inwards if (here - SEAMS["right"]) @ inwards > 0.04 else -0.5 * inwards)

    run = bench(each_tick=taut)
    assert run.ended() is None
    assert ((drawn(run, "right") - SEAMS["right"]) @ inwards).max() == pytest.approx(0.04, abs=0.02)  # [m]
    assert ((drawn(run, "left") - SEAMS["left"]) @ -outwards("left")).max() > 0.15  # [m]


def test_a_miss_ends_with_the_hand_open_and_drawn_back():
    run = bench(cloth=HIDDEN)
    assert run.ended() == Reason.GRASP_MISSED
    assert run.openings("left")[-1] > 0.08
    assert run.way("left")[-1, 2] > SEAMS["left"][2] + 0.05  # [m]
    assert run.context.memory.of(Drawn, Drawn).missed == {"left": 1, "right": 1}


@pytest.mark.parametrize(("missed", "footward"), [(0, 0.0), (1, 0.03), (2, 0.06), (3, 0.0)])
def test_a_seam_that_was_missed_is_taken_elsewhere(missed, footward):
    run = bench()
    run.context.memory.of(Drawn, Drawn).missed["left"] = missed
    assert run.ended() is None
    closed = run.way("left")[run.openings("left") < 0.005][0]
    assert (SEAMS["left"] - closed) @ HEADWARD == pytest.approx(footward, abs=0.01)
    assert run.context.memory.of(Drawn, Drawn).missed["left"] == 0


@pytest.mark.parametrize("missed", SIDES)
def test_where_one_is_missed_the_other_is_drawn_all_the_same(missed):
    other = "right" if missed == "left" else "left"

    def cloth(frame, pose_hand_in_map):
        near = np.linalg.norm(pose_hand_in_map[:3, 3] - SEAMS[missed]) < 0.2
        return Estimate(stamp=0.0, confidence=0.0 if near else 0.9)

    run = bench(cloth=cloth)
    assert run.ended() is None
    closed = run.way(other)[run.openings(other) < 0.005]
    assert (closed[-1] - SHOULDERS[other]) @ outwards(other) == pytest.approx(-0.07, abs=0.03)
    assert ((run.way(missed) - SHOULDERS[missed]) @ outwards(missed)).min() > 0.05, "that hand went nowhere else"
    assert run.openings(missed)[-1] > 0.08


@pytest.mark.parametrize("low", SIDES)
@pytest.mark.parametrize("seen", [0.4, None])
def test_a_sleeve_that_is_up_is_left_alone(low, seen):
    up = "right" if low == "left" else "left"
    run = bench(reach={low: seen, up: 0.95})
    assert run.ended() is None
    assert (last_held(run, low) - SHOULDERS[low]) @ outwards(low) == pytest.approx(-0.07, abs=0.03)
    assert np.ptp(run.way(up), axis=0) == pytest.approx(0.0, abs=0.02)  # [m]


@pytest.mark.parametrize(("seen", "drawn"), [((0.60, 0.90), 0.078), ((0.60, 0.3), 0.10)])  # [1], [m]
def test_a_left_one_is_drawn_all_the_way_if_the_right_one_is_drawn_after_it(seen, drawn):
    """Drawn less, it came to rest at 0.68, all the way at 0.73 (134)."""
    run = bench(reach=dict(zip(SIDES, seen, strict=True)))
    assert run.ended() is None
    left = last_held(run, "left") - SHOULDERS["left"]
    assert left @ HEADWARD == pytest.approx(drawn, abs=0.005)


@pytest.mark.parametrize(
    ("seen", "drawn"),
    [((0.66, 0.45), {"right"}), ((0.60, 0.45), {"left", "right"}), ((0.66, 0.70), {"left", "right"})],
)
def test_a_left_one_that_is_almost_up_waits_while_the_right_one_is_lower(seen, drawn):
    """Drawn up from 0.72, it took the right one along (106)."""
    run = bench(reach=dict(zip(SIDES, seen, strict=True)))
    assert run.ended() is None
    assert {side for side, times in run.context.memory.of(Drawn, Drawn).times.items() if times} == drawn


@pytest.mark.parametrize(("reach", "drawn"), [(0.60, 0.10), (0.695, 0.085), (0.78, 0.07)])  # [1], [m]
def test_the_right_one_is_drawn_the_less_the_higher_it_is(reach, drawn):
    run = bench(reach={"left": 0.5, "right": reach})
    assert run.ended() is None
    right = last_held(run, "right") - SHOULDERS["right"]
    assert right @ HEADWARD == pytest.approx(drawn, abs=0.005)


def test_one_that_was_drawn_before_is_drawn_all_the_way():
    ends = []
    for before in (0, 1, 2, 7):
        run = bench(reach={"left": 0.65, "right": 0.90})
        run.context.memory.of(Drawn, Drawn).times["left"] = before
        assert run.ended() is None
        ends.append((last_held(run, "left") - SHOULDERS["left"]) @ HEADWARD)
        assert run.context.memory.of(Drawn, Drawn).times == {"left": before + 1, "right": 0}
    assert ends == pytest.approx([0.07, 0.10, 0.10, 0.10], abs=0.01)  # [m]


@pytest.mark.parametrize(
    ("times", "before", "now", "drawn"),
    [(2, 0.71, 0.70, False), (2, 0.65, 0.70, True), (1, 0.71, 0.70, True), (4, 0.66, 0.66, True)],
)
def test_one_that_is_most_likely_up_and_that_no_draw_brings_higher_is_left(times, before, now, drawn):
    run = bench(reach={"left": now, "right": 0.95})
    memory = run.context.memory.of(Drawn, Drawn)
    memory.times["left"], memory.reach["left"] = times, before
    assert run.ended() is None
    assert memory.times["left"] == times + drawn
    moved = np.linalg.norm(np.ptp(run.way("left"), axis=0))
    assert moved > 0.2 if drawn else moved == pytest.approx(0.0, abs=1e-3)  # [m]


@pytest.mark.parametrize(
    ("closely", "drawn"),
    [((0.71, 0.75), {"left"}), ((0.75, 0.71), {"right"}), ((0.60, 0.60), {"left", "right"}), ((0.73, 0.73), set())],
)
def test_what_was_seen_closely_tells_which_are_drawn(closely, drawn):
    """Left for once by what the head's camera sees, the other one, which was up, was drawn instead (0)."""
    run = bench(reach=dict(zip(SIDES, closely[::-1], strict=True)), up=0.72)
    memory = run.context.memory.of(Drawn, Drawn)
    memory.times, memory.reach = dict.fromkeys(SIDES, 2), dict.fromkeys(SIDES, 0.75)
    for side, reach in zip(SIDES, closely, strict=True):
        CloseLook.of(run.skill).sleeves[side] = SleeveSeen(reach, 0.9, run.skill.now())
    assert run.ended() is None
    assert {side for side in SIDES if memory.times[side] > 2} == drawn


def test_where_both_are_up_no_hand_moves():
    run = bench(reach=dict.fromkeys(SIDES, 0.9))
    assert run.ended() is None
    assert all(np.ptp(run.way(side), axis=0) == pytest.approx(0.0, abs=1e-3) for side in SIDES)


@pytest.mark.parametrize("hidden", SIDES)
def test_where_one_seam_does_not_show_the_other_sleeve_is_drawn_all_the_same(hidden):
    other = "right" if hidden == "left" else "left"
    run = bench(hidden=(hidden,))
    assert run.ended() is None
    assert (last_held(run, other) - SHOULDERS[other]) @ outwards(other) == pytest.approx(-0.07, abs=0.03)
    assert np.ptp(run.way(hidden), axis=0) == pytest.approx(0.0, abs=0.02)  # [m]


def test_where_no_seam_shows_that_is_told_and_no_hand_moves():
    run = bench(hidden=SIDES)
    assert run.ended() == Reason.NOTHING_SEEN
    assert all(np.ptp(run.way(side), axis=0) == pytest.approx(0.0, abs=1e-3) for side in SIDES)


@pytest.mark.parametrize("before", [False, True])
def test_one_that_was_left_as_it_was_is_drawn_again_when_that_is_asked_for_once_more(before):
    run = bench(reach={"left": 0.70, "right": 0.95})
    memory = run.context.memory.of(Drawn, Drawn)
    memory.times["left"], memory.reach["left"], memory.left = 2, 0.71, {"left"} if before else set()
    assert run.ended() is None
    assert memory.times["left"] == (3 if before else 2)
    assert memory.left == (set() if before else {"left"})


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("seen", [0.3, 0.9])
def test_one_that_is_asked_for_is_drawn_alone_and_farther_however_high_it_is_seen(side, seen):
    other = "right" if side == "left" else "left"
    run = bench(reach=dict.fromkeys(SIDES, seen), side=side)
    assert run.ended() is None
    off = last_held(run, side) - SHOULDERS[side]
    assert off @ outwards(side) == pytest.approx(-0.10, abs=0.03)
    assert off @ HEADWARD == pytest.approx(0.10, abs=0.02)
    assert np.ptp(run.way(other), axis=0) == pytest.approx(0.0, abs=0.02)  # [m]


@pytest.mark.parametrize("seen", [(0.65, 0.76), (0.74, 0.78), (0.76, 0.65), (0.78, 0.74)])
def test_once_they_were_drawn_the_lower_one_is_drawn_alone_and_farther(seen):
    lower, other = SIDES if seen[0] < seen[1] else SIDES[::-1]
    run = bench(reach=dict(zip(SIDES, seen, strict=True)))
    run.context.memory.of(Drawn, Drawn).times.update(dict.fromkeys(SIDES, 1))
    assert run.ended() is None
    off = last_held(run, lower) - SHOULDERS[lower]
    assert off @ outwards(lower) == pytest.approx(-0.10, abs=0.03)
    assert off @ HEADWARD == pytest.approx(0.10, abs=0.02)
    assert np.ptp(run.way(other), axis=0) == pytest.approx(0.0, abs=0.02)  # [m]


def test_both_are_drawn_again_where_both_came_down():
    run = bench(reach=dict.fromkeys(SIDES, 0.65))
    run.context.memory.of(Drawn, Drawn).times.update(dict.fromkeys(SIDES, 1))
    assert run.ended() is None
    assert all(np.ptp(run.way(side), axis=0).max() > 0.2 for side in SIDES)


@pytest.mark.parametrize(("ago", "taken"), [(60.0, ["left"]), (130.0, ["left", "right"]), (None, ["left", "right"])])
def test_a_sleeve_that_does_not_show_is_where_it_was_seen_a_little_before(ago, taken):
    run = bench(reach={"left": 0.5, "right": None})
    if ago is not None:
        seen = SleeveSeen(0.95, 0.33, run.context.world.clock.now() - ago)
        run.context.memory.of(CloseLook, CloseLook).before["right"] = seen
    assert run.ended() is None
    assert [side for side in SIDES if len(drawn(run, side))] == taken
    known = run.context.memory.of(CloseLook, CloseLook).before
    assert ("right" in known) == (taken == ["left"]), "once it is drawn, it is elsewhere"
