import numpy as np
import pytest
from caretree.learning.gap.joints.log import JointLog
from caretree.learning.gap.joints.remains.remainder import leftover
from caretree.learning.gap.measurement import load_set
from caretree.learning.gap.open_study import open_study


def remainder(folder):
    logs = open_study(load_set(folder)).fitted
    wide = [log.wide() for log in logs]
    return leftover(logs, [x.residual[x.inner] for x in logs], [x.residual[x.inner] for x in wide], 0)


def test_noise_cannot_be_predicted(axis_set):
    assert remainder(axis_set()).p_value > 0.01


def test_cogging_is_a_wave_in_position_of_its_own_period(axis_set):
    found = remainder(axis_set(lambda q, v, a: 1.5 * np.sin(90.0 * q)))
    assert found.p_value < 1e-6
    assert found.kind == "position wave"
    assert float(found.detail.split()[1]) == pytest.approx(2.0 * np.pi / 90.0, rel=0.05)
    assert 0.0 < found.energy <= found.base


def built_up(q, distance):
    """Dahl's friction, which builds up over a distance (T,)."""
    z = np.zeros(len(q))
    for i, d in enumerate(np.diff(q) / distance):
        z[i + 1] = np.clip(z[i] + d - abs(d) * z[i], -1.0, 1.0)
    return z


@pytest.mark.parametrize("noise", [0.5, 1.5])
def test_friction_that_builds_up_is_not_taken_for_what_imitates_it(axis_set, noise):
    study = open_study(load_set(axis_set(lambda q, v, a: built_up(q, 0.04), noise=noise)))
    assert study.named.chosen  # a spring or viscous friction follows most of it
    assert study.name()[0] == "unknown"


@pytest.mark.parametrize("cable", [4.0, 0.0])
def test_a_load_that_follows_another_joint_is_no_noise(cable):
    """Three joints; what is left on the first follows the third's position, as a cable along them makes it."""
    logs = []
    for k in range(3):
        rng = np.random.default_rng([100, k])
        t = np.arange(0.0, 8.0, 0.02)
        w = 2 * np.pi * np.array([[0.13, 0.31], [0.17, 0.37], [0.19, 0.41]])
        arg = t[:, None, None] * w + rng.uniform(0.0, 6.0, (3, 2))
        size = rng.uniform(0.2, 0.6, (3, 2))
        q, dq, ddq = (x.sum(axis=2) for x in (size * np.sin(arg), size * w * np.cos(arg), -size * w**2 * np.sin(arg)))
        y = 0.3 * rng.normal(size=(len(t), 3))
        y[:, 0] += cable * q[:, 2]
        motion = {"t": t, "dt": 0.02, "q": q, "dq": dq, "ddq": ddq, "slow": np.full(3, 1e-3)}
        load = {"rigid": ddq, "measured": ddq + y, "residual": y, "raw": ddq + y}
        logs.append(JointLog(name=f"e{k}", role="fit", cutoff=3.0, trim=5, **motion, **load))
    left = [log.shared(log.residual) for log in logs]
    found = leftover(logs, left, left, 0)
    if cable:
        assert found.kind == "other joint"
        assert "q3" in found.detail
        assert found.p_value < 1e-4
        assert found.energy > 0.8 * found.base
    else:
        assert found.p_value > 0.01
