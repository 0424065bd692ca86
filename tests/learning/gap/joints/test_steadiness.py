import numpy as np
import pytest
from caretree.learning.gap.joints.remains.steadiness import unsteady

from ..solved import solved


def test_friction_that_stays_the_same_is_steady(axis_set):
    study, verdict, *_ = solved(axis_set(lambda q, v, a: 30.0 * v + 2.0 * np.sign(v)))
    assert verdict == "effects"
    assert unsteady(study.named, study.fitted) == ""


def test_friction_that_warms_up_along_every_recording_is_not_the_registrys(axis_set):
    warm = np.linspace(1.6, 0.4, 800)
    study, verdict, effects, _, guess = solved(axis_set(lambda q, v, a: 30.0 * warm * v))
    assert verdict == "unknown"
    assert "viscous_friction" in [e.name for e in effects]
    assert guess == unsteady(study.named, study.fitted)
    assert "viscous_friction on axis is not the same all the time" in guess
    assert "at the beginning of e" in guess
    assert "at the end of e" in guess


@pytest.mark.parametrize(("last", "verdict"), [(1.6, "unknown"), (1.02, "effects")])
def test_friction_that_differs_from_one_recording_to_the_next_is_told_where_it_matters(axis_set, last, verdict):
    sizes = iter((1.0, last, 1.0))  # in the recording that is held out as in the first one

    def extra(q, v, a):
        return 30.0 * next(sizes) * v

    study, said, _, _, guess = solved(axis_set(extra))
    assert said == verdict
    assert ("not the same all the time" in guess) == (verdict == "unknown")
    assert bool(unsteady(study.named, study.fitted)) == (verdict == "unknown")
