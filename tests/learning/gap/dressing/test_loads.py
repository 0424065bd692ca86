from dataclasses import replace

import numpy as np
import pytest
from caretree.learning.gap.dressing.loads import CHANNELS, SEEN, TICKS, Predictions, averaged, columns_of
from caretree.sim.bullet import replay_world
from caretree.sim.effects.model_file import EffectEntry
from caretree.sim.record.recorded_stretch import read_stretch

from ....sim.record.recorded_lift import write_record
from ....sim.record.test_measured import ARMS


@pytest.fixture
def stretch(tmp_path):
    return read_stretch(write_record(tmp_path / "run", ARMS))


def test_columns_are_the_load_on_the_hand_that_holds_and_its_axes(stretch):
    columns = columns_of(stretch)
    assert len(columns["t"]) == stretch.looked_at.sum() // TICKS
    assert not columns["hand"].any()
    turn = np.array([columns[f"r{i}{k}"][0] for i in range(3) for k in range(3)]).reshape(3, 3)
    np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-3)


def test_where_the_arm_was_seen_last_is_compared_and_through_which_camera(stretch):
    columns = columns_of(stretch)
    wrist = np.stack([columns[name] for name in SEEN], axis=1)
    np.testing.assert_allclose(wrist, np.tile(ARMS[1, 2], (len(wrist), 1)), atol=1e-9)
    camera = np.array([columns[f"c{i}{k}"][0] for i in range(3) for k in range(3)]).reshape(3, 3)
    np.testing.assert_allclose(camera @ camera.T, np.eye(3), atol=1e-6)
    unseen = replace(stretch, robot=replace(stretch.robot, arm_side=stretch.robot.arm_side * 0))
    assert set(CHANNELS) < set(columns_of(unseen))
    assert not set(SEEN) & set(columns_of(unseen))


def test_late_loads_cost_no_simulation_and_arms_that_were_seen_are_not_late(stretch, monkeypatch):
    ramp = np.tile(stretch.robot.t[:, None, None], (1, 2, 3))
    moving = np.tile(stretch.robot.t[:, None, None, None], (1, 2, 4, 3))
    monkeypatch.setattr(replay_world, "replayed", lambda *asked: replay_world.Answer(load=ramp, arms=moving))
    predictions = Predictions()
    plain = predictions.of(stretch, ())
    late = predictions.of(stretch, (EffectEntry(name="load_delay", target="wrists", parameters={"delay": 0.1}),))
    np.testing.assert_allclose(late[2:, :3], plain[2:, :3] - 0.1, atol=1e-9)
    np.testing.assert_array_equal(late[:, 3:], plain[:, 3:])
    assert not np.ptp(plain[:, 3:], axis=0).any(), "it was seen once, as it lay"
    assert predictions.simulated == 1


def test_means_are_of_samples_in_turn_without_those_that_are_left_over():
    looked_at = np.array([1, 1, 1, 1, 1, 0, 0, 1, 1, 1, 1, 0, 1, 1], bool)
    assert averaged(np.arange(14.0), looked_at).tolist() == [1.5, 8.5]


def test_the_same_is_simulated_once_even_by_another_process(stretch, tmp_path, monkeypatch):
    asked = []

    def replayed(of, model, drag):
        asked.append(model)
        loads = np.arange(of.robot.t.size * 6, dtype=float).reshape(-1, 2, 3)
        return replay_world.Answer(load=loads, arms=np.zeros((of.robot.t.size, 2, 4, 3)))

    monkeypatch.setattr(replay_world, "replayed", replayed)
    heavy = (EffectEntry(name="arm_weight", target="arms", parameters={"mass": 0.1}),)
    first = Predictions(tmp_path / "cache")
    plain = first.of(stretch, ())
    assert asked == [None]
    first.of(stretch, heavy)
    first.of(stretch, ())
    assert len(asked) == 2
    again = Predictions(tmp_path / "cache")
    np.testing.assert_array_equal(again.of(stretch, ()), plain)
    assert len(asked) == 2
    assert again.simulated == 0
    for file in (tmp_path / "cache").glob("*.npy"):
        file.write_bytes(b"half")
    Predictions(tmp_path / "cache").of(stretch, ())
    assert len(asked) == 3
