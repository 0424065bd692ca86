"""Contact beyond a position."""

import numpy as np
import pytest
from caretree.sim.effects.effect import JointMotion
from caretree.sim.effects.joint.contact import Contact

T = np.arange(0.0, 4.0, 0.01)
MOTION = JointMotion(
    t=T, q=np.sin(T), dq=np.cos(T), ddq=-np.sin(T), load=2.0 * np.sin(T) + 1.0, measured=2.0 * np.sin(T) + 1.0
)


def test_contact_acts_beyond_its_threshold_only():
    load = Contact().load(MOTION, {"stiffness": 10.0, "threshold": 0.5, "side": 1.0})
    assert np.all(load[MOTION.q < 0.5] == 0.0)
    assert load.max() == pytest.approx(10.0 * 0.5, rel=1e-3)


def test_the_other_side_pushes_the_other_way():
    load = Contact().load(MOTION, {"stiffness": 10.0, "threshold": 0.5, "side": -1.0})
    assert np.all(load <= 0.0)
    assert load[0] == pytest.approx(-5.0)  # [N m]: at 0, half a radian below the threshold
