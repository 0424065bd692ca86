"""One room with objects of every kind: what holds for them, by physics."""

import numpy as np
import pytest
from caretree.sim.bullet.world import BulletWorld
from caretree.sim.errors import CaretreeError
from caretree.sim.obj_file import write_obj
from caretree.sim.record.record import RunResult
from caretree.sim.record.recorder import Recorder
from caretree.sim.scene.objects import Box, MeshObject, Sheet, UrdfObject
from caretree.sim.world import GripperOpening, WorldError

URDF = """<robot name="stool"><link name="seat"><inertial><mass value="2"/>
<inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><box size="0.3 0.3 0.4"/></geometry></collision></link></robot>"""
WEIGHT = 0.5 * 9.81


@pytest.fixture(scope="module")
def room(tmp_path_factory):
    """A room without a gown, after two seconds, and what was recorded."""
    folder = tmp_path_factory.mktemp("room")
    half = 0.03
    cube = np.array([(x, y, z) for x in (-half, half) for y in (-half, half) for z in (-half, half)])
    faces = np.array([(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6)])
    write_obj(folder / "cube.obj", cube, np.vstack((faces, [(0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)])))
    (folder / "stool.urdf").write_text(URDF)
    world = BulletWorld(seed=100)
    world.remove_gown()
    world.add(UrdfObject(name="stool", file=folder / "stool.urdf", position_in_map=(1.8, 1.5, 0.2)))
    world.add(MeshObject(name="cube", file=folder / "cube.obj", position_in_map=(1.8, 1.5, 0.5), mass=0.2))
    world.add(Box(name="on_trunk", size=(0.12, 0.08, 0.03), position_in_map=(0, 0, 0.9), mass=0.5, stiffness=500.0))
    world.add(Sheet(name="towel", size=(0.3, 0.4), position_in_map=(0.0, 0.6, 0.9)))
    world.add(Sheet(name="hung", size=(0.2, 0.3), position_in_map=(2.7, 0.4, 1.5), hung_by=(0.5, 0.0)))
    recorder = Recorder(folder / "run", task="t", seed=100, world="bullet")
    world.attach_recorder(recorder, lambda error: pytest.fail(str(error)))
    world.clock.wait_until(2.0)
    recorder.finish(RunResult(outcome="success", reason="", sim_time_s=2.0))
    with np.load(folder / "run/truth.npz") as truth:
        yield world, {name: truth[name] for name in truth.files}
    world.close()


def test_things_come_to_rest_on_what_is_below_them(room):
    _, truth = room
    assert truth["object_cube"][-1, 2] == pytest.approx(0.43, abs=0.005)
    assert truth["object_stool"][-1, 2] == pytest.approx(0.2, abs=0.005)
    assert 0.60 < truth["object_towel"][-1, :, 2].min() < 0.65
    assert truth["object_hung"][-1, :, 2].max() == pytest.approx(1.5, abs=0.01)
    assert truth["object_towel_faces"].max() == truth["object_towel"].shape[1] - 1


def test_the_person_feels_their_weight(room):
    _, truth = room
    parts = list(truth["person_parts"])
    assert truth["person_force"][-1, parts.index("trunk")] == pytest.approx(WEIGHT, rel=0.05)
    assert 0.2 < truth["person_force"][-1, parts.index("legs")] < 0.2 * 9.81 + 0.3


def test_the_gown_is_gone(room):
    _, truth = room
    assert truth["vertices"].shape[1] == 0
    assert len(truth["neckline"]) == 0


def test_cameras_see_them(room):
    world, _ = room
    shown = world._draw().triangles()
    assert np.isclose(shown.vertices, truth_row(world, "towel")[0], atol=1e-3).all(axis=1).any()


def truth_row(world, name):
    return world.truth_frame().objects[name]


def test_nothing_is_added_once_the_run_has_begun(room):
    world, _ = room
    with pytest.raises(WorldError, match="the run has begun"):
        world.add(Box(name="late", size=(0.1, 0.1, 0.1), position_in_map=(2, 2, 1)))
    with pytest.raises(WorldError, match="before the run begins"):
        world.remove_gown()


@pytest.fixture
def held():
    """A bar held before the robot by an invisible hand, which the left fingers close on."""
    world = BulletWorld(seed=100)
    world.remove_gown()
    hand = world.observe().pose_hand_in_map[0]
    at = tuple(float(x) for x in hand[:3, 3] + 0.01 * hand[:3, 2])
    world.add(Box(name="ball", size=(0.03, 0.03, 0.03), position_in_map=at, mass=0.1))
    yield world
    world.close()


def test_fingers_take_a_rigid_object_feel_it_and_let_it_go(held):
    held.send(GripperOpening(side="left", opening=0.0))
    start = held.truth_frame().objects["ball"][2]
    pinned = held._client.createConstraint(
        held._objects.bodies["ball"],
        -1,
        -1,
        -1,
        held._client.JOINT_FIXED,
        (0, 0, 0),
        (0, 0, 0),
        held.truth_frame().objects["ball"][:3].tolist(),
    )
    held.clock.wait_until(1.5)
    held._client.removeConstraint(pinned)
    held.clock.wait_until(3.0)
    seen = held.observe()
    assert 0.02 < seen.gripper_opening[0] < 0.06
    assert seen.gripper_force[0] > 0.0
    assert held.truth_frame().objects["ball"][2] == pytest.approx(start, abs=0.02)
    assert seen.wrench_hand_in_map[0, 2] == pytest.approx(-0.98, abs=0.3)
    held.send(GripperOpening(side="left", opening=0.085))
    held.clock.wait_until(4.0)
    assert held.truth_frame().objects["ball"][2] < start - 0.2


def test_two_of_one_name_and_a_description_that_cannot_be_loaded_are_refused(held, tmp_path):
    with pytest.raises(CaretreeError, match="there is an object 'ball' already"):
        held.add(Box(name="ball", size=(0.1, 0.1, 0.1), position_in_map=(2, 2, 1)))
    (tmp_path / "bad.urdf").write_text("<robot")
    with pytest.raises(CaretreeError, match=r"PyBullet cannot load .*bad\.urdf"):
        held.add(UrdfObject(name="bad", file=tmp_path / "bad.urdf", position_in_map=(2, 2, 1)))
    with pytest.raises(WorldError, match="has taken the gown away"):
        held.set_initial_state("gown_in_hands")
