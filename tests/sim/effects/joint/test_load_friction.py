"""Friction that grows with the load carried."""

import pytest
from caretree.sim.effects.effect import JointMotion
from caretree.sim.effects.joint.load_friction import LoadFriction


@pytest.mark.parametrize(
    ("load", "dq", "felt"), [(10.0, 1.0, 2.0), (-10.0, 1.0, 2.0), (10.0, -1.0, -2.0), (0.0, 1.0, 0.0)]
)
def test_grows_with_what_is_carried_and_opposes_the_motion(load, dq, felt):
    motion = JointMotion.instant(q=0.0, dq=dq, load=load)
    assert LoadFriction().load(motion, {"ratio": 0.2}) == pytest.approx([felt])  # [N m]
