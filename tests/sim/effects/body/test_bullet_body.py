"""What the effects of a model file do to a PyBullet body is what their formulas say."""

import numpy as np
import pytest
from caretree.sim.bullet_client import direct_client
from caretree.sim.effects.body.bullet_body import EffectBody
from caretree.sim.effects.effect import EffectError
from caretree.sim.effects.model_file import load_model, save_model

STEP = 1e-3  # [s]
MASS, INERTIA = 2.0, 0.5  # of the moved link [kg], [kg m^2] about the joint's axis
URDF = """<robot name="one">
<link name="base"><inertial><mass value="1"/>
<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
<link name="tip"><inertial><mass value="{mass}"/>
<inertia ixx="{inertia}" ixy="0" ixz="0" iyy="{inertia}" iyz="0" izz="{inertia}"/></inertial></link>
<joint name="{name}" type="{kind}"><parent link="base"/><child link="tip"/><axis xyz="0 0 1"/>
<limit lower="-100" upper="100" effort="100" velocity="100"/></joint></robot>"""


@pytest.fixture
def client():
    found = direct_client()
    found.setTimeStep(STEP)
    yield found
    found.disconnect()


def model(tmp_path, system, *effects):
    entries = [{"name": name, "target": target, "parameters": values} for name, target, values in effects]
    save_model(tmp_path / "model.yaml", {"system": system, "recalibration": [], "effects": entries})
    return load_model(tmp_path / "model.yaml")


def one_joint(client, tmp_path, kind, name="slide"):
    (tmp_path / "one.urdf").write_text(URDF.format(mass=MASS, inertia=INERTIA, kind=kind, name=name))
    body = client.loadURDF(str(tmp_path / "one.urdf"), useFixedBase=1, flags=client.URDF_USE_INERTIA_FROM_FILE)
    client.setJointMotorControl2(body, 0, client.VELOCITY_CONTROL, force=0)
    client.changeDynamics(body, 0, linearDamping=0, angularDamping=0, jointDamping=0)
    client.resetJointState(body, 0, 0.0, 1.0)
    return body


def speed_after(client, body, effects, seconds):
    patch = EffectBody(client, body, effects)
    for _ in range(round(seconds / STEP)):
        patch.apply()
        client.stepSimulation()
    return client.getJointState(body, 0)[1]


def test_viscous_friction_slows_an_axis_exponentially(client, tmp_path):
    body = one_joint(client, tmp_path, "prismatic")
    effects = model(tmp_path, "axis", ("viscous_friction", "axis", {"coefficient": 3.0}))
    assert speed_after(client, body, effects, 0.5) == pytest.approx(np.exp(-3.0 * 0.5 / MASS), rel=2e-3)


def test_dry_friction_slows_a_joint_evenly(client, tmp_path):
    body = one_joint(client, tmp_path, "revolute", name="elbow")
    effects = model(tmp_path, "arm", ("coulomb_friction", "elbow", {"level": 0.4}))
    assert speed_after(client, body, effects, 0.5) == pytest.approx(1.0 - 0.4 * 0.5 / INERTIA, rel=2e-3)


def test_quadratic_drag_ends_in_the_terminal_speed(client, tmp_path):
    client.setGravity(0, 0, -9.81)
    ball = client.createMultiBody(0.3, client.createCollisionShape(client.GEOM_SPHERE, radius=0.05))
    client.changeDynamics(ball, -1, linearDamping=0)
    patch = EffectBody(client, ball, model(tmp_path, "fall", ("quadratic_drag", "", {"coefficient": 2.0})))
    for _ in range(2000):
        patch.apply()
        client.stepSimulation()
    assert client.getBaseVelocity(ball)[0][2] == pytest.approx(-np.sqrt(9.81 / 2.0), rel=1e-3)


def test_a_joint_or_a_system_that_is_not_there_is_one_sentence(client, tmp_path):
    body = one_joint(client, tmp_path, "revolute", name="elbow")
    with pytest.raises(EffectError, match="the body has no joint 'knee', it has elbow"):
        EffectBody(client, body, model(tmp_path, "arm", ("offset", "knee", {"value": 1.0})))
    with pytest.raises(EffectError, match="for system 'cloth', a PyBullet body takes arm, axis or fall"):
        EffectBody(client, body, model(tmp_path, "cloth", ("air_drag", "cloth", {"coefficient": 1.0})))
