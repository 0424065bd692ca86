"""Parts of a URDF are found, and carry the names that they are given."""

import pytest
from caretree.sim.robot.urdf_parts import UrdfParts, description
from caretree.sim.world import WorldError


def test_a_description_is_found_or_named_as_missing():
    assert description("ur5_robot.urdf").exists()
    with pytest.raises(WorldError, match=r"the robot needs hal9000\.urdf of the Python package example-robot-data"):
        description("hal9000.urdf")


def test_a_joint_of_another_robot_gets_a_prefix_and_leaves_the_source_alone():
    source = UrdfParts("source")
    source.joint("pan", "fixed", "one", "two")
    given = source.robot.find("joint")
    assert given is not None
    parts = UrdfParts("ours")
    parts.given_joint(given, "left_")
    text = parts.text()
    assert 'name="left_pan"' in text
    assert 'link="left_one"' in text
    assert 'link="left_two"' in text
    assert given.get("name") == "pan"
