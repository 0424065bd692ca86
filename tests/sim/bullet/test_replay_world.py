"""A recorded lift, once more: what the hand feels is what this model's arm weighs."""

from contextlib import closing
from unittest.mock import patch

import numpy as np
import pytest
from caretree.sim.bullet import replay_world
from caretree.sim.bullet.replay_world import ReplayWorld, replayed
from caretree.sim.effects.model_file import EffectEntry, EffectModel
from caretree.sim.record.recorded_stretch import read_stretch
from scipy.spatial.transform import Rotation

from ..record.recorded_lift import write_record
from ..record.test_measured import ARMS


@pytest.fixture(scope="module")
def stretch(tmp_path_factory):
    """A lift over the arms as they lie in this world."""
    folder = tmp_path_factory.mktemp("lift")
    begun = read_stretch(write_record(folder, ARMS))
    with patch.object(replay_world, "put_arms"), closing(ReplayWorld(begun)) as world:
        arms = world._person.arms()
    return read_stretch(write_record(folder, arms))


def with_effect(name, target, **parameters):
    entry = EffectEntry(name=name, target=target, parameters=parameters)
    return EffectModel(system="dressing", base={}, recalibration=(), effects=(entry,))


def test_the_arm_comes_along_and_weighs_on_the_hand(stretch):
    answer = replayed(stretch)
    moved = answer.arms[-1, 1, 1] - answer.arms[0, 1, 1]
    assert moved[2] == pytest.approx(0.08, abs=0.02)
    assert answer.load[0, 0] == pytest.approx((0, 0, 0), abs=1e-9)
    assert -35.0 < answer.load[-1, 0, 2] < -3.0, "weight, and the dry friction against which it was lifted"
    assert np.abs(answer.load[:, 1]).max() < 1e-9  # the other hand holds nothing


def test_the_same_question_has_the_same_answer(stretch):
    np.testing.assert_array_equal(replayed(stretch).load, replayed(stretch).load)


def test_a_heavier_arm_weighs_more(stretch):
    plain, heavy = replayed(stretch), replayed(stretch, with_effect("arm_weight", "arms", mass=0.3))
    rises = np.flatnonzero(np.diff(plain.arms[:, 1, 1, 2]) > 0.002)[
        5:
    ]  # at first, and at rest, dry friction may carry it
    more = np.mean((plain.load - heavy.load)[rises, 0, 2])
    assert 0.5 * 0.3 * 9.81 < more < 2.0 * 0.3 * 9.81


def test_fingers_that_drag_the_arm_along_strain_its_joints_either_way(stretch):
    plain, one, other = (replayed(stretch, drag=drag).load[:, 0] for drag in (0.0, 0.002, -0.002))
    turn = np.array([0.0, 1.0, 0.0])  # along the closing fingers, in the hand's frame
    closing = Rotation.from_quat(stretch.robot.pose_hand[-1, 0, 3:]).apply(turn)
    held = stretch.looked_at & (stretch.held.part[:, 0] >= 0)
    assert np.mean((one - plain)[held] @ closing) < -0.5
    assert np.mean((other - plain)[held] @ closing) > 0.5
    before = stretch.held.part[:, 0] < 0
    assert not one[before][:-3].any()
