"""An elastic pull towards a rest position."""

import pytest
from caretree.sim.effects.effect import EffectError, JointMotion
from caretree.sim.effects.joint.spring import Spring


def test_pulls_to_its_rest_position():
    rest, away = (
        Spring().load(JointMotion.instant(q=q, dq=0.0), {"stiffness": 5.0, "preload": 2.0}) for q in (0.4, 1.0)
    )
    assert rest == pytest.approx([0.0])  # [N m]: rest at preload / stiffness
    assert away == pytest.approx([3.0])


def test_does_not_push():
    with pytest.raises(EffectError, match="stiffness = -1"):
        Spring().check({"stiffness": -1.0, "preload": 0.0})
