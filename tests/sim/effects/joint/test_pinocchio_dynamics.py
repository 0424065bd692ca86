import numpy as np
import pinocchio as pin
import pytest
from caretree.sim.effects.effect import EffectError
from caretree.sim.effects.joint.pinocchio_dynamics import EffectArm
from caretree.sim.effects.model_file import EffectEntry, EffectModel

MODEL = pin.buildSampleModelManipulator()
JOINT, LAST = MODEL.names[2], MODEL.names[MODEL.njoints - 1]


def arm(*effects, system="arm"):
    entries = tuple(EffectEntry(name=n, target=t, parameters=p) for n, t, p in effects)
    return EffectArm(MODEL, EffectModel(system=system, base={}, recalibration=(), effects=entries))


def state(seed=0):
    rng = np.random.default_rng(seed)
    return pin.neutral(MODEL) + 0.3 * rng.normal(size=MODEL.nq), rng.normal(size=MODEL.nv), rng.normal(size=MODEL.nv)


@pytest.mark.parametrize(
    "effect",
    [
        ("viscous_friction", JOINT, {"coefficient": 3.0}),
        ("offset", JOINT, {"value": 2.0}),
        ("armature", JOINT, {"inertia": 0.5}),
        ("payload", LAST, {"mass": 1.5, "mass_com_x": 0.0, "mass_com_y": 0.1, "mass_com_z": 0.2}),
        ("base_tilt", "base", {"about_x": 0.2, "about_y": -0.1}),
        ("encoder_offset", JOINT, {"angle": 0.3}),
    ],
)
def test_forward_undoes_inverse(effect):
    q, dq, ddq = state()
    patched = arm(effect)
    load = patched.inverse(np.zeros(1), q[None], dq[None], ddq[None])[0]
    assert np.allclose(patched.forward(q, dq, load), ddq, atol=1e-6)


def test_an_effect_changes_its_own_joint():
    q, dq, ddq = state(1)
    plain, heavy = arm(), arm(("viscous_friction", JOINT, {"coefficient": 3.0}))
    change = (
        heavy.inverse(np.zeros(1), q[None], dq[None], ddq[None])
        - plain.inverse(np.zeros(1), q[None], dq[None], ddq[None])
    )[0]
    assert change[1] == pytest.approx(3.0 * dq[1])
    assert np.allclose(np.delete(change, 1), 0.0)


def test_an_encoder_that_reads_too_little_is_a_joint_farther_on():
    q, dq, ddq = state(2)
    read, there = arm(("encoder_offset", JOINT, {"angle": 0.3})), q + 0.3 * (np.arange(MODEL.nv) == 1)
    wanted = arm().inverse(np.zeros(1), there[None], dq[None], ddq[None])
    assert np.allclose(read.inverse(np.zeros(1), q[None], dq[None], ddq[None]), wanted)
    assert not np.allclose(wanted, arm().inverse(np.zeros(1), q[None], dq[None], ddq[None]))


def test_a_joint_that_does_not_exist_is_refused():
    with pytest.raises(EffectError, match="no joint 'tail'"):
        arm(("offset", "tail", {"value": 1.0}))
    with pytest.raises(EffectError, match="for system 'fall'"):
        arm(system="fall")
