"""Dry friction with extra grip near standstill."""

import numpy as np
import pytest
from caretree.sim.effects.effect import JointMotion, Spread
from caretree.sim.effects.joint.stribeck_friction import StribeckFriction

VALUES = {"level": 2.0, "excess": 1.0, "speed": 0.1}  # [N m], [N m], [rad/s]


@pytest.mark.parametrize(("dq", "felt"), [(0.01, 2.99), (0.1, 2.0 + np.exp(-1.0)), (1.0, 2.0), (-1.0, -2.0)])
def test_grips_harder_near_standstill(dq, felt):
    motion = JointMotion.instant(q=0.0, dq=dq, slow=1e-4)
    assert StribeckFriction().load(motion, VALUES) == pytest.approx([felt], abs=1e-3)


def test_speeds_that_the_log_does_not_resolve_are_not_tried():
    tried = StribeckFriction().shapes(Spread(q=(-1.0, 1.0), speed=1.0, slow=0.1, dt=0.01))
    assert [shape["speed"] for shape in tried] == pytest.approx([0.3, 0.6])  # [rad/s]: above twice the slow speed
