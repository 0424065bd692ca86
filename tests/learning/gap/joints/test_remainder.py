import numpy as np
import pytest
from caretree.learning.gap.joints.remainder import leftover
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
