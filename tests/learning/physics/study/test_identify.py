from dataclasses import replace

import numpy as np
import pytest
from caretree.learning.physics.clips.parameters import HIGH, NAMES, SHOWN, to_spec, values_of
from caretree.learning.physics.clips.render_clip import render_clip
from caretree.learning.physics.study.identify import identify, write
from caretree.sim.errors import CaretreeError
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
    assert (identify(wall, fitted, simulate=False).upper == HIGH).any()  # without a simulation: wide intervals
