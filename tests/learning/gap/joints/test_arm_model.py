from dataclasses import replace

import numpy as np
import pytest
from caretree.learning.gap.errors import GapError
from caretree.learning.gap.joints.arm_model import ArmModel
from caretree.learning.gap.joints.robot_files import find_urdf, robots_folder

pytest.importorskip("pinocchio")
Q, DQ, DDQ = (np.random.default_rng(k).uniform(-1.0, 1.0, (5, 6)) for k in range(3))


@pytest.fixture(scope="module")
def arm(tmp_path_factory):
    return ArmModel.from_urdf(find_urdf("ur10", tmp_path_factory.mktemp("set")), 6)


def test_a_rotors_inertia_loads_its_own_joint_alone(arm):
    change = arm.with_armature(2, 0.5).load(Q, DQ, DDQ) - arm.load(Q, DQ, DDQ)
    assert np.allclose(change, 0.5 * DDQ * (np.arange(6) == 2))


@pytest.mark.parametrize(("name", "values"), [("mass", {"mass": 0.7}), ("payload", {"mass": 0.7, "mass_com_z": 0.05})])
def test_a_changed_body_loads_the_joints_as_its_columns_say(arm, name, values):
    term = [t for t in arm.body_terms() if t.name == name][-1]
    columns = arm.body_columns(term, Q, DQ, DDQ)
    wanted = columns @ np.array([values.get(p.name, 0.0) for p in term.parameters])
    change = arm.patched(term, values).load(Q, DQ, DDQ) - arm.load(Q, DQ, DDQ)
    assert np.allclose(change, wanted, atol=0.02 * np.abs(wanted).max())  # a payload's own inertia is left out
    assert np.abs(wanted).max() > 0.1


@pytest.mark.parametrize("exact", [False, True])
def test_a_tilt_and_a_zero_load_the_joints_as_their_columns_say(arm, exact):
    for term in arm.geometry_terms():
        values = {p.name: 0.2 * (-1.0) ** k for k, p in enumerate(term.parameters)}
        at = replace(term, shape=values) if exact else term
        wanted = arm.body_columns(at, Q, DQ, DDQ) @ np.array(list(values.values()))
        change = arm.patched(term, values).load(Q, DQ, DDQ) - arm.load(Q, DQ, DDQ)
        assert np.allclose(change, wanted, atol=(1e-6 if exact else 0.3) * max(np.abs(change).max(), 1e-6))
        # a turn about an upright axis changes nothing
        assert (np.abs(change).max() < 1e-9) == (term.target == "shoulder_pan_joint")


def test_without_gravity_nobody_knows_how_an_arm_stands(tmp_path_factory):
    urdf = find_urdf("ur10", tmp_path_factory.mktemp("set"))
    assert ArmModel.from_urdf(urdf, 6, gravity=(0.0, 0.0, 0.0)).geometry_terms() == []


def test_acceleration_undoes_load(arm):
    load = arm.load(Q, DQ, DDQ)
    assert np.allclose([arm.acceleration(*x) for x in zip(Q, DQ, load, strict=True)], DDQ)


PENDULUM = """<robot name="pendulum">
  <link name="base"/>
  <joint name="swing" type="revolute">
    <parent link="base"/><child link="rod"/><axis xyz="0 1 0"/>
    <limit lower="-3" upper="3" effort="9" velocity="9"/>
  </joint>
  <link name="rod"><inertial><origin xyz="0.2 0 0"/><mass value="1"/>
    <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
</robot>"""


def test_a_robot_of_one_joint_has_columns_too(tmp_path):
    (tmp_path / "pendulum.urdf").write_text(PENDULUM)
    one = ArmModel.from_urdf(tmp_path / "pendulum.urdf", 1)
    motion = Q[:, :1], DQ[:, :1], DDQ[:, :1]
    for term in one.body_terms():
        columns = one.body_columns(term, *motion)
        assert columns.shape == (len(Q), 1, len(term.parameters))
        change = one.patched(term, {term.parameters[0].name: 0.5}).load(*motion) - one.load(*motion)
        assert np.allclose(change, 0.5 * columns[:, :, 0], rtol=0.1)


def families():
    """URDF files of example-robot-data that hold a robot, and how pinocchio is to read them."""
    return sorted(p for p in robots_folder().rglob("*.urdf") if p.stem != "ur3")


@pytest.mark.parametrize("urdf", families(), ids=lambda p: f"{p.parts[-3]}/{p.stem}")
def test_every_robot_of_example_robot_data_works_or_says_why(urdf):
    import pinocchio as pin  # pyright: ignore[reportMissingImports] - lives in a cmeel prefix

    full = pin.buildModelFromUrdf(str(urdf))
    movable = sum(j.nv == 1 for j in full.joints[1:])
    if movable == 0:
        with pytest.raises(GapError, match="has no joint that moves"):
            ArmModel.from_urdf(urdf, 1)
        return
    for n in sorted({1, min(6, movable), max(1, movable - 1), movable}):
        arm = ArmModel.from_urdf(urdf, n)
        q, dq, ddq = (np.random.default_rng([100, k]).uniform(-0.5, 0.5, (2, n)) for k in range(3))
        load = arm.load(q, dq, ddq)
        assert load.shape == (2, n)
        assert np.isfinite(load).all()
        assert np.abs(load).max() > 0.0
    assert all(np.isfinite(arm.body_columns(t, q[:1], dq[:1], ddq[:1])).all() for t in arm.body_terms())


def test_a_robot_without_a_moving_joint_is_one_sentence():
    with pytest.raises(GapError, match="has no joint that moves"):
        ArmModel.from_urdf(find_urdf("iris_simple", robots_folder()), 1)
