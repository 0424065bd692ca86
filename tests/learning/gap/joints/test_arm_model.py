import numpy as np
import pytest
from caretree.learning.gap.errors import GapError
from caretree.learning.gap.joints.arm_model import ArmModel, find_urdf

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


def test_acceleration_undoes_load(arm):
    load = arm.load(Q, DQ, DDQ)
    assert np.allclose([arm.acceleration(*x) for x in zip(Q, DQ, load, strict=True)], DDQ)


def test_an_unknown_robot_is_told_with_names_that_exist(tmp_path):
    with pytest.raises(GapError, match="robot is 'r2d2', it must be a URDF file or a name in example-robot-data"):
        find_urdf("r2d2", tmp_path)
