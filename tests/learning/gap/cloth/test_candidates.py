import numpy as np
import pytest
from caretree.learning.gap.cloth.candidates import candidates
from caretree.learning.gap.cloth.scene import read_scene
from caretree.learning.gap.measurement import load_set


@pytest.fixture
def found(cloth_set):
    scene, episodes = read_scene(load_set(cloth_set))
    residuals = [np.zeros((len(e.t), 18)) for e in episodes]
    for r in residuals:
        r[12:, 6] = 0.02  # the third marker leaves the model half way, along x
    return scene, episodes, candidates(scene, episodes, residuals)


def test_a_hypothesis_starts_at_no_size_and_is_pushed_to_one_that_differs(found):
    for c in found[2]:
        assert any(c.push.value(f) != c.start.value(f) for f in c.start.free), c.name
        assert all(c.steps[f] > 0.0 for f in c.start.free), c.name


def test_nothing_touches_where_there_is_nothing_to_touch(found):
    names = {c.name for c in found[2]}
    assert {"air_drag", "wind", "added_mass", "snag", "grip_slip", "mass", "elastic_stiffness"} <= names
    assert not {"contact_friction", "adhesion"} & names


def test_snags_and_slips_are_tried_where_and_when_the_residual_begins(found):
    scene, episodes, pool = found
    snag = next(c for c in pool if c.name == "snag").push
    place = [snag.effects[0].parameters[a] for a in "xyz"]
    assert place == pytest.approx(scene.vertices[scene.markers[2]])
    begins = episodes[0].t[12]
    assert snag.effects[0].parameters["t0"] == pytest.approx(begins, abs=0.1)
    assert any(
        c.push.value(("grip_slip", "time")) == pytest.approx(begins, abs=0.1) for c in pool if c.name == "grip_slip"
    )
