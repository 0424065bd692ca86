"""The inertia of a rotor behind its gear."""

import numpy as np
import pytest
from caretree.sim.effects.effect import JointMotion
from caretree.sim.effects.joint.armature import Armature


def test_resists_acceleration_alone():
    motion = JointMotion(
        t=np.arange(2.0), q=np.ones(2), dq=np.ones(2), ddq=np.array((2.0, -4.0)), load=np.ones(2), measured=np.ones(2)
    )
    assert Armature().load(motion, {"inertia": 0.5}) == pytest.approx([1.0, -2.0])  # [N m]
