from dataclasses import replace

import numpy as np
from caretree.learning.gap.joints.log import FINE, SHARED
from caretree.learning.gap.measurement import load_set
from caretree.learning.gap.open_study import open_study
from caretree.learning.gap.smoothing import lowpass_both
from caretree.sim.effects.joint.joint_registry import JOINT_EFFECTS


def test_a_log_balances_the_measured_load_and_the_models(axis_set):
    log = open_study(load_set(axis_set(lambda q, v, a: 5.0 * v, noise=0.05))).fitted[0]
    inner = log.inner
    assert np.corrcoef(log.residual[inner, 0], log.dq[inner, 0])[0, 1] > 0.99
    assert np.allclose(log.rigid, 10.0 * log.ddq)
    assert log.wide().cutoff == np.inf


def test_without_a_column_of_speed_the_slope_of_the_position_is_taken(axis_set):
    folder = axis_set(noise=0.05)
    given = open_study(load_set(folder)).fitted[0]
    for file in folder.glob("*.csv"):
        data = np.loadtxt(file, delimiter=",", skiprows=1)
        np.savetxt(file, np.delete(data, 2, axis=1), delimiter=",", header="t,q,force", comments="")
    derived = open_study(load_set(folder)).fitted[0]
    inner = derived.inner
    assert np.allclose(derived.dq[inner], given.dq[inner], atol=0.02 * np.abs(given.dq).max())


def test_a_log_keeps_enough_rows_for_what_happens_at_once(axis_set):
    log = open_study(load_set(axis_set(noise=0.05))).fitted[0]
    recorded = 0.01
    assert log.dt <= max(recorded, 1.0 / (FINE * log.cutoff / SHARED))
    assert FINE >= 16


def test_what_jumps_is_asked_at_every_sample_recorded(axis_set):
    fine = open_study(load_set(axis_set(noise=0.05))).fitted[0]
    rows = slice(None, None, 8)
    thin = {name: getattr(fine, name)[rows] for name in ("t", "q", "dq", "ddq", "rigid", "measured", "residual", "raw")}
    log = replace(fine, step=8 * fine.step, dt=8 * fine.dt, cutoff=1.5, trim=0, **thin)
    effect, shape = JOINT_EFFECTS["backlash"], {"width": 0.02}
    wanted = lowpass_both(effect.columns(fine.motion(0), shape), fine.dt, 1.5, 1.5 / SHARED)[rows]
    rough = log.shared(effect.columns(log.motion(0), shape), sharp=True)
    error, before = (np.abs(x - wanted)[5:-5].max() for x in (log.columns(effect, 0, shape), rough))
    assert error < 0.25 * before
    assert error < 0.05 * np.abs(wanted).max()
