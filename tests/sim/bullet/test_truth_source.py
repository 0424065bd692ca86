"""What the recorder is given: the world's own bodies, with the peaks of the contact's forces."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from caretree.sim.bullet.contact import Contact
from caretree.sim.bullet.grip import Grip
from caretree.sim.bullet.person import Person
from caretree.sim.bullet.truth_source import TruthSource
from caretree.sim.bullet_client import direct_client
from caretree.sim.mechanics.capsules import RobotCapsules
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.robot.body import RobotBody
from caretree.sim.scene.person_spec import PERSON_PARTS
from caretree.sim.scene.scene import BED_TOP, draw_scene
from caretree.sim.world import SIDES

ABOVE = np.array((0.0, 0.0, 2.0))  # the gown hangs in the air


@pytest.fixture(scope="module")
def source():
    """A scene without cloth, and the robot in a client of its own."""
    scene, room, client = draw_scene(101), direct_client(), direct_client()
    person = Person(room, scene.person, BED_TOP, scene.bed_xy)
    hook = SimpleNamespace(load=lambda vertices: np.array((0.0, 0.0, -9.81 * scene.gown.mass)))
    capsules = RobotCapsules(kinematics_of(BAXTER))
    grips = [Grip(room, side, SimpleNamespace(load=np.zeros(3)), SimpleNamespace(), person) for side in SIDES]
    contact = Contact(capsules, person, 0.005, 0.0025)
    robot = RobotBody(client, np.array((2.0, 0.5, 1.0)))
    yield SimpleNamespace(
        source=TruthSource(scene, capsules, person, hook, grips, contact),
        scene=scene,
        grips=grips,
        contact=contact,
        robot=robot,
        vertices=scene.mesh.vertices + ABOVE,
    )
    room.disconnect()
    client.disconnect()


def test_the_frame_fits_what_stays_the_same(source):
    static = source.source.static()
    frame = source.source.frame(0.0, source.vertices, source.robot)
    assert frame.row_type(static)["person_force"].shape == (len(PERSON_PARTS),)
    assert len(static.robot_capsule_names) == len(frame.robot_capsules)
    assert frame.holds_arm.tolist() == [-1, -1]
    hand = source.robot.pose_hand_in_map("left")
    assert frame.gripper_pose[0, :3] == pytest.approx(hand[:3, 3])


def test_the_force_on_a_part_is_the_grip_and_the_peak_of_the_contact(source):
    part = PERSON_PARTS.index("left_forearm")
    before = source.source.frame(0.1, source.vertices, source.robot).person_force
    grip = source.grips[1]
    grip.kind, grip.part, grip.arm = "arm", part, 0
    grip.handle.load = np.array((0.0, 3.0, -4.0))
    source.contact.part_peak[part] = 20.0
    frame = source.source.frame(0.2, source.vertices, source.robot)
    assert frame.person_force[part] - before[part] == pytest.approx(25.0)
    assert frame.holds_arm.tolist() == [-1, 0]
    assert not frame.gripper_closed.any()
