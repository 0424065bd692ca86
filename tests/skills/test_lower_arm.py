"""An arm that is up and that nobody holds is taken from above, swung down and let go; one that lies is left alone."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.estimates import ArmPosture
from caretree.perception.image.cloud import unit
from caretree.perception.person.arm_fit import turned_about_shoulder
from caretree.sim.world import HandTwist
from caretree.skills.core.reasons import Reason
from caretree.skills.geometry.arm_path import ArmPath
from caretree.skills.lower_arm import LowerArm
from caretree.skills.scripted.scripted_person import lying_posture

from .bench import ARM, LeafBench, beside_bed, goes_along, pulls

LIES = lying_posture("right")
SHOULDER = LIES.points_in_map[0]
UP = turned_about_shoulder(LIES.points_in_map, 1.0, LIES.points_in_map[1] + (0.0, 0.0, 0.17))
RAISED = replace(LIES, points_in_map=UP)
MATTRESS = 0.60  # [m] above the floor


def bench(*, arm=RAISED, then=LIES, between=ARM, load=(0.0, 0.0, -6.0), stand=None, deaf_to=(), **options):
    """The left hand is to lower the right arm, seen as `arm`, and as `then` once it was let go of."""

    def pulls_while_held(bench):
        held = bench.context.guard.grip("left") == "arm"
        pulls(bench.world, "left", load if held else np.zeros(3))
        bench.world.deaf_to = deaf_to if held else ()

    sight = goes_along(arm, then) if isinstance(arm, ArmPosture) else arm
    run = LeafBench(
        lambda context: LowerArm("lower", context, side="right", hand="left", **options),
        beside_bed(stand=stand, arm=sight, relocalised_arm=then),
        each_tick=pulls_while_held,
    )
    run.world.between_fingers["left"] = between
    return run


def taken(run):
    """Positions (n, 3) of the hand while it holds the arm [m]."""
    shut = np.flatnonzero(run.openings("left") < ARM + 0.005)
    assert len(shut), "the fingers never close"
    return run.way("left")[shut[0] : shut[-1]]


def test_it_is_taken_by_the_forearm_from_above_and_swung_down_about_the_shoulder():
    run = bench()
    assert run.ended() is None
    way, place = taken(run), ArmPath(UP).point(1.25)
    assert way[0] == pytest.approx(place, abs=0.02)
    closed = int(np.flatnonzero(run.openings("left") < ARM + 0.005)[0])
    before, pointing = run.way("left")[:closed] - place, run.poses("left")[closed, :3, 2]
    beside = np.linalg.norm(before - np.outer(before @ pointing, pointing), axis=1)
    assert np.ptp((before @ pointing)[beside < 0.03]) > 0.10, "straight at the arm [m]"
    assert pointing[2] < -0.7, "from above"
    assert np.linalg.norm(way - SHOULDER, axis=1) == pytest.approx(np.linalg.norm(way[0] - SHOULDER), abs=0.015)
    assert way[-1, 2] - MATTRESS == pytest.approx(0.06, abs=0.03)
    assert np.linalg.norm(np.diff(way, axis=0), axis=1).max() < 0.05 / 15  # [m] a tick


def test_it_lets_go_only_where_the_arm_lies_and_goes_away():
    run = bench(ready="never")
    assert run.ended() is None
    assert run.openings("left")[-1] > 0.08
    assert run.way("left")[-1, 2] - taken(run)[-1, 2] == pytest.approx(0.16, abs=0.03)
    assert run.context.guard.grip("left") == "nothing"


def test_one_that_is_held_aside_is_not_pressed_against_what_holds_it():
    high = turned_about_shoulder(LIES.points_in_map, 1.0, LIES.points_in_map[1] + (0.0, 0.0, 0.28))
    raised = replace(LIES, points_in_map=high)
    outwards = np.append(unit((ArmPath(high).point(1.25) - SHOULDER)[:2]), 0.0)
    free, aside = bench(arm=raised), bench(arm=raised, load=-14.0 * outwards - (0.0, 0.0, 6.0))
    assert free.ended() is None
    assert ((taken(free) - taken(free)[0]) @ outwards).max() > 0.06  # [m]
    assert aside.ended() is None
    way = taken(aside) - taken(aside)[0]
    assert (way @ outwards).max() < 0.005  # [m]
    assert way[-1, 2] < -0.05  # [m]


def test_one_that_lies_is_left_alone():
    run = bench(arm=LIES)
    assert run.ended() is None
    assert run.sent == 0


def test_one_that_does_not_show_is_told_and_no_hand_moves():
    run = bench(arm=PerceptionFailure(Problem.ARM_LOST, "right arm"))
    assert run.ended() == Reason.ARM_LOST
    assert run.sent == 0


def test_one_out_of_reach_is_told_and_no_hand_moves():
    run = bench(stand=(2.2, -0.4, np.pi))
    assert run.ended() == Reason.UNREACHABLE
    assert run.way("left")[-1] == pytest.approx(run.start.pose_hand_in_map[0, :3, 3], abs=0.005)


def test_it_is_taken_at_the_elbow_where_the_forearm_is_out_of_reach():
    run = bench(stand=(1.05, -0.63, np.pi))
    assert run.ended() is None
    assert taken(run)[0] == pytest.approx(UP[1], abs=0.02)


def test_fingers_that_close_on_nothing_open_again_above_the_arm():
    run = bench(between=0.0)
    assert run.ended() == Reason.GRASP_MISSED
    assert run.openings("left")[-1] > 0.08
    above = ArmPath(UP).point(1.25) - 0.12 * run.poses("left")[-1, :3, 2]
    assert run.way("left")[-1] == pytest.approx(above, abs=0.03)


def test_one_that_does_not_come_down_is_let_go_of_where_it_stayed_up_before():
    run = bench(deaf_to=(HandTwist,))
    assert run.ended() == Reason.MOTION_BLOCKED
    assert run.openings("left")[-1] > 0.08
    assert run.context.guard.grip("left") == "nothing"


def test_one_that_is_still_up_in_the_end_is_told():
    assert bench(then=RAISED).ended() == Reason.ARM_SLIPPED
