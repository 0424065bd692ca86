"""Dry friction of constant size."""

import numpy as np
import pytest
from caretree.sim.effects.effect import EffectError, JointMotion
from caretree.sim.effects.joint.coulomb_friction import CoulombFriction

MOTION = JointMotion(
    t=np.arange(3.0),
    q=np.zeros(3),
    dq=np.array([-0.01, 0.01, 5.0]),
    ddq=np.zeros(3),
    load=np.zeros(3),
    measured=np.zeros(3),
    slow=1e-6,
)


def test_is_as_large_at_any_speed():
    effect = CoulombFriction()
    effect.check({"level": 2.0})
    assert effect.load(MOTION, {"level": 2.0}) == pytest.approx([-2.0, 2.0, 2.0])  # [N m]


def test_winds_up_within_its_width():
    load = CoulombFriction().load(MOTION, {"level": 2.0, "width": 1.0})
    assert load == pytest.approx([-0.04, 0.04, 2.0], abs=1e-4)


def test_a_width_below_zero_is_refused():
    with pytest.raises(EffectError, match="width = -1"):
        CoulombFriction().check({"level": 2.0, "width": -1.0})
