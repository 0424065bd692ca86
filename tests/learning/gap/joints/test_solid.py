import numpy as np
import pytest
import yaml
from caretree.learning.gap.joints.payloads.solid import with_solid_body
from caretree.learning.gap.measurement import load_set
from caretree.learning.gap.open_study import open_study

pytest.importorskip("pinocchio")
ARM = """<robot name="two"><link name="base"/>
  <joint name="lift" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/>
    <limit lower="-3" upper="3" effort="99" velocity="9"/></joint>
  <link name="upper"><inertial><origin xyz="0.2 0 0"/><mass value="2"/>
    <inertia ixx="0.02" iyy="0.02" izz="0.02" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="bend" type="revolute"><parent link="upper"/><child link="lower"/><origin xyz="0.4 0 0"/>
    <axis xyz="0 1 0"/><limit lower="-3" upper="3" effort="99" velocity="9"/></joint>
  <link name="lower"><inertial><origin xyz="0.15 0 0"/><mass value="1"/>
    <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>"""


@pytest.fixture
def study(tmp_path):
    """An arm that carries 0.5 kg with an inertia of 0.02 kg m^2 about its own centre; its first joint is viscous."""
    import pinocchio as pin  # pyright: ignore[reportMissingImports] - lives in a cmeel prefix

    (tmp_path / "two.urdf").write_text(ARM)
    model = pin.buildModelFromUrdf(str(tmp_path / "two.urdf"))
    model.inertias[2] += pin.Inertia(0.5, np.array([0.3, 0.0, 0.0]), 0.02 * np.eye(3))
    data, t = model.createData(), np.arange(0.0, 8.0, 0.01)
    listed = []
    for k in range(3):
        rng = np.random.default_rng([9, k])
        w = 2 * np.pi * 0.2 * np.arange(1, 5)[:, None]
        size, phase = rng.normal(size=(4, 2)) * 0.3, rng.uniform(0.0, 6.0, (4, 2))
        arg = t[:, None, None] * w + phase
        q, v, a = (np.sin(arg) * size).sum(1), (np.cos(arg) * size * w).sum(1), (-np.sin(arg) * size * w**2).sum(1)
        load = np.array([pin.rnea(model, data, *x) for x in zip(q, v, a, strict=True)])
        load = load + v * [0.3, 0.0] + 0.02 * rng.normal(size=load.shape)
        names = "t,q1,q2,dq1,dq2,tau1,tau2"
        table = np.column_stack([t, q, v, load])
        np.savetxt(tmp_path / f"{k}.csv", table, delimiter=",", header=names, comments="")
        listed.append({"file": f"{k}.csv", "role": "heldout" if k == 2 else "fit"})
    (tmp_path / "measurement.yaml").write_text(
        yaml.safe_dump({"system": "arm", "robot": "two.urdf", "episodes": listed})
    )
    return open_study(load_set(tmp_path))


def with_body(study, *keys):
    """What could be left out of these effects beside the payload, as names."""
    search = study.named.search
    at = {b.key: i for i, b in enumerate(search.blocks)}
    chosen = tuple(at[k] for k in (("payload", "bend"), *keys))
    out = with_solid_body(search, chosen, study.model, study.fitted)
    return [{small.blocks[i].key for i in plain} for small, _, plain in out]


def test_what_a_bodys_own_inertia_does_is_no_other_effect(study):
    payload, rotor, rubbing = ("payload", "bend"), ("armature", "bend"), ("viscous_friction", "lift")
    assert with_body(study, rotor, rubbing) == [{payload, rubbing}]
    assert with_body(study, rubbing) == []  # that is no inertia
    assert with_body(study) == []


def test_the_plainer_set_is_told_and_told_once(study):
    named = {b.key for b in study.named.blocks}
    truth = {("payload", "bend"), ("viscous_friction", "lift")}
    told = [set(r.effects) for r in study.rivals()]
    assert named == truth or told.count(truth) == 1
    assert len({frozenset(s) for s in told}) == len(told)
    assert ("payload", "bend") in named
