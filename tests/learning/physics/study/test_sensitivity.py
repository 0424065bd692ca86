import json
from dataclasses import replace

import numpy as np
import pytest
from caretree.learning.physics.clips.parameters import HIGH, LOW, NAMES, SHOWN
from caretree.learning.physics.clips.render_clip import render_clip
from caretree.learning.physics.study import sensitivity
from caretree.sim.scene.gown import GOWNS


@pytest.fixture(scope="module")
def table():
    return sensitivity.study(gowns=1, seed=3)


def test_a_derivative_foretells_a_small_change():
    """Air drag does not enter the static equilibrium: its slope times a step is what a clip with that step shows."""
    gown = replace(GOWNS["medium"], air_drag=0.3)
    _, metres, _ = sensitivity.derivatives(gown)
    step = 0.03
    k = NAMES.index("air_drag")
    there = render_clip(replace(gown, air_drag=0.3 * (HIGH[k] / LOW[k]) ** step)).depth
    change = (there - render_clip(gown).depth).ravel()
    foretold = np.median(np.abs(metres[SHOWN.index(k)])) * step
    seen = np.abs(change[np.isfinite(change) & (np.abs(change) < sensitivity.EDGE)])
    assert np.median(seen) == pytest.approx(foretold, rel=0.3)


def test_not_knowing_the_others_never_helps(table):
    for row in table.rows:
        assert row.unknown >= row.known
        assert row.moves > 0 or row.name == "friction"


def test_without_the_clamp_the_common_factor_is_not_shown(table):
    assert table.scale_free < 1e-3  # [mm]
    assert table.scale_known < 10.0  # [%]


def test_what_does_not_show_is_told_so(table, tmp_path):
    text = sensitivity.report(table)
    assert "| friction | 0 | not shown | not shown |" in text
    table.write(tmp_path / "a.json")
    assert len(json.loads((tmp_path / "a.json").read_text())["rows"]) == len(NAMES)
