import numpy as np
import pytest
from caretree.learning.gap.joints.widen import widened
from caretree.learning.gap.measurement import load_set
from caretree.learning.gap.open_study import open_study

from ..solved import solved


def test_dry_friction_is_as_wide_as_the_log_shows(axis_set):
    _, verdict, effects, _, _ = solved(axis_set(lambda q, v, a: 3.0 * np.tanh(2.0 * v / 0.1)))
    assert verdict == "effects"
    assert [f.name for f in effects] == ["coulomb_friction"]
    values = {p.name: p.value for p in effects[0].parameters}
    assert values["level"] == pytest.approx(3.0, rel=0.1)
    assert values["width"] == pytest.approx(0.1, rel=0.3)


def test_dry_friction_that_jumps_gets_no_width(axis_set):
    _, _, effects, _, _ = solved(axis_set(lambda q, v, a: 0.8 * np.sign(v)))
    assert [p.name for p in effects[0].parameters] == ["level"]


def test_friction_that_grows_with_speed_is_not_wide_dry_friction(axis_set):
    study = open_study(load_set(axis_set(lambda q, v, a: 8.0 * v)))
    search = study.named.search
    dry = next(i for i, b in enumerate(search.blocks) if b.name == "coulomb_friction")
    assert "width" not in widened(search, (dry,), study.model, study.fitted).blocks[dry].shape
