import numpy as np
import pytest
from caretree.learning.gap.joints.readings import unsound, without_spikes
from caretree.learning.gap.measurement import load_set
from caretree.learning.gap.open_study import open_study

T = np.arange(0.0, 12.0, 0.005)
Q = 0.2 * np.sin(1.3 * T) + 0.05 * np.sin(4.1 * T)


def load(noise=0.1):
    a = -0.2 * 1.3**2 * np.sin(1.3 * T) - 0.05 * 4.1**2 * np.sin(4.1 * T)
    return 10.0 * a + noise * np.random.default_rng(1).normal(size=len(T))


def test_a_load_that_stands_still_while_its_joint_moves_is_told():
    x = load()
    x[400:480] = x[400]
    assert unsound(T, Q, x) == [(pytest.approx(T[400]), pytest.approx(T[479]))]


def test_a_load_that_is_cut_off_is_told_at_every_peak():
    x = np.minimum(load(), 6.0)
    found = unsound(T, Q, x)
    assert len(found) > 3
    t = T
    inside = np.any([(t >= a) & (t <= b) for a, b in found], axis=0)
    assert (inside == (x == 6.0)).all()


@pytest.mark.parametrize(
    "x",
    [
        load(),
        np.round(load() / 2.0) * 2.0,  # a coarse sensor
        np.where(np.abs(load(0.0)) > 5.0, 3.0, -3.0),  # two values alone
        np.clip(20.0 * np.sin(1.3 * T).round(), -6.0, 6.0),  # a simulated drive that pushes or does not, without noise
        np.zeros(len(T)),
    ],
)
def test_nothing_is_left_out_of_a_sound_load(x):
    assert unsound(T, Q, x) == []


def test_single_samples_far_off_both_neighbours_are_put_right_and_steps_stay():
    x = load() + np.where(T > 6.0, 15.0, 0.0)
    spoilt = x.copy()
    spoilt[[100, 700, 2000]] += (60.0, -40.0, 25.0)
    mended = without_spikes(spoilt)
    assert np.abs(mended - x).max() < 1.0
    assert (mended != spoilt).sum() == 3
    assert (without_spikes(x) == x).all()


def test_a_joint_at_rest_may_have_a_steady_load():
    x = load()
    x[400:480] = x[400]
    q = Q.copy()
    q[390:490] = q[390]
    assert unsound(T, q, x) == []


def stuck(q, v, a):
    """What a sensor reads too much of 10 kg and 6 N s/m that stands still for 0.3 s three times."""
    out = 6.0 * v
    for k in (150, 380, 610):
        rows = slice(k, k + 30)
        out[rows] = (10.0 * a + out)[k] - 10.0 * a[rows]
    return out


def test_what_stands_still_is_no_contact(axis_set):
    folder = axis_set(stuck, noise=0.0)
    rng = np.random.default_rng(4)
    for file in folder.glob("*.csv"):  # noise on what does not stand still
        table = np.loadtxt(file, delimiter=",", skiprows=1)
        still = np.isclose(np.diff(table[:, 3], prepend=np.inf), 0.0, atol=1e-9)
        table[:, 3] += 0.1 * rng.normal(size=len(table)) * ~still
        for k in np.flatnonzero(still):
            table[k, 3] = table[k - 1, 3]
        np.savetxt(file, table, delimiter=",", header="t,q,dq,force", comments="")
    verdict = open_study(load_set(folder)).conclude()
    assert [f.name for f in verdict.effects] == ["viscous_friction"]
    assert verdict.effects[0].parameters[0].value == pytest.approx(6.0, rel=0.05)
    assert any("stands still" in note for note in verdict.notes)


@pytest.mark.parametrize(
    ("extra", "said"),
    [
        (lambda q, v, a: np.abs(10.0 * a) - 10.0 * a, "never below 0"),
        (lambda q, v, a: -20.0 * a + 3.0 * v, "nearly minus"),
    ],
)
def test_a_load_that_has_lost_its_sign_is_unknown_and_said(axis_set, extra, said):
    verdict = open_study(load_set(axis_set(extra, noise=0.02))).conclude()
    assert verdict.verdict == "unknown"
    assert said in verdict.guess
    assert "'force'" in verdict.guess


@pytest.mark.parametrize("wrong", [lambda v: np.roll(v, 3), lambda v: 0.94 * v])
def test_a_speed_that_is_late_or_too_small_is_not_believed(axis_set, wrong):
    folder = axis_set(lambda q, v, a: 6.0 * v, noise=0.1)
    for file in folder.glob("*.csv"):
        table = np.loadtxt(file, delimiter=",", skiprows=1)
        table[:, 2] = wrong(table[:, 2])
        table[:, 1] += 2e-5 * np.random.default_rng(6).normal(size=len(table))  # else nobody would ask for a speed
        np.savetxt(file, table, delimiter=",", header="t,q,dq,force", comments="")
    verdict = open_study(load_set(folder)).conclude()
    assert [f.name for f in (*verdict.effects, *verdict.recalibration)] == ["viscous_friction"]
    assert verdict.effects[0].parameters[0].value == pytest.approx(6.0, rel=0.03)
    assert any(note.endswith(": dq.") for note in verdict.notes)
