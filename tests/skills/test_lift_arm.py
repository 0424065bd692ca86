"""An arm is taken from above and swung up and outwards about its shoulder, as long as it is held and not too heavy."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.skills.belief.short_gown import short_gown
from caretree.skills.core.reasons import Reason
from caretree.skills.geometry.hold import Hold
from caretree.skills.geometry.stances import HEADWARD, outwards
from caretree.skills.lift_arm import LiftArm, LiftArmTuning, LiftGoal, lifted
from caretree.skills.scripted.scripted_person import lying_posture

from .bench import ARM, LeafBench, beside_bed, pulls

LIES = lying_posture("right")
SHOULDER, ELBOW = LIES.points_in_map[:2]


def bench(*, weight=2.0, aside=0.0, between=ARM, arm=LIES, each_tick=lambda bench: None, **ports):
    """The left hand is to lift the right arm; held, that pulls with `weight` down and `aside` to the body [N]."""

    def hangs(bench):
        held = bench.context.guard.grip("left") == "arm"
        pulls(bench.world, "left", (-aside, 0.0, -weight) if held else np.zeros(3))
        each_tick(bench)

    run = LeafBench(
        lambda context: LiftArm("lift", context, side="right", hand="left", **ports),
        beside_bed(arm=arm, relocalised_arm=arm),
        each_tick=hangs,
    )
    run.world.between_fingers["left"] = between
    return run


def swing(run):
    """Positions (n, 3) of the hand from the shoulder, once it holds the arm [m]."""
    shut = int(np.argmax(run.openings("left") < ARM + 0.005))
    assert shut > 0, "the fingers never close"
    return run.way("left")[shut:] - SHOULDER


def test_it_is_taken_at_the_elbow_from_above_and_swung_about_the_shoulder():
    run = bench()
    assert run.ended() is None
    way = swing(run)
    assert way[0] == pytest.approx(ELBOW - SHOULDER, abs=0.02)
    before = run.way("left")[: -len(way)]
    near = np.linalg.norm(before[:, :2] - ELBOW[:2], axis=1) < 0.03
    assert np.ptp(before[near][:, 2]) > 0.10, "straight down from above [m]"
    radius = np.linalg.norm(way, axis=1)
    assert radius == pytest.approx(radius[0], abs=0.03)  # [m]
    elevation = np.arcsin(way[:, 2] / radius)
    assert elevation[-1] - elevation[0] == pytest.approx(np.deg2rad(38.0), abs=0.10)
    assert np.arctan2(way[-1, 0], way[-1, 1]) == pytest.approx(0.81, abs=0.03), "as it lay [rad]"
    assert run.skill.hold == Hold("left", 1.0)
    assert run.context.guard.grip("left") == "arm"
    assert run.openings("left")[-1] == pytest.approx(ARM, abs=0.003)


@pytest.mark.parametrize(("short", "spread"), [(False, 0.60), (True, 0.51)])
def test_an_arm_beside_the_body_is_spread_unless_the_gown_does_not_reach_so_far(short, spread):
    turn = np.array(((np.cos(0.3), -np.sin(0.3), 0.0), (np.sin(0.3), np.cos(0.3), 0.0), (0.0, 0.0, 1.0)))  # 0.3 rad
    run = bench(arm=replace(LIES, points_in_map=SHOULDER + (LIES.points_in_map - SHOULDER) @ turn.T))
    if short:
        short_gown(run.skill).add("right")
    assert run.ended() is None
    way = swing(run)
    assert np.arctan2(way[0, 0], way[0, 1]) == pytest.approx(0.51, abs=0.05)  # [rad]
    assert np.arctan2(way[-1, 0], way[-1, 1]) == pytest.approx(spread, abs=0.05)  # [rad]


def test_a_forearm_is_taken_where_it_lies_by_then_and_a_bent_arm_straightened():
    forearm = np.linalg.norm(LIES.points_in_map[2] - ELBOW)
    bent = LIES.points_in_map.copy()
    bent[2:] += ELBOW + forearm * np.array((-0.6, 0.8, 0.0)) - bent[2]  # inwards from the elbow on
    slid = bent + np.array((0.0, 0.03, 0.0)) * np.array((0, 1, 1, 1))[:, None]

    def slides(frame, side, **_):  # while the hand comes
        return replace(LIES, points_in_map=slid if frame.stamp > 1.0 else bent)

    tuning = LiftArmTuning(goal=LiftGoal(grip_coordinate=1.7, pitch=np.deg2rad(5.0)))
    run = bench(arm=slides, tuning=tuning)
    assert run.ended() is None
    way = swing(run)
    assert way[0] == pytest.approx(slid[1] + 0.7 * (slid[2] - slid[1]) - SHOULDER, abs=0.015)
    length, reach = np.linalg.norm(slid[1] - SHOULDER) + 0.7 * forearm, np.linalg.norm(way, axis=1)
    assert reach[0] < 0.95 * length
    assert reach[-1] == pytest.approx(0.99 * length, abs=0.01)


def test_an_arm_whose_elbow_is_bent_is_taken_above_it():
    bent = LIES.points_in_map.copy()
    forearm = np.linalg.norm(bent[2] - bent[1])
    bent[2:] += ELBOW + forearm * np.array((-0.8, 0.6, 0.0)) - bent[2]
    run = bench(arm=lambda frame, side, **_: replace(LIES, points_in_map=bent))
    assert run.ended() is None
    assert run.skill.hold == Hold("left", LiftGoal().bent_grip)
    away = np.linalg.norm(swing(run)[0] - (ELBOW - SHOULDER))
    assert away == pytest.approx(0.18 * np.linalg.norm(ELBOW - SHOULDER), abs=0.02)


def test_it_takes_its_time():
    run = bench()
    assert run.ended() is None
    steps = np.linalg.norm(np.diff(swing(run), axis=0), axis=1)
    assert (steps > 2e-4).sum() / 15 > 6.0  # [s]
    assert steps.max() < 0.04 / 15  # [m] a tick
    assert steps[steps > 2e-4][:5].mean() < 0.6 * steps.max(), "it begins gently"


def test_it_gives_way_to_an_arm_that_turns_about_another_point():
    run = bench(aside=18.0)
    assert run.ended() is None
    straight = bench()
    assert straight.ended() is None
    given = swing(straight)[-1] - swing(run)[-1]
    assert 0.04 < np.linalg.norm(given) < 0.12  # [m]
    assert given[0] > 0.03, "towards the body"


def test_fingers_that_close_on_nothing_open_again_above_the_arm():
    run = bench(between=0.0)
    assert run.ended() == Reason.GRASP_MISSED
    assert run.openings("left").min() < 0.045
    assert run.openings("left")[-1] > 0.08
    assert run.way("left")[-1] == pytest.approx(ELBOW + (0.0, 0.0, 0.12), abs=0.03)
    assert run.context.guard.grip("left") == "nothing"


def test_an_arm_that_slips_out_is_told():
    def slips(bench):
        if (
            bench.world.observe().pose_hand_in_map[0, 2, 3] > ELBOW[2] + 0.06
            and "lifts" in bench.skill.feedback_message
        ):
            bench.world.between_fingers["left"] = 0.0

    run = bench(each_tick=slips)
    assert run.ended() == Reason.ARM_SLIPPED
    assert run.way("left")[-1, 2] < ELBOW[2] + 0.10


def test_one_that_is_too_heavy_is_not_torn_up():
    run = bench(weight=29.8)
    assert run.ended() == Reason.TIMEOUT
    assert np.ptp(swing(run)[:, 2]) < 0.02  # [m]
    assert run.openings("left")[-1] == pytest.approx(ARM, abs=0.003), "the arm is still held"


def test_one_that_does_not_show_is_told_and_no_hand_moves():
    run = bench(arm=PerceptionFailure(Problem.ARM_LOST, "right arm"))
    assert run.ended() == Reason.ARM_LOST
    assert run.way("left")[-1] == pytest.approx(run.start.pose_hand_in_map[0, :3, 3], abs=0.005)


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("spread", [0.85, 0.0])
def test_it_is_raised_and_spread_and_never_drawn_in(side, spread):
    posture = lying_posture(side)
    first = posture.points_in_map[1] - posture.points_in_map[0]
    now = np.arctan2(first @ outwards(side), first @ -HEADWARD)
    way = lifted(posture, side, LiftGoal(grip_coordinate=1.0, pitch=np.deg2rad(35.0), spread=spread))
    assert np.linalg.norm(way) == pytest.approx(1.0)
    assert np.arctan2(way @ outwards(side), way @ -HEADWARD) == pytest.approx(max(now, spread))
    assert way[2] > first[2] / np.linalg.norm(first) + 0.3


def test_an_arm_that_is_up_stays_as_high():
    posture = lying_posture("right")
    raised = posture.points_in_map[0] + np.outer(np.linspace(0.0, 0.7, 4), (0.3, 0.4, 0.75**0.5))
    way = lifted(
        replace(posture, points_in_map=raised),
        "right",
        LiftGoal(grip_coordinate=1.0, pitch=np.deg2rad(35.0), spread=0.85),
    )
    assert way[2] == pytest.approx(0.75**0.5)
