import numpy as np

from ..solved import solved


def test_an_effect_outside_the_registry_is_unknown(axis_set):
    _, verdict, _, _, guess = solved(axis_set(lambda q, v, a: 1.5 * np.sin(90.0 * q)))
    assert verdict == "unknown"
    assert guess


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


def test_what_makes_the_held_out_recording_worse_is_never_found(axis_set):
    folder = axis_set(lambda q, v, a: 6.0 * v, episodes=4)
    file = folder / "e3.csv"  # held out, and without friction
    data = np.loadtxt(file, delimiter=",", skiprows=1)
    data[:, 3] -= 6.0 * data[:, 2]
    np.savetxt(file, data, delimiter=",", header="t,q,dq,force", comments="")
    study, verdict, effects, recalibration, guess = solved(folder)
    assert verdict == "unknown"
    assert effects == recalibration == ()
    assert "viscous_friction on axis would explain the fitted recordings and make the held-out ones worse" in guess
    assert study.patch()["effects"] == []
    gap = study.show()[0]
    assert gap.after == gap.before
