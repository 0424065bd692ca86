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


def test_contact_acts_beyond_its_threshold_only():
    load = JOINT_EFFECTS["contact"].load(MOTION, {"stiffness": 10.0, "threshold": 0.5, "side": 1.0})
    assert np.all(load[MOTION.q < 0.5] == 0.0)
    assert load.max() == pytest.approx(10.0 * 0.5, rel=1e-3)


def test_backlash_starts_at_a_reversal_and_ends_after_the_gap():
    load = JOINT_EFFECTS["backlash"].load(MOTION, {"fraction": 1.0, "width": 0.1})
    free = np.abs(load) > 0.5 * np.abs(MOTION.load)
    turn = np.argmax(MOTION.q)
    assert not free[: turn - 5].any()
    assert free[turn + 5]
    assert not free[np.flatnonzero((T[turn] < T) & (MOTION.q < 0.8))].any() or MOTION.q[free].min() < -0.8


def test_the_width_of_dry_friction_may_be_left_out():
    motion = JointMotion(
        t=np.arange(3.0),
        q=np.zeros(3),
        dq=np.array([-0.01, 0.01, 5.0]),
        ddq=np.zeros(3),
        load=np.zeros(3),
        measured=np.zeros(3),
        slow=1e-6,
    )
    both = {"coulomb_friction": {"level": 2.0}, "asymmetric_friction": {"forward": 2.0, "backward": 2.0}}
    for name, values in both.items():
        effect = JOINT_EFFECTS[name]
        effect.check(values)
        assert effect.load(motion, values) == pytest.approx([-2.0, 2.0, 2.0])
        assert effect.load(motion, {**values, "width": 1.0}) == pytest.approx([-0.04, 0.04, 2.0], abs=1e-4)
        with pytest.raises(EffectError, match="width = -1"):
            effect.check({**values, "width": -1.0})
