"""A corner of the hung gown's neckline is pinched where it hangs, and let alone where that goes wrong."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.sim.robot.baxter import BAXTER
from caretree.skills.control.hand_view import camera_in_hand
from caretree.skills.core.reasons import Reason
from caretree.skills.take_corner import TakeCorner

from .hung_gown import DOWN, LEFT, at, bench_with, ended, seen_at

HOOK = seen_at(at(0.75, 0.0, 1.50))
CORNER = at(0.75, -0.16, 1.20)  # of the wearer's left, in front of the robot's right hand
RIGHT = 1


def shown(place=CORNER, confidence=0.9):
    return lambda frame, **details: seen_at(
        place(frame.stamp) if callable(place) else place, "collar_corner_left", confidence=confidence
    )


def bench(shows, *, tug=0.5, hook=HOOK, **ports):
    """The right hand takes the corner; what it has closed on pulls with `tug` [N]."""

    def make(context):
        return TakeCorner("take", context, hand="right", sleeve="left", hook=hook, **ports)

    made = bench_with(make, hung_corner=shows)
    made.world.pull = lambda side, hand: tug * DOWN if side in made.world.closed else np.zeros(3)
    return made


def test_closes_around_the_corner_and_tells_the_length_of_the_strip():
    run = bench(shown())
    assert ended(run) is None
    place, _ = run.world.closed["right"]
    assert np.linalg.norm(place - CORNER) < 0.015  # [m]
    assert run.world.observe().gripper_opening[RIGHT] == pytest.approx(0.0, abs=0.001)
    assert run.skill.length == pytest.approx(0.34, abs=0.001)  # 0.16 m aside, 0.30 m down


def test_closes_where_a_swaying_corner_will_be():
    sway = 0.008 * DOWN  # [m/s]
    run = bench(shown(lambda time: CORNER + time * sway))
    assert ended(run) is None
    place, time = run.world.closed["right"]
    assert (place - (CORNER + time * sway)) @ DOWN == pytest.approx(0.0, abs=0.005)  # [m]


def test_an_error_of_the_second_look_is_not_followed_far():
    run = bench(shown(lambda time: CORNER + (0.03 if time > 0.5 else 0.0) * DOWN))
    assert ended(run) is None
    place, _ = run.world.closed["right"]
    assert 0.03 < (place - CORNER) @ DOWN < 0.055  # [m]: two centimetres beyond the last look at most


def test_fingers_that_close_on_nothing_open_and_draw_back():
    run = bench(shown(), tug=0.0)
    assert ended(run) == Reason.GRASP_MISSED
    seen = run.world.observe()
    assert seen.gripper_opening[RIGHT] > 0.08  # [m]
    assert np.linalg.norm(seen.pose_hand_in_map[RIGHT, :3, 3] - CORNER) > 0.10  # [m]


def test_a_missed_corner_that_drifts_behind_the_hand_is_met_where_it_has_got_to():
    drift = 0.008 * LEFT  # [m/s]
    run = None

    def hidden_by_the_hand(frame, **details):
        now = CORNER + frame.stamp * drift
        if run is not None and np.linalg.norm(run.world.observe().pose_hand_in_map[RIGHT, :3, 3] - now) < 0.3:
            raise PerceptionFailure(Problem.NOTHING_SEEN, "a corner")
        return seen_at(now, "collar_corner_left", confidence=0.9)

    def pull(side, hand):
        place, time = run.world.closed.get(side, (np.full(3, 9.0), 0.0))
        return (0.5 if abs((place - CORNER - time * drift) @ LEFT) < 0.012 else 0.0) * DOWN

    run = bench(hidden_by_the_hand, opening=0.03)
    run.world.pull = pull
    assert ended(run) is None
    _, time = run.world.closed["right"]
    assert time > 5.0  # [s]: not at the first try


def test_a_strip_that_is_edge_on_to_the_head_is_taken_where_the_free_hand_sees_it_from_beside():
    looked, corner = [], at(1.0, -0.16, 1.20)

    def from_beside_only(frame, **details):
        looked.append((frame.camera, run.world.observe().pose_hand_in_map[RIGHT] @ camera_in_hand(BAXTER, "right")))
        return seen_at(corner, "collar_corner_left", confidence=0.9 if frame.camera == "right_hand" else 0.4)

    run = bench(from_beside_only, hook=seen_at(at(1.0, 0.0, 1.50)), beside=True, min_confidence=0.8)
    assert ended(run) is None
    assert np.linalg.norm(run.world.closed["right"][0] - corner) < 0.03  # [m]
    assert {camera for camera, _ in looked} == {"right_hand"}
    view = looked[0][1][:3, 2]
    assert view @ LEFT > 0.3, "from the right hand's own side"
    assert abs(view @ DOWN) < 0.05, "level"


def test_a_corner_that_is_hardly_seen_is_not_gone_for():
    run = bench(shown(confidence=0.3), min_confidence=0.45)
    assert ended(run) == Reason.NOTHING_SEEN
    assert run.sent == 0


def test_does_not_close_where_other_cloth_has_come_beside_the_corner():
    found = seen_at(CORNER, "collar_corner_left", confidence=0.8)
    run = bench(shown(confidence=0.3), corner=found)
    assert ended(run) == Reason.MULTI_LAYER
    assert not run.world.closed
    assert run.world.observe().gripper_opening[RIGHT] > 0.08  # [m]


def test_goes_for_the_place_where_the_corner_was_found_when_it_no_longer_shows():
    found = seen_at(CORNER, "collar_corner_left", confidence=0.8)
    run = bench(PerceptionFailure(Problem.NOTHING_SEEN, "a corner"), corner=found)
    assert ended(run) is None
    assert np.linalg.norm(run.world.closed["right"][0] - CORNER) < 0.015  # [m]


def test_a_corner_out_of_reach_is_left_alone():
    run = bench(shown(at(2.5, -0.16, 1.20)))
    assert ended(run) == Reason.UNREACHABLE
    assert not run.world.closed
