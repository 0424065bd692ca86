import numpy as np
import pytest
from caretree.sim.effects.effect import EffectError, JointMotion, Spread
from caretree.sim.effects.joint.joint_registry import JOINT_EFFECTS

T = np.arange(0.0, 4.0, 0.01)
MOTION = JointMotion(
    t=T, q=np.sin(T), dq=np.cos(T), ddq=-np.sin(T), load=2.0 * np.sin(T) + 1.0, measured=2.0 * np.sin(T) + 1.0
)
SPREAD = Spread(q=(-1.0, 1.0), speed=1.0, slow=1e-3, dt=0.01)


@pytest.mark.parametrize("effect", JOINT_EFFECTS.values(), ids=JOINT_EFFECTS)
def test_the_load_is_linear_in_the_linear_parameters(effect):
    for shape in effect.shapes(SPREAD):
        one = {p.name: 0.1 for p in effect.linear} | shape
        two = {p.name: 0.2 for p in effect.linear} | shape
        assert np.allclose(2.0 * effect.load(MOTION, one), effect.load(MOTION, two))
        assert effect.columns(MOTION, shape).shape == (len(T), len(effect.linear))


@pytest.mark.parametrize("effect", JOINT_EFFECTS.values(), ids=JOINT_EFFECTS)
def test_friction_takes_power_and_never_gives_it(effect):
    if "friction" not in effect.name:
        pytest.skip("not a friction")
    values = {p.name: 0.3 for p in effect.linear} | effect.shapes(SPREAD)[0]
    assert np.all(effect.load(MOTION, values) * MOTION.dq >= -1e-12)


def test_values_outside_the_bounds_are_refused_with_the_bounds():
    with pytest.raises(EffectError, match=r"coefficient = -1 is outside 0 to inf"):
        JOINT_EFFECTS["viscous_friction"].check({"coefficient": -1.0})
    with pytest.raises(EffectError, match=r"it takes \['coefficient'\]"):
        JOINT_EFFECTS["viscous_friction"].check({"size": 1.0})
