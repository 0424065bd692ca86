import json
import xml.etree.ElementTree as ET

import numpy as np
import pytest
import yaml
from caretree.learning.gap.errors import GapError
from caretree.learning.gap.export import export
from caretree.sim.effects.joint.link_inertia import with_point_mass

from caretree.gap import Effect, Parameter, write_robot_file

from .own.slider import Slider

URDF = """<robot name="two"><!-- as drawn -->
<link name="base"/>
<link name="upper"><inertial><origin xyz="0.1 0 0" rpy="0 0 0.4"/><mass value="2.0"/>
  <inertia ixx="0.02" ixy="0.001" ixz="0" iyy="0.03" iyz="0" izz="0.04"/></inertial></link>
<joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/>
  <limit lower="-1" upper="1" effort="10" velocity="1"/><dynamics damping="0.5"/></joint>
</robot>"""
MJCF = """<mujoco><worldbody><body name="rod"><joint name="hinge" type="hinge" damping="0.1"/>
<geom type="capsule" size="0.02 0.2"/><body name="tip"><inertial pos="0 0 0" mass="0.1" diaginertia="1e-5 1e-5 1e-5"/>
</body></body></worldbody></mujoco>"""


def entry(name, target, **parameters):
    return {"name": name, "target": target, "parameters": parameters}


def written(tmp_path, text, effects, recalibration=(), own=None, **base):
    (tmp_path / "robot.xml").write_text(text)
    content = {"format": "caretree-model-1", "system": "arm", "effects": effects, "recalibration": list(recalibration)}
    (tmp_path / "model.yaml").write_text(yaml.safe_dump(content | base))
    left = write_robot_file(tmp_path / "model.yaml", tmp_path / "robot.xml", tmp_path / "out.xml", own)
    return ET.parse(tmp_path / "out.xml").getroot(), left, (tmp_path / "out.xml").read_text()


def test_friction_is_added_to_what_a_urdf_says_and_the_rest_is_named(tmp_path):
    effects = [
        entry("viscous_friction", "shoulder", coefficient=0.25),
        entry("coulomb_friction", "shoulder", level=1.5, width=0.1),
        entry("armature", "shoulder", inertia=0.02),
        entry("offset", "shoulder", value=0.3),
    ]
    root, left, text = written(tmp_path, URDF, effects)
    dynamics = root.find("joint/dynamics")
    assert (float(dynamics.get("damping")), float(dynamics.get("friction"))) == (0.75, 1.5)
    assert left == ["offset on shoulder", "armature of shoulder"]
    assert "as drawn" in text


def test_the_robot_of_a_model_is_looked_for_in_the_folder_of_its_set_too(tmp_path):
    of_set, results = tmp_path / "set", tmp_path / "out"
    of_set.mkdir(), results.mkdir()
    content = {"format": "caretree-model-1", "system": "arm", "recalibration": [], "robot": "own.urdf"}
    effects = [entry("viscous_friction", "shoulder", coefficient=0.25)]
    (results / "model.yaml").write_text(yaml.safe_dump(content | {"effects": effects}))
    with pytest.raises(GapError, match=r"no URDF file own\.urdf"):
        export(results, None, tmp_path / "new.urdf")
    (of_set / "own.urdf").write_text(URDF)
    (results / "find.json").write_text(json.dumps({"set": str(of_set)}))
    assert export(results, None, tmp_path / "new.urdf") == []
    assert float(ET.parse(tmp_path / "new.urdf").getroot().find("joint/dynamics").get("damping")) == 0.75


def test_a_payload_in_a_urdf_is_what_pinocchio_makes_of_it(tmp_path):
    pin = pytest.importorskip("pinocchio")
    moment = {"mass": 0.5, "mass_com_x": 0.1, "mass_com_y": -0.05, "mass_com_z": 0.02}
    written(tmp_path, URDF, [entry("payload", "shoulder", **moment)])
    asked = with_point_mass(pin.buildModelFromXML(URDF), "shoulder", moment).inertias[1]
    made = pin.buildModelFromUrdf(str(tmp_path / "out.xml")).inertias[1]
    np.testing.assert_allclose(made.toDynamicParameters(), asked.toDynamicParameters(), atol=1e-7)


def test_a_wrong_link_mass_keeps_its_shape(tmp_path):
    root, left, _ = written(tmp_path, URDF, [], [entry("mass", "shoulder", mass=0.2)])
    assert left == []
    assert float(root.find("link/inertial/mass").get("value")) == pytest.approx(2.2)
    assert float(root.find("link/inertial/inertia").get("izz")) == pytest.approx(0.044)


def test_an_mjcf_says_armature_too_and_a_users_effects_what_they_export(tmp_path):
    class Rod(Slider):
        name = "rod"
        effects = tuple(
            Effect(name=n, target=t, exports=x, parameters=(Parameter(name="rate", unit="1"),))
            for n, t, x in (("rotor", "hinge", "armature"), ("load", "tip", "mass"), ("haze", "sky", ""))
        )

    effects = [entry("rotor", "hinge", rate=0.03), entry("load", "tip", rate=0.05), entry("haze", "sky", rate=1.0)]
    root, left, _ = written(tmp_path, MJCF, effects, own=Rod(), system="rod", simulator="rod.py:Rod")
    joint = next(root.iter("joint"))
    assert (joint.get("armature"), joint.get("damping")) == ("0.03", "0.1")
    assert float(next(root.iter("inertial")).get("mass")) == pytest.approx(0.15)
    assert left == ["haze on sky"]


@pytest.mark.parametrize(
    ("text", "effect", "says"),
    [
        ("<robot", entry("armature", "a", inertia=0.1), "no XML"),
        ("<sdf/>", entry("armature", "a", inertia=0.1), "its root is <sdf>"),
        (URDF, entry("viscous_friction", "elbow", coefficient=1.0), "no joint named 'elbow' .there are shoulder"),
        (
            URDF.replace('"0.5"', '"half"'),
            entry("viscous_friction", "shoulder", coefficient=1.0),
            "'half' is no number",
        ),
        (
            URDF,
            entry("wrong_tool", "shoulder", mass=-2.5, mass_com_x=0.0, mass_com_y=0.0, mass_com_z=0.0),
            "cannot be taken",
        ),
    ],
)
def test_a_file_that_does_not_fit_is_one_sentence(tmp_path, text, effect, says):
    with pytest.raises(GapError, match=says):
        written(tmp_path, text, [effect])
