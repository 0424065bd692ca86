import numpy as np
import pytest
from caretree.learning.gap.measurement import load_set
from caretree.learning.gap.study import open_study


def test_drag_is_named_and_sized(drop_set):
    study = open_study(load_set(drop_set(0.02)))
    verdict, effects, _, _ = study.name()
    assert verdict == "effects"
    assert [f.name for f in effects] == ["quadratic_drag"]
    assert effects[0].parameters[0].value == pytest.approx(0.02, rel=0.1)
    gap = study.show()[0]
    assert gap.after < 0.03 < gap.before


def test_vacuum_needs_nothing(drop_set):
    verdict, effects, _, _ = open_study(load_set(drop_set(0.0))).name()
    assert (verdict, effects) == ("adequate", ())


def test_drag_that_does_not_hold_on_the_held_out_drop_is_not_believed(drop_set):
    folder = drop_set(0.02)
    file = folder / "d3.csv"  # held out; there the body falls as in a vacuum
    data = np.loadtxt(file, delimiter=",", skiprows=1)
    data[:, 1] = 20.0 - 0.5 * 9.81 * data[:, 0] ** 2
    np.savetxt(file, data[data[:, 1] > 0.3], delimiter=",", header="t,h", comments="")
    verdict, _, _, guess = open_study(load_set(folder)).name()
    assert verdict == "unknown"
    assert "held-out" in guess


def test_sets_that_fit_as_well_are_listed_with_the_drop_that_tells_them_apart(drop_set):
    study = open_study(load_set(drop_set(0.003)))
    verdict = study.conclude()
    named = {(f.name, f.target) for f in verdict.effects}
    assert named
    assert verdict.rivals
    for rival in verdict.rivals:
        assert not set(rival.effects) >= named
        assert len(rival.effects) <= 2
        assert rival.experiment
