from dataclasses import replace

import numpy as np
import pytest
from caretree.learning.physics.clips.parameters import NAMES, SHOWN, to_spec, values_of
from caretree.learning.physics.clips.render_clip import render_clip
from caretree.learning.physics.methods.weights import PACKAGED, load_weights
from caretree.learning.physics.study.identify import identify, write
from caretree.sim.errors import CaretreeError
from caretree.sim.scene.gown import GOWNS
from caretree.sim.scene.gown_file import read_gown


def test_a_gown_is_identified_from_its_clip(fitted, small_gown, small_cut, tmp_path):
    gown = to_spec(np.full(6, 0.45), small_gown)
    found = identify(render_clip(gown), fitted)
    quick = identify(render_clip(gown), fitted, simulate=False)
    true = values_of(gown)
    shown = list(SHOWN)
    errors = [np.abs(f.values / true - 1)[shown].mean() for f in (found, quick)]
    assert errors[0] < 0.15, errors
    assert errors[0] < errors[1]
    assert (found.lower <= found.values).all()
    assert (found.values <= found.upper).all()
    text = found.table()
    assert all(name in text for name in NAMES)
    assert "not shown" in next(line for line in text.splitlines() if line.startswith("friction"))
    assert "not shown" not in next(line for line in text.splitlines() if line.startswith("mass"))
    gown_file = read_gown(write(found, tmp_path / "gown.yaml"))
    assert gown_file.values["mass"] == pytest.approx(found.values[0])
    assert gown_file.spec.mass == pytest.approx(found.values[0])


def test_a_clip_that_shows_no_falling_gown_is_refused(fitted, small_gown, small_cut):
    clip = render_clip(to_spec(np.full(6, 0.5), small_gown))
    wall = replace(clip, depth=np.full_like(clip.depth, 2.6))
    with pytest.raises(CaretreeError, match="no falling gown of the cut 'medium' looks like this clip"):
        identify(wall, fitted)
    with pytest.raises(CaretreeError, match=r"no falling gown of the cut 'medium' .* learned from") as caught:
        identify(wall, fitted, simulate=False)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("cut", ["medium", "large"])
@pytest.mark.parametrize("what", ["a person", "a wall", "noise"])
def test_without_simulating_the_packaged_weights_refuse_what_is_no_gown_and_take_gowns(cut, what):
    method, _ = load_weights(PACKAGED)
    clip = render_clip(to_spec(np.full(6, 0.5), GOWNS[cut]))
    assert identify(clip, method, cut, simulate=False).misfit < 2.0
    rows, columns = np.mgrid[:64, :64]
    lying = ((columns - 32) / 10) ** 2 + ((rows - 32) / 28) ** 2 < 1
    depth = {
        "a person": np.where(lying, 2.5, np.nan) + np.zeros((15, 1, 1)),
        "a wall": np.full_like(clip.depth, 2.6),
        "noise": np.random.default_rng(0).uniform(1.0, 3.0, clip.depth.shape),
    }[what]
    with pytest.raises(CaretreeError, match=f"no falling gown of the cut '{cut}' looks like this clip"):
        identify(replace(clip, depth=depth.astype(np.float32)), method, cut, simulate=False)
