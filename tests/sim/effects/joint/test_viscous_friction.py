"""Friction of oil."""

import pytest
from caretree.sim.effects.effect import JointMotion
from caretree.sim.effects.joint.viscous_friction import ViscousFriction


def test_is_in_proportion_to_speed():
    slow, back = (ViscousFriction().load(JointMotion.instant(q=0.0, dq=dq), {"coefficient": 3.0}) for dq in (0.5, -2.0))
    assert slow == pytest.approx([1.5])  # [N m]
    assert back == pytest.approx([-6.0])


def test_stands_still_without_a_load():
    assert ViscousFriction().load(JointMotion.instant(q=1.0, dq=0.0), {"coefficient": 3.0}) == pytest.approx([0.0])
