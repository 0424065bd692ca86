"""A recording of the dressing world's gown, and the workflow's own prediction of it."""

import numpy as np
import pytest
from caretree.learning.gap.cloth.fitting import measured
from caretree.learning.gap.cloth.noise import load_misfit
from caretree.learning.gap.cloth.scene import read_scene
from caretree.learning.gap.cloth.simulate import simulate
from caretree.learning.gap.errors import GapError
from caretree.learning.gap.measurement import load_set
from caretree.learning.gap.record import record
from caretree.sim.effects.model_file import load_model, save_model


def test_a_model_file_moves_the_worlds_gown_as_it_moves_the_predicted_one(tmp_path):
    drag = {"name": "air_drag", "target": "cloth", "parameters": {"coefficient": 2.0}}
    save_model(tmp_path / "model.yaml", {"system": "cloth", "recalibration": [], "effects": [drag]})
    record("light", str(tmp_path / "model.yaml"), tmp_path / "set", duration=0.5, noise=0.0)
    scene, episodes = read_scene(load_set(tmp_path / "set"))
    effects = load_model(tmp_path / "model.yaml").effects
    seen = measured(episodes[0])
    with_it = simulate(scene, episodes[0], effects, {})
    without = simulate(scene, episodes[0], (), {})
    assert np.sqrt(np.mean((seen - with_it) ** 2)) < 0.001
    assert np.sqrt(np.mean((seen - without) ** 2)) > 0.005


def test_a_recording_must_last(tmp_path):
    with pytest.raises(GapError, match=r"at least 0\.5 s"):
        record("light", None, tmp_path, duration=0.1)


def test_a_load_that_is_off_is_noticed_without_any_marker_being_off():
    rng = np.random.default_rng(0)
    t = np.linspace(0.0, 1.0, 100)
    load = np.stack([0 * t, 0 * t, -20.0 * t], axis=1)
    cell = np.concatenate([rng.normal(size=(100, 6)) * 1e-4, rng.normal(size=(100, 3)) * 0.05], axis=1)
    off = cell + np.concatenate([np.zeros((100, 8)), 4.0 * (t**2)[:, None]], axis=1)
    assert load_misfit([cell], [load], 2) == 1.0
    assert load_misfit([off], [load], 2) < 1e-3
    assert load_misfit([cell[:, :6]], [None], 2) == 1.0
