"""Dry friction that differs between the two directions."""

import numpy as np
import pytest
from caretree.sim.effects.effect import EffectError, JointMotion
from caretree.sim.effects.joint.asymmetric_friction import AsymmetricFriction

MOTION = JointMotion(
    t=np.arange(3.0),
    q=np.zeros(3),
    dq=np.array([-0.01, 0.01, 5.0]),
    ddq=np.zeros(3),
    load=np.zeros(3),
    measured=np.zeros(3),
    slow=1e-6,
)


def test_each_direction_has_its_own_size():
    effect, values = AsymmetricFriction(), {"forward": 2.0, "backward": 3.0}
    effect.check(values)
    assert effect.load(MOTION, values) == pytest.approx([-3.0, 2.0, 2.0])  # [N m]


def test_winds_up_within_its_width():
    load = AsymmetricFriction().load(MOTION, {"forward": 2.0, "backward": 2.0, "width": 1.0})
    assert load == pytest.approx([-0.04, 0.04, 2.0], abs=1e-4)


def test_a_width_below_zero_is_refused():
    with pytest.raises(EffectError, match="width = -1"):
        AsymmetricFriction().check({"forward": 2.0, "backward": 2.0, "width": -1.0})
