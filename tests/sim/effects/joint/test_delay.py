"""A load that is recorded later than the motion."""

import numpy as np
import pytest
from caretree.sim.effects.effect import JointMotion
from caretree.sim.effects.joint.delay import Delay


def test_a_rising_load_that_is_read_late_is_read_low():
    t = np.arange(0.0, 1.0, 0.01)  # [s]
    rising = 4.0 * t  # [N m]
    motion = JointMotion(t=t, q=t, dq=t, ddq=t, load=rising, measured=rising)
    assert Delay().load(motion, {"time": 0.05}) == pytest.approx(np.full(100, -0.2))  # [N m]: 4 N m/s for 0.05 s


def test_a_sine_is_shifted_by_the_lag():
    t = np.arange(0.0, 2.0, 0.001)
    motion = JointMotion(t=t, q=t, dq=t, ddq=t, load=np.sin(t), measured=np.sin(t))
    late = np.sin(t) + Delay().load(motion, {"time": 0.02})
    assert late == pytest.approx(np.sin(t - 0.02), abs=5e-4)
