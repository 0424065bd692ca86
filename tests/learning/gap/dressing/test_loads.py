import numpy as np
import pytest
from caretree.learning.gap.dressing.loads import TICKS, LoadPredictions, columns_of
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


def test_the_same_is_simulated_once_even_by_another_process(stretch, tmp_path, monkeypatch):
    asked = []

    def replayed(of, model):
        asked.append(model)
        loads = np.arange(of.robot.t.size * 6, dtype=float).reshape(-1, 2, 3)
        return replay_world.Answer(load=loads, arms=np.zeros((of.robot.t.size, 2, 4, 3)))

    monkeypatch.setattr(replay_world, "replayed", replayed)
    heavy = (EffectEntry(name="arm_weight", target="arms", parameters={"mass": 0.1}),)
    first = LoadPredictions(tmp_path / "cache")
    plain = first.load(stretch, ())
    assert asked == [None]
    first.load(stretch, heavy)
    first.load(stretch, ())
    assert len(asked) == 2
    again = LoadPredictions(tmp_path / "cache")
    np.testing.assert_array_equal(again.load(stretch, ()), plain)
    assert len(asked) == 2
    assert again.simulated == 0
    for file in (tmp_path / "cache").glob("*.npy"):
        file.write_bytes(b"half")
    LoadPredictions(tmp_path / "cache").load(stretch, ())
    assert len(asked) == 3
