import numpy as np
import pytest
from caretree.learning.gap.joints.widen import widened
from caretree.learning.gap.measurement import load_set
from caretree.learning.gap.open_study import open_study


def solved(folder):
    study = open_study(load_set(folder))
    return study, *study.name()


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


def test_contact_is_placed_in_time(axis_set):
    wall = 0.05
    study, _, effects, _, _ = solved(axis_set(lambda q, v, a: 80.0 * np.maximum(q - wall, 0.0)))
    assert [f.name for f in effects] == ["contact"]
    both = either = 0
    for episode in study.measured.episodes:
        real = episode.columns["q"] > wall
        found = np.zeros(len(real), dtype=bool)
        for w in study.find()[2]:
            if w.effect == "contact" and w.episode == episode.name:
                found |= (episode.t >= w.t0) & (episode.t <= w.t1)
        both, either = both + (real & found).sum(), either + (real | found).sum()
    assert both / either > 0.7


def test_an_effect_outside_the_registry_is_unknown(axis_set):
    _, verdict, _, _, guess = solved(axis_set(lambda q, v, a: 1.5 * np.sin(90.0 * q)))
    assert verdict == "unknown"
    assert guess


def test_placebo_does_not_help_and_the_smallest_size_is_smaller_than_the_found(axis_set):
    study, _, effects, _, _ = solved(axis_set(lambda q, v, a: 6.0 * v))
    placebos = study.show()[2]
    assert placebos
    assert all(p.ratio > 0.97 for p in placebos)
    assert 0.0 < effects[0].smallest < 1.0


def test_a_contact_at_a_time_is_named_and_placed(axis_set):
    folder = axis_set(noise=0.1)
    truth = {}
    for k in range(3):
        file = folder / f"e{k}.csv"
        data = np.loadtxt(file, delimiter=",", skiprows=1)
        start = 2.0 + 1.1 * k
        inside = (data[:, 0] > start) & (data[:, 0] < start + 0.6)
        data[:, 3] += np.where(inside, 2.0 * np.sin(np.pi * (data[:, 0] - start) / 0.6), 0.0)
        truth[f"e{k}"] = (start, start + 0.6)
        np.savetxt(file, data, delimiter=",", header="t,q,dq,force", comments="")
    study, verdict, effects, _, _ = solved(folder)
    assert verdict == "effects"
    assert [(f.name, f.target) for f in effects] == [("contact", "axis")]
    places = [w for w in study.find()[2] if w.effect == "contact"]
    assert {w.episode for w in places} == set(truth)
    for w in places:
        a, b = truth[w.episode]
        assert (min(w.t1, b) - max(w.t0, a)) / (max(w.t1, b) - min(w.t0, a)) > 0.7


def test_effects_that_do_not_hold_on_the_held_out_recording_are_not_believed(axis_set):
    folder = axis_set(lambda q, v, a: 6.0 * v, episodes=4)
    file = folder / "e3.csv"  # held out; there the friction is another one
    data = np.loadtxt(file, delimiter=",", skiprows=1)
    data[:, 3] += 20.0 * data[:, 2]
    np.savetxt(file, data, delimiter=",", header="t,q,dq,force", comments="")
    _, verdict, _, _, guess = solved(folder)
    assert verdict == "unknown"
    assert "do not hold on the held-out" in guess


def test_a_louder_held_out_recording_does_not_make_an_effect_unknown(axis_set):
    folder = axis_set(lambda q, v, a: 6.0 * v, episodes=4)
    file = folder / "e3.csv"  # held out, and five times as noisy
    data = np.loadtxt(file, delimiter=",", skiprows=1)
    data[:, 3] += 2.0 * np.random.default_rng(1).normal(size=len(data))
    np.savetxt(file, data, delimiter=",", header="t,q,dq,force", comments="")
    _, verdict, effects, _, _ = solved(folder)
    assert verdict == "effects"
    assert [f.name for f in effects] == ["viscous_friction"]


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
