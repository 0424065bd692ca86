"""A sleeve is pulled up the arm as long as it slides, and what is told when it does not."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.estimates import Cover
from caretree.sim.world import HandTwist
from caretree.skills.belief.armhole_watch import ARMHOLE_WATCH
from caretree.skills.belief.pulled_sleeves import pull_loads
from caretree.skills.core.reasons import Reason
from caretree.skills.geometry.hold import Hold
from caretree.skills.geometry.stances import outwards
from caretree.skills.pull_along_arm import PullAlongArm
from caretree.skills.scripted.scripted_person import laid_strap, lying_posture

from .bench import ARM, CLOTH, GRIP, PATH, LeafBench, above_arm, beside_bed, on_arm, pulls

SLIDES = 2.0  # [N] with which a sleeve that slides pulls towards the fingertips
SPEED = 0.08  # [m/s] of the grip when nothing holds it back
GOAL = 1.45  # arm coordinate: the middle of the forearm
HIDDEN = PerceptionFailure(Problem.NOTHING_SEEN, "armhole")


def bench(
    load=SLIDES, *, begin=2.9, goal=GOAL, hold=None, deaf_to=(), cover=1.0, cuff=1.0, armhole=HIDDEN, each_tick=None
):
    """A hand that holds the sleeve above the arm, at `begin`, where it pulls back with `load` [N]."""
    lies = lying_posture("right")
    hands, held = {"right": above_arm(begin)}, {"right": CLOTH}
    if hold is not None:
        hands[hold.hand], held[hold.hand] = on_arm(hold.coordinate), ARM
    return LeafBench(
        lambda context: PullAlongArm("pull", context, grip=GRIP, grip_goal=goal, hold=hold),
        beside_bed(
            hands=hands,
            held=held,
            load={"right": load * PATH.direction(begin)},
            deaf_to=deaf_to,
            arm=lies,
            relocalised_arm=lies,
            held_armhole=armhole,
            skin_cover=Cover(stamp=0.0, confidence=0.9, share=cover),
            sleeve_on_forearm=HIDDEN,
            cuff_round=cuff if callable(cuff) else Cover(stamp=0.0, confidence=0.9, share=cuff),
        ),
        each_tick=each_tick or (lambda bench: None),
    )


def coordinates(run):
    """Arm coordinates (n,) of the hand over time: 3 fingertip, 2 wrist, 1 elbow, 0 shoulder."""
    return np.array([PATH.coordinate_of(position) for position in run.way("right")])


def speed(run):
    """Mean speed of the hand towards the shoulder after the first second [m/s]."""
    way = coordinates(run)
    return PATH.distance(way[15], way[-1]) * np.sign(way[15] - way[-1]) / (run.seen[-1].time - run.seen[15].time)


def test_a_sleeve_that_slides_is_brought_to_the_goal_above_the_arm():
    run = bench()
    assert run.ended() is None
    way = coordinates(run)
    assert way[0] > 2.8
    assert way[-1] == pytest.approx(GOAL, abs=0.05)
    assert np.all(np.diff(way) <= 0.0), "it never goes back"
    height = run.way("right")[15:, 2] - [PATH.point(coordinate)[2] for coordinate in way[15:]]
    assert height == pytest.approx(0.09, abs=0.02)  # [m] above the arm's axis
    assert speed(run) == pytest.approx(SPEED, rel=0.15)
    assert run.world.observe().gripper_opening[1] < 0.01, "it still holds the sleeve"


def test_it_slows_down_under_load_and_gives_way_under_more():
    slow = bench(load=7.25)  # [N] half way between full speed and none
    slow.run(40)
    assert 0.25 * SPEED < speed(slow) < 0.6 * SPEED
    yields = bench(load=9.5)  # [N] beyond which it only gives way
    yields.run(20)
    assert speed(yields) < -0.01  # [m/s]


def test_a_sleeve_that_pulls_hard_by_the_shoulder_is_on_as_far_as_it_goes():
    hard = bench(load=6.5, begin=0.6, goal=-0.5)  # [N]
    assert hard.ended() is None
    assert coordinates(hard)[-1] == pytest.approx(0.3, abs=0.05)
    assert pull_loads(hard.context) == {"right": pytest.approx(6.5, abs=0.5)}
    slides = bench(load=SLIDES, begin=0.6, goal=-0.5)
    assert slides.ended() is None
    assert coordinates(slides)[-1] < 0.0
    assert pull_loads(slides.context) == {"right": pytest.approx(SLIDES, abs=0.5)}
    on_the_forearm = bench(load=SLIDES)
    assert on_the_forearm.ended() is None
    assert pull_loads(on_the_forearm.context) == {}, "it did not come to the shoulder"


@pytest.mark.parametrize(("load", "reason"), [(6.0, Reason.SLEEVE_CAUGHT), (4.0, Reason.MOTION_BLOCKED)])
def test_a_hand_that_stands_is_held_by_the_sleeve_or_by_something_else(load, reason):
    run = bench(load=load, deaf_to=(HandTwist,))
    assert run.ended() == reason
    assert 1.4 < run.seen[-1].time - run.seen[0].time < 4.0  # [s], 1 s of which the head takes to look at the arm


def test_a_sleeve_that_pulls_no_more_has_slipped_out_of_the_fingers():
    def slips(bench):
        if len(bench.seen) == 30:
            pulls(bench.world, "right", np.zeros(3))

    run = bench(each_tick=slips)
    assert run.ended() == Reason.CLOTH_SLIPPED
    assert coordinates(run)[-1] > GOAL + 0.1, "it does not go on to the goal"


@pytest.mark.parametrize(
    ("seen", "near"), [({"cover": 0.2}, 2.5), ({"cuff": 0.25}, GOAL)], ids=("bare hand", "arm beside the cuff")
)
def test_a_sleeve_that_goes_beside_the_hand_or_the_arm_is_missed_and_drawn_back_off_it(seen, near):
    run = bench(**seen)
    assert run.ended() == Reason.SLEEVE_MISSED
    assert np.min(coordinates(run)) == pytest.approx(near, abs=0.1)
    assert PATH.distance(3.0, coordinates(run)[-1]) == pytest.approx(0.16, abs=0.02)  # [m] beyond the fingertips


@pytest.mark.parametrize(("aside", "back"), [(0.10, 0.13), (0.035, 0.06)])
def test_an_armhole_far_aside_is_centred_clear_of_the_fingertips(aside, back):
    begin = PATH.moved(3.0, 0.06)

    def seen(frame, side, near_in_map):
        """The outer edge of a hoop that hangs `aside` [m] inwards of where it belongs, and goes as the strap does."""
        edge = near_in_map + (ARMHOLE_WATCH.edge_offset - aside) * outwards(side)
        return replace(laid_strap(side), armhole_points_in_map=edge[None])

    run = bench(begin=begin, armhole=seen)
    assert run.ended() is None
    way = coordinates(run)
    assert PATH.distance(3.0, np.max(way)) == pytest.approx(back, abs=0.02)  # [m] beyond the fingertips
    centred = (run.way("right")[-1] - PATH.point(way[-1])) @ PATH.frame(way[-1])[:, 0]
    assert abs(centred) == pytest.approx(aside, abs=0.02)  # [m]


def test_a_cuff_that_swings_round_the_arm_once_the_hand_stands_is_not_missed():
    looks = []

    def settles(frame, points_in_map):
        looks.append(frame.stamp)
        return Cover(stamp=frame.stamp, confidence=0.9, share=0.25 if len(looks) == 1 else 0.8)

    run = bench(cuff=settles)
    assert run.ended() is None
    assert len(looks) == 2
    assert 0.5 < looks[1] - looks[0] < 1.5  # [s]
    still = run.way("right")[np.array([seen.time for seen in run.seen]) > looks[0] + 0.3]
    assert np.ptp(still, axis=0) == pytest.approx(0.0, abs=0.01), "the hand waits [m]"


def test_it_ends_when_the_other_hand_loses_the_arm():
    def lets_go(bench):
        if len(bench.seen) == 15:
            bench.world.between_fingers["left"] = 0.0

    run = bench(hold=Hold("left", 1.0), each_tick=lets_go)
    assert run.ended() == Reason.ARM_SLIPPED
    assert coordinates(run)[-1] > GOAL + 0.1


def test_past_the_shoulder_a_pull_that_stands_has_the_sleeve_on():
    def stands(bench):
        if PATH.coordinate_of(bench.world.observe().pose_hand_in_map[1, :3, 3]) < -0.2:
            bench.world.deaf_to = (HandTwist,)

    run = bench(load=0.5, begin=0.3, goal=-0.6, each_tick=stands)
    assert run.ended() is None
    assert -0.4 < coordinates(run)[-1] < -0.2


def test_a_hand_that_is_held_up_just_before_its_goal_has_arrived():
    def stands(bench):
        if PATH.coordinate_of(bench.world.observe().pose_hand_in_map[1, :3, 3]) < GOAL + 0.15:
            bench.world.deaf_to = (HandTwist,)

    run = bench(each_tick=stands)
    assert run.ended() is None
    assert GOAL + 0.05 < coordinates(run)[-1] < GOAL + 0.15
