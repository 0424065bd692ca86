"""All cameras look at the collar, the hands' low from the head of the bed."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.estimates import GraspPoint
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.world import SIDES
from caretree.skills.belief.close_look import CloseLook, close_look
from caretree.skills.geometry.stances import stance_at_head
from caretree.skills.scripted.scripted_person import lying_posture
from caretree.trees.tasks.dressing.look_at_collar import LookAtCollar

from ....skills.bench import LeafBench, beside_bed

PLACES = {"left_hand": (0.02, 0.9), "right_hand": (0.06, 0.7)}  # x of the collar [m] and how much of it shows


def bench(places, looks=None):
    """A bench on which each camera sees the collar where `places` says, or not at all."""

    def seen(frame, near_in_map, away):
        if looks is not None:
            looks.append((frame.camera, run.world.observe().arm_positions))
        if frame.camera not in places:
            raise PerceptionFailure(Problem.NOTHING_SEEN, "neck binding")
        x, shown = places[frame.camera]
        return GraspPoint(
            stamp=frame.stamp,
            confidence=shown,
            target="collar_middle",
            position_in_map=np.array((x, -0.5, 0.8)),
            approach_in_map=np.array((0.0, 0.0, -1.0)),
            closing_in_map=np.array((0.0, 1.0, 0.0)),
        )

    arm = {"arm": lambda frame, side, **_: lying_posture(side)}
    run = LeafBench(
        lambda context: LookAtCollar("look", context), beside_bed(stand=stance_at_head(), collar_middle=seen, **arm)
    )
    return run


def eye(camera, arms):
    """Where a camera was from the middle between the shoulders (3,) with such arms [m]."""
    middle = np.mean([lying_posture(side).points_in_map[0] for side in SIDES], axis=0)
    return kinematics_of(BAXTER).pose_camera_in_map(camera, stance_at_head(), arms, 0.0)[:3, 3] - middle


def test_what_both_hands_see_from_low_on_either_side_of_the_head_is_known():
    looks = []
    run = bench(PLACES, looks)
    assert run.ended(seconds=60.0) is None
    known = close_look(run.skill)
    assert known is not None
    assert 0.02 < known.position_in_map[0] < 0.04, "nearer to where more of it shows"
    assert 0.8 < known.confidence < 0.9
    assert [camera for camera, _ in looks] == ["head", "left_hand", "right_hand"]
    for (camera, hands), side in zip(looks[1:], (-1.0, 1.0), strict=True):
        x, y, z = eye(camera, hands)
        assert 0.3 < side * x < 0.6
        assert -0.6 < y < -0.3, "headward"
        assert 0.15 < z < 0.45
    assert run.world.observe().arm_positions == pytest.approx(run.world.robot.ready, abs=0.02)


def test_the_head_s_camera_counts_as_much_as_it_shows():
    without, little, much = (bench(PLACES | head) for head in ({}, {"head": (0.03, 0.3)}, {"head": (0.03, 1.0)}))
    for run in (without, little, much):
        assert run.ended(seconds=60.0) is None
    x = [close_look(run.skill).position_in_map[0] for run in (without, little, much)]
    assert x[1] == pytest.approx(x[0], abs=0.001)
    assert abs(x[2] - 0.03) < 0.7 * abs(x[0] - 0.03)


@pytest.mark.parametrize(("x", "tells"), [(0.06, 0.8), (0.11, 0.6), (-0.07, 0.6)])
def test_what_the_pictures_show_far_apart_tells_less(x, tells):
    run = bench({"left_hand": (0.02, 0.8), "right_hand": (x, 0.8)})
    assert run.ended(seconds=60.0) is None
    assert close_look(run.skill).confidence == pytest.approx(tells)


@pytest.mark.parametrize("x", [0.025, 0.06])
def test_three_pictures_of_which_one_is_far_off_tell_where_the_others_agree(x):
    run = bench({"left_hand": (0.02, 1.0), "head": (0.025, 1.0), "right_hand": (x, 0.5)})
    assert run.ended(seconds=60.0) is None
    assert close_look(run.skill).position_in_map[0] == pytest.approx(0.0235, abs=0.002)
    assert close_look(run.skill).confidence > 0.9


@pytest.mark.parametrize("places", [{}, {"right_hand": PLACES["right_hand"]}])
def test_where_not_both_hands_see_it_nothing_is_known_closely(places):
    run = bench(places)
    assert run.ended(seconds=60.0) is None
    assert close_look(run.skill) is None


def test_what_was_just_looked_at_is_not_looked_at_again():
    looks = []
    run = bench(PLACES, looks)
    assert run.ended(seconds=60.0) is None
    known = close_look(run.skill)
    run.skill.initialise()
    again = bench(PLACES, looks)
    CloseLook.of(again.skill).seen = known
    before = len(looks)
    assert again.ended(seconds=1.0) is None
    assert len(looks) == before
