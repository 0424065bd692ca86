"""Head and hands look at both armholes, from the head of the bed."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.estimates import SleeveProfile
from caretree.perception.sleeve.sleeve_profile import reach_of
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.world import SIDES
from caretree.skills.belief.close_look import CloseLook, SleeveSeen, sleeve_seen
from caretree.skills.geometry.stances import outwards, stance_at_head
from caretree.skills.scripted.scripted_person import lying_posture
from caretree.trees.tasks.dressing.look_at_sleeves import LookAtSleeves, LookAtSleevesTuning

from ....skills.bench import LeafBench, beside_bed

EYES = LookAtSleevesTuning().eyes


def bench(shows=("head", "left_hand", "right_hand"), at=0.3, looks=None, tuning=None):
    """A bench on which armholes lie at `at` of the upper arms for the cameras that they show to."""

    def seen(frame, side, arm_in_map):
        assert arm_in_map == pytest.approx(lying_posture(side).points_in_map)
        if looks is not None:
            looks.append((frame.camera, side, run.world.observe().arm_positions))
        if frame.camera not in shows:
            raise PerceptionFailure(Problem.NOTHING_SEEN, "armhole")
        return profile(side, at)

    options = {} if tuning is None else {"tuning": tuning}
    run = LeafBench(
        lambda context: LookAtSleeves("look", context, **options),
        beside_bed(stand=stance_at_head(), sleeve_profile=seen, arm=lambda frame, side, **_: lying_posture(side)),
    )
    return run


def profile(side, at):
    cuff_at = np.where(np.arange(24) < 12, at + 0.5, np.nan)
    return SleeveProfile(stamp=0.0, confidence=1.0, side=side, armhole_at=np.full(24, at), cuff_at=cuff_at)


def test_both_are_looked_at_by_head_and_hand_from_two_places_beside_the_shoulder():
    looks = []
    run = bench(looks=looks)
    assert run.ended(seconds=90.0) is None
    for side in SIDES:
        assert sleeve_seen(run.skill, side).reach == reach_of([profile(side, 0.3)])
        assert sleeve_seen(run.skill, side).round_arm == 0.5
        assert [camera for camera, whose, _ in looks if whose == side] == ["head"] + [f"{side}_hand"] * len(EYES)
    middle = np.mean([lying_posture(side).points_in_map[0] for side in SIDES], axis=0)
    for n, eye in enumerate(EYES):
        for camera, side, arms in looks[2 * n + 2 : 2 * n + 4]:
            pose = kinematics_of(BAXTER).pose_camera_in_map(camera, stance_at_head(), arms, 0.0)
            at = pose[:3, 3] - middle
            assert (at @ outwards(side), -at[1], at[2]) == pytest.approx(eye, abs=0.03)
            to = lying_posture(side).points_in_map[0] - pose[:3, 3]
            assert to @ pose[:3, 2] / np.linalg.norm(to) > 0.9, "the shoulder is in the picture"
    assert run.world.observe().arm_positions == pytest.approx(run.world.robot.ready, abs=0.02)


@pytest.mark.parametrize(("shows", "known"), [(("head",), ()), (("left_hand",), ("left",)), ((), ())])
def test_one_picture_tells_nothing(shows, known):
    run = bench(shows)
    assert run.ended(seconds=90.0) is None
    assert tuple(side for side in SIDES if sleeve_seen(run.skill, side) is not None) == known


def test_places_that_no_hand_gets_to_are_left_out():
    run = bench(tuning=LookAtSleevesTuning(eyes=((3.0, 0.0, 3.0), EYES[1])))
    assert run.ended(seconds=90.0) is None
    assert sleeve_seen(run.skill, "left") is not None
    run = bench(tuning=LookAtSleevesTuning(eyes=((3.0, 0.0, 3.0),)))
    assert run.ended(seconds=90.0) is None
    assert sleeve_seen(run.skill, "left") is None


def test_what_nobody_touched_since_is_not_looked_at_again():
    looks = []
    run = bench(looks=looks)
    for side in SIDES:
        CloseLook.of(run.skill).sleeves[side] = SleeveSeen(0.8, 0.9, run.skill.now())
    assert run.ended(seconds=1.0) is None
    assert not looks
    assert sleeve_seen(run.skill, "right").reach == 0.8
