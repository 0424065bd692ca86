import numpy as np
import pytest
from caretree.learning.gap.joints.workflow import name_effects
from caretree.learning.gap.measurement import load_set
from caretree.learning.gap.open_study import open_study

from ..solved import solved


def test_nothing_is_named_where_nothing_is_missing(axis_set):
    study, verdict, effects, recalibration, _ = solved(axis_set())
    assert verdict == "adequate"
    assert effects == recalibration == ()
    assert study.find()[0] >= 0.05


def test_a_wrong_mass_is_recalibration(axis_set):
    _, verdict, effects, recalibration, _ = solved(axis_set(mass=8.0))
    assert verdict == "recalibration"
    assert effects == ()
    assert recalibration[0].parameters[0].value == pytest.approx(2.0, abs=0.1)
    assert "armature" in recalibration[0].equivalent


@pytest.mark.parametrize(
    ("name", "extra", "parameter", "value"),
    [
        ("viscous_friction", lambda q, v, a: 6.0 * v, "coefficient", 6.0),
        ("coulomb_friction", lambda q, v, a: 0.8 * np.sign(v), "level", 0.8),
        ("offset", lambda q, v, a: 0.7 + 0 * v, "value", 0.7),
        ("spring", lambda q, v, a: 12.0 * q, "stiffness", 12.0),
    ],
)
def test_a_single_effect_is_named_with_its_size(axis_set, name, extra, parameter, value):
    study, verdict, effects, _, _ = solved(axis_set(extra))
    assert verdict == "effects"
    assert [f.name for f in effects] == [name]
    found = next(p for p in effects[0].parameters if p.name == parameter)
    assert found.value == pytest.approx(value, rel=0.1)
    assert found.low < found.value < found.high
    gap = study.show()[0]
    assert gap.closed > 0.8


def test_two_effects_are_named_together(axis_set):
    _, _, effects, _, _ = solved(axis_set(lambda q, v, a: 8.0 * v + 1.0))
    assert {f.name for f in effects} == {"viscous_friction", "offset"}


@pytest.mark.parametrize(
    ("beside", "name", "parameter", "value"),
    [
        (lambda q, v, a: 0.3 + 0.0 * q, "offset", "value", 0.3),
        (lambda q, v, a: 0.5 * a, "mass", "mass", 0.5),
    ],
)
def test_what_is_small_beside_something_far_larger_and_much_of_what_that_leaves_is_named(
    axis_set, beside, name, parameter, value
):
    study = open_study(load_set(axis_set(lambda q, v, a: 60.0 * v + beside(q, v, a), noise=0.05)))
    _, effects, recalibration, _ = study.name()
    named = {f.name: {v.name: v for v in f.parameters} for f in (*effects, *recalibration)}
    assert set(named) == {"viscous_friction", name}
    assert named[name][parameter].value == pytest.approx(value, rel=0.1)
    gap = study.show()[0]
    assert gap.after < 2.0 * gap.floor


def test_no_interval_is_trusted_where_something_without_a_name_acts_too(axis_set):
    study = open_study(load_set(axis_set(lambda q, v, a: 8.0 * v + 3.0 * np.sin(150.0 * q), noise=0.1)))
    verdict = study.conclude()
    assert verdict.verdict == "unknown"
    values = [p for f in (*verdict.effects, *verdict.recalibration) for p in f.parameters]
    assert values
    assert all(p.doubt for p in values)


def pushed(folder, pushes):
    """The set with a constant force [N] added to each recording."""
    for k, push in enumerate(pushes):
        data = np.loadtxt(folder / f"e{k}.csv", delimiter=",", skiprows=1)
        data[:, 3] += push
        np.savetxt(folder / f"e{k}.csv", data, delimiter=",", header="t,q,dq,force", comments="")
    return folder


@pytest.mark.parametrize(("heldout", "verdict"), [(-0.05, "adequate"), (-1.0, "unknown")])
def test_an_effect_that_the_held_out_log_denies_is_missing_only_where_that_log_asks_for_another(
    axis_set, heldout, verdict
):
    study = open_study(load_set(pushed(axis_set(), (0.07, 0.07, heldout))))
    assert name_effects(study.model, study.fitted, "axis").chosen
    assert study.name()[:2] == (verdict, ())
