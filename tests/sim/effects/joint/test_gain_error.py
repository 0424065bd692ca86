"""A wrong scale of the measured load."""

import pytest
from caretree.sim.effects.effect import EffectError, JointMotion
from caretree.sim.effects.joint.gain_error import GainError


def test_the_reading_is_a_share_too_large():
    effect = GainError()
    motion = JointMotion.instant(q=0.0, dq=0.0, load=-8.0)
    assert motion.load + effect.load(motion, {"fraction": 0.25}) == pytest.approx([-10.0])  # [N m]


def test_a_sensor_that_reads_nothing_is_no_gain_error():
    with pytest.raises(EffectError, match=r"outside -0\.95"):
        GainError().check({"fraction": -1.0})
