"""A constant in the measured load."""

import numpy as np
import pytest
from caretree.sim.effects.effect import JointMotion
from caretree.sim.effects.joint.offset import Offset


def test_is_the_same_whatever_the_joint_does():
    motion = JointMotion(
        t=np.arange(3.0),
        q=np.arange(3.0),
        dq=np.array((-1.0, 0.0, 4.0)),
        ddq=np.ones(3),
        load=np.ones(3),
        measured=np.ones(3),
    )
    assert Offset().load(motion, {"value": -0.7}) == pytest.approx([-0.7, -0.7, -0.7])  # [N m]
