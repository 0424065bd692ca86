"""A sleeve is taken by its strap, where the hand's own camera sees that; a miss leaves the hand open and clear."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.estimates import Estimate
from caretree.skills.belief.refused_stands import refused_stands
from caretree.skills.belief.sleeve_search import SleeveMemory
from caretree.skills.core.reasons import Reason
from caretree.skills.geometry.hold import Hold
from caretree.skills.grasp_sleeve import GraspSleeve
from caretree.skills.scripted.scripted_person import laid_strap, lying_posture

from .bench import ARM, LeafBench, beside_bed, on_arm

STRAP = laid_strap("right")  # beyond the fingertips of the right arm, the armhole towards the feet
HIDDEN = PerceptionFailure(Problem.NOTHING_SEEN, "sleeve")
CLOTH_SEEN = Estimate(stamp=0.0, confidence=0.9)


def moved(*offset, confidence=0.9):
    """The strap somewhere else, by an offset (3,) [m]."""
    there = np.array(offset)
    return replace(
        STRAP,
        confidence=confidence,
        position_in_map=STRAP.position_in_map + there,
        armhole_points_in_map=STRAP.armhole_points_in_map + there,
        centre_in_map=STRAP.centre_in_map + there,
    )


def bench(*, far=STRAP, near=STRAP, cloth=CLOTH_SEEN, hold=None, each_tick=lambda bench: None):
    """The right hand is to take the sleeve that the head sees at `far`, and the hand's camera at `near`."""
    held = {} if hold is None else {hold.hand: ARM}
    hands = {} if hold is None else {hold.hand: on_arm(hold.coordinate)}
    lies = lying_posture("right")
    return LeafBench(
        lambda context: GraspSleeve("grasp", context, side="right", hand="right", hold=hold),
        beside_bed(
            hands=hands,
            held=held,
            arm=lies,
            relocalised_arm=lies,
            sleeve_opening=far,
            sleeve_strap=near,
            gripped_cloth=cloth,
        ),
        each_tick=each_tick,
    )


def closed(run):
    """First tick at which the fingers have begun to close, after they opened for the strap."""
    opening = run.openings("right")
    return int(np.argmax(opening < 0.058))


def test_the_strap_is_taken_where_the_camera_of_the_hand_sees_it():
    near = moved(-0.03, 0.02, 0.01)
    run = bench(near=near)
    assert run.ended() is None
    hand = run.poses("right")[closed(run)]
    assert np.linalg.norm(hand[:3, 3] - near.position_in_map) < 0.02  # [m]
    assert hand[:3, 2] @ (0.0, 0.0, -1.0) > 0.0, "from above"
    assert run.openings("right")[-1] < 0.01
    assert not run.context.memory.of(SleeveMemory).sleeves, "a sleeve that is taken is remembered no more"
    grip = run.skill.grip
    assert (grip.arm, grip.hand) == ("right", "right")
    assert abs((hand[:3, :3] @ grip.across_in_hand) @ near.closing_in_map) > 0.9, "the fingers close across the strap"


def test_the_fingers_go_in_no_wider_than_the_strap_needs():
    run = bench()
    assert run.ended() is None
    before = slice(0, closed(run))
    around = np.linalg.norm(run.way("right")[before] - STRAP.position_in_map, axis=1) < 0.05
    assert around.sum() > 3
    assert run.openings("right")[before][around] == pytest.approx(0.06, abs=0.003)  # [m]


def test_a_strap_beside_the_middle_of_the_picture_is_looked_at_again():
    answers, asked = [moved(0.0, -0.08, 0.0), moved(-0.02, -0.06, 0.0)], []

    def near(frame, *, side, near_in_map):
        asked.append((frame.camera, near_in_map))
        return answers[len(asked) - 1]

    run = bench(near=near)
    assert run.ended() is None
    assert [camera for camera, _ in asked] == ["right_hand"] * 2
    assert asked[1][1] == pytest.approx(answers[0].position_in_map)
    assert np.linalg.norm(run.way("right")[closed(run)] - answers[1].position_in_map) < 0.02


def test_a_miss_ends_with_the_hand_open_and_drawn_back():
    run = bench(cloth=PerceptionFailure(Problem.NOTHING_SEEN, "cloth"))
    assert run.ended() == Reason.GRASP_MISSED
    assert run.openings("right").min() < 0.01, "the fingers have closed"
    assert run.openings("right")[-1] > 0.08
    assert np.linalg.norm(run.way("right")[-1] - run.way("right")[closed(run)]) == pytest.approx(0.12, abs=0.02)  # [m]
    assert run.context.guard.grip("right") == "nothing"
    assert len(refused_stands(run.skill, "right")) == 1, "the next try is from elsewhere"


def test_a_sleeve_that_shows_nowhere_is_told_and_no_hand_closes():
    run = bench(far=HIDDEN)
    assert run.ended() == Reason.NOTHING_SEEN
    assert run.openings("right").min() > 0.08
    head = [seen.head_pan for seen in run.seen]
    assert np.ptp(head) > 0.1, "it has looked around [rad]"
    assert len(refused_stands(run.skill, "right")) == 1, "the next try is from elsewhere"


def test_one_that_does_not_lie_where_it_was_seen_well_is_looked_for_again():
    old, now = moved(0.0, 0.12, 0.0), moved(0.0, 0.0, 0.0, confidence=0.2)

    def near(frame, *, side, near_in_map):
        if np.linalg.norm(near_in_map - old.position_in_map) < 0.01:
            raise HIDDEN
        return STRAP

    run = bench(far=now, near=near)
    run.context.memory.of(SleeveMemory, SleeveMemory).sleeves["right"] = old
    assert run.ended() is None
    assert np.linalg.norm(run.way("right")[closed(run)] - STRAP.position_in_map) < 0.02


def test_it_ends_when_the_other_hand_loses_the_arm():
    def slips(bench):
        if len(bench.seen) == 10:
            bench.world.between_fingers["left"] = 0.0

    run = bench(hold=Hold("left", 1.0), each_tick=slips)
    assert run.ended() == Reason.ARM_SLIPPED


def test_from_where_no_posture_takes_the_strap_is_told_to_who_chooses_the_next_stand():
    beyond = moved(-1.3, 0.0, 0.0)  # [m], across the bed: seen, and out of reach
    run = bench(near=beyond)
    assert run.ended() is Reason.UNREACHABLE
    (stand,) = refused_stands(run.skill, "right")
    np.testing.assert_allclose(stand, run.world.observe().pose_base_in_map, atol=0.01)
