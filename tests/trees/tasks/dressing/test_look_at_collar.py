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

CAMERAS = ("left_hand", "right_hand", "head")


def bench(shows=True, looks=None):
    """A bench whose pictures together show a collar, or none of them does; they are kept in `looks`."""

    def seen(frame, near_in_map, away=(0.0, 0.0), beside=()):
        pictures = (frame, *beside)
        if looks is not None:
            looks.extend(pictures)
        if not shows:
            raise PerceptionFailure(Problem.NOTHING_SEEN, "neck binding")
        return GraspPoint(
            stamp=frame.stamp,
            confidence=0.3 * len(pictures),
            target="collar_middle",
            position_in_map=np.array((0.04, -0.5, 0.8)),
            approach_in_map=np.array((0.0, 0.0, -1.0)),
            closing_in_map=np.array((0.0, 1.0, 0.0)),
        )

    arm = {"arm": lambda frame, side, **_: lying_posture(side)}
    return LeafBench(
        lambda context: LookAtCollar("look", context), beside_bed(stand=stance_at_head(), collar_middle=seen, **arm)
    )


def eye(camera, arms):
    """Where a camera was from the middle between the shoulders (3,) with such arms [m]."""
    middle = np.mean([lying_posture(side).points_in_map[0] for side in SIDES], axis=0)
    return kinematics_of(BAXTER).pose_camera_in_map(camera, stance_at_head(), arms, 0.0)[:3, 3] - middle


def test_what_all_cameras_see_the_hands_from_low_on_either_side_of_the_head_is_known_as_one():
    looks = []
    run = bench(looks=looks)
    assert run.ended(seconds=60.0) is None
    known = close_look(run.skill)
    assert known is not None
    assert known.confidence == pytest.approx(0.9)
    assert tuple(picture.camera for picture in looks) == CAMERAS
    for picture, side in zip(looks, (-1.0, 1.0), strict=False):
        then = min(run.seen, key=lambda seen: abs(seen.time - picture.stamp))
        x, y, z = eye(picture.camera, then.arm_positions)
        assert 0.3 < side * x < 0.6
        assert -0.6 < y < -0.3, "headward"
        assert 0.15 < z < 0.45
    assert run.world.observe().arm_positions == pytest.approx(run.world.robot.ready, abs=0.02)


def test_where_no_picture_shows_it_nothing_is_known_closely():
    run = bench(shows=False)
    assert run.ended(seconds=60.0) is None
    assert close_look(run.skill) is None


def test_what_was_just_looked_at_is_not_looked_at_again():
    run = bench()
    assert run.ended(seconds=60.0) is None
    known = close_look(run.skill)
    run.skill.initialise()
    looks = []
    again = bench(looks=looks)
    CloseLook.of(again.skill).seen = known
    assert again.ended(seconds=1.0) is None
    assert not looks
