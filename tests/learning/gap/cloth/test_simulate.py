import dataclasses

import numpy as np
import pytest
from caretree.learning.gap.cloth.scene import read_scene
from caretree.learning.gap.cloth.simulate import Simulator
from caretree.learning.gap.measurement import load_set
from caretree.sim.effects.model_file import EffectEntry


def test_a_run_repeats_exactly_and_is_done_once(cloth_set, tmp_path):
    scene, episodes = read_scene(load_set(cloth_set))
    sim = Simulator(scene, tmp_path / "cache")
    first = sim.run(episodes[0])
    assert np.array_equal(first, Simulator(scene).run(episodes[0]))
    again = Simulator(scene, tmp_path / "cache")
    assert np.array_equal(first, again.run(episodes[0]))
    assert (sim.runs, again.runs) == (1, 0)


def test_the_load_at_the_pin_is_the_weight_once_it_hangs(cloth_set):
    scene, episodes = read_scene(load_set(cloth_set))
    long = dataclasses.replace(episodes[0], t=np.arange(0.0, 3.0, 0.05))
    load = Simulator(scene).run(long)[-20:, -1].mean()
    assert load == pytest.approx(-0.1 * 9.81, rel=0.05)


def test_tilted_gravity_swings_the_free_edge_towards_the_tilt(cloth_set):
    scene, episodes = read_scene(load_set(cloth_set))
    sim = Simulator(scene)
    tilt = EffectEntry(name="tilted_gravity", target="cloth", parameters={"towards_x": 0.0, "towards_y": 0.2})
    change = sim.run(episodes[0], (tilt,)) - sim.run(episodes[0])
    assert change[-1, 3 * 3 + 1] > 0.005


def test_an_effect_of_no_size_changes_nothing_but_brings_its_proxy_bodies(cloth_set):
    scene, episodes = read_scene(load_set(cloth_set))
    sim = Simulator(scene)
    drag = EffectEntry(name="air_drag", target="cloth", parameters={"coefficient": 0.0})
    stiff = EffectEntry(name="strain_stiffening", target="cloth", parameters={"stiffness": 0.0, "onset": 0.1})
    late = EffectEntry(name="delay", target="cloth", parameters={"time": 0.0})
    assert np.array_equal(sim.run(episodes[0], (drag,)), sim.run(episodes[0], (stiff,)))
    assert np.array_equal(sim.run(episodes[0], (late,)), sim.run(episodes[0]))
