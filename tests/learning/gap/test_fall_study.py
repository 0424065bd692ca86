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
