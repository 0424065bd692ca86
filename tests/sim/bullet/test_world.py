"""The simulated room behind the World contract."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from caretree.sim.abilities import (
    HasKinematics,
    HasTiming,
    SupportsFaults,
    SupportsInitialStates,
    SupportsRecording,
)
from caretree.sim.bullet.soft_world import GRAVITY
from caretree.sim.bullet.watchers import Watchers
from caretree.sim.bullet.world import BulletWorld
from caretree.sim.errors import CaretreeError, RecordError
from caretree.sim.evaluate.coverage import coverage
from caretree.sim.evaluate.crossings import sleeve
from caretree.sim.record.recorded_state import RecordedState
from caretree.sim.robot import model
from caretree.sim.scene.person_spec import PERSON_PARTS
from caretree.sim.world import CAMERAS, SIDES, BaseVelocity, GripperOpening, HandTwist, SensorLost, WorldError


@pytest.fixture(scope="module")
def world():
    """A room whose gown hangs on the rail."""
    world = BulletWorld(seed=1)
    yield world
    world.close()


def test_the_gown_hangs_on_its_hook_with_its_weight(world):
    load = world._hook.load(world._cloth.vertices())
    assert load[2] == pytest.approx(-world.scene.gown.mass * GRAVITY, rel=0.25)  # it still swings a little
    frame = world.truth_frame()
    assert frame.vertices[world.scene.hang_vertex] == pytest.approx((*world.scene.rail_xy, 1.55), abs=0.03)
    assert frame.vertices[:, 2].min() > 0.03
    assert not frame.gripper_closed.any()


@pytest.mark.parametrize(
    "ability", [HasKinematics, HasTiming, SupportsFaults, SupportsInitialStates, SupportsRecording]
)
def test_the_simulated_room_has_every_ability(world, ability):
    assert isinstance(world, ability)


def test_what_the_robot_senses_has_the_contract_shapes(world):
    seen = world.observe()
    assert seen.arm_positions.shape == seen.arm_velocities.shape == seen.arm_efforts.shape == (2, 7)
    assert seen.wrench_hand_in_map.shape == (2, 6)
    assert seen.pose_hand_in_map.shape == (2, 4, 4)
    assert np.abs(seen.wrench_hand_in_map[:, :3]).max() < 0.5  # empty hands feel noise only
    assert np.any(seen.wrench_hand_in_map != world.observe().wrench_hand_in_map)


@pytest.mark.parametrize("camera", CAMERAS)
def test_cameras_see_the_room(world, camera):
    frame = world.look(camera)
    assert frame.rgb.shape[:2] == frame.depth.shape
    assert frame.depth.dtype == np.float32
    assert (frame.depth > 0).mean() > 0.5


def test_an_unknown_camera_is_lost(world):
    with pytest.raises(SensorLost, match="left_hand"):
        world.look("rear")


def test_the_base_drives_and_stops(world):
    before = world.observe().pose_base_in_map
    world.send(BaseVelocity(velocity=np.array((0.3, 0.0, 0.0)), duration=0.5))
    world.clock.wait_until(world.clock.now() + 0.5)
    world.stop()
    world.clock.wait_until(world.clock.now() + 0.5)
    seen = world.observe()
    assert 0.03 < np.linalg.norm(seen.pose_base_in_map[:2] - before[:2]) < 0.3
    assert np.abs(seen.twist_base).max() < 0.01


def test_fingers_that_close_on_air_hold_nothing(world):
    world.send(GripperOpening(side="left", opening=0.0, force_limit=20.0))
    world.clock.wait_until(world.clock.now() + 1.0)
    assert world.observe().gripper_opening[0] < 0.01
    assert not world.truth_frame().gripper_closed.any()


def test_fingers_that_meet_more_than_their_force_stall(world, monkeypatch):
    world.send(GripperOpening(side="right", opening=0.08, force_limit=20.0))
    world.clock.wait_until(world.clock.now() + 0.8)
    monkeypatch.setattr(world._contact, "squeeze", lambda hands: np.array((0.0, 25.0)))
    world.send(GripperOpening(side="right", opening=0.0, force_limit=20.0))
    world.clock.wait_until(world.clock.now() + 0.5)
    seen = world.observe()
    assert seen.gripper_opening[1] > 0.07
    assert seen.gripper_force[1] == pytest.approx(25.0)
    world.send(GripperOpening(side="right", opening=0.0, force_limit=30.0))
    world.clock.wait_until(world.clock.now() + 1.0)
    assert world.observe().gripper_opening[1] < 0.01  # more force closes them


def test_a_moving_person_swings_both_arms_outwards_by_fifteen_degrees(world):
    def headings():
        way = world.truth_frame().arms[:, 1] - world.truth_frame().arms[:, 0]
        return np.arctan2((-way[0, 0], way[1, 0]), way[:, 1])  # away from the body

    before = headings()
    world.fault_move_person()
    world.clock.wait_until(world.clock.now() + 0.3)
    assert np.rad2deg(headings() - before) == pytest.approx(np.full(2, 7.5), abs=1.5)
    world.clock.wait_until(world.clock.now() + 0.5)
    assert np.rad2deg(headings() - before) == pytest.approx(np.full(2, 15.0), abs=2.0)
    world.clock.wait_until(world.clock.now() + 0.5)
    assert np.rad2deg(headings() - before) == pytest.approx(np.full(2, 15.0), abs=2.0), "then they rest"


def test_parts_of_the_person_are_named(world):
    assert world.truth_frame().person_force.shape == (len(PERSON_PARTS),)


@pytest.mark.parametrize(("arguments", "says"), [({"gown": "tutu"}, "tutu"), ({"model": "x.yaml"}, "x.yaml")])
def test_bad_arguments_are_one_sentence(arguments, says):
    with pytest.raises(CaretreeError, match=says):
        BulletWorld(seed=0, **arguments)


@pytest.mark.parametrize("fails", ["frame", "picture", "view"])
def test_time_goes_on_when_nobody_can_watch_it(world, monkeypatch, fails):
    def show(what):
        shown.append(what)
        if what == fails:
            raise RecordError("the disk is full")

    class Recorder:
        caption = ("dress", "pull")
        films = True

        def begin(self, static):
            pass

        def frame(self, truth):
            show("frame")

        def film(self, t, draw):
            show("picture")

    class View:
        def show(self, time, room):
            show("view")

    shown, told = [], []
    monkeypatch.setattr(world, "_watchers", Watchers(world.truth_frame, world._draw, world._backdrop.diorama, {}))
    world._watchers.show(View())
    world.attach_recorder(Recorder(), told.append)
    begin = world.clock.now()
    world.clock.wait_until(begin + 0.4)
    assert world.clock.now() == pytest.approx(begin + 0.4)
    assert shown.count("view") >= 5
    assert [str(error) for error in told] == ["the disk is full"]
    assert shown.count(fails) > 1


def test_the_same_seed_is_the_same_world():
    frames = []
    for _ in range(2):
        world = BulletWorld(seed=3)
        world.clock.wait_until(0.3)
        frames.append((world.truth_frame().vertices, world.look("head").rgb))
        world.close()
    np.testing.assert_array_equal(frames[0][0], frames[1][0])
    np.testing.assert_array_equal(frames[0][1], frames[1][1])


def test_a_run_can_begin_with_the_gown_in_both_hands():
    world = BulletWorld(seed=2)
    world.set_initial_state("gown_in_hands")
    weight = world.scene.gown.mass * GRAVITY
    seen = world.observe()
    assert -seen.wrench_hand_in_map[:, 2].sum() == pytest.approx(weight, rel=0.25)  # it still swings a little
    assert (seen.gripper_opening < 0.01).all()
    vertices, (left, right) = world.truth_frame().vertices, world.scene.mesh.corners
    for n, corner in enumerate((right, left)):  # the outside faces the robot: its left hand holds the right corner
        assert np.linalg.norm(vertices[corner] - seen.pose_hand_in_map[n, :3, 3]) < 0.03
    world.close()
    with pytest.raises(WorldError, match="no run begins with 'gown_on_floor'; there are gown_on_hook, gown_in_hands"):
        BulletWorld(seed=2).set_initial_state("gown_on_floor")


def test_a_run_can_begin_with_both_sleeves_on_and_not_both_up():
    reached = []
    for seed in (0, 1):
        world = BulletWorld(seed=seed)
        world.set_initial_state("gown_worn")
        frame, loops = world.truth_frame(), world.scene.mesh.loops
        for n, side in enumerate(SIDES):
            armhole, cuff = (frame.vertices[None, loops[f"{part}_{side}"]] for part in ("armhole", "cuff"))
            worn = sleeve(armhole, cuff, frame.arms[None, n])
            assert worn.on.all()
            reached.append(worn.armhole.upper_arm[0])
        world.close()
    assert min(reached) < 0.7 < max(reached)


@pytest.mark.parametrize("seed", [100, 101])
def test_a_run_can_begin_with_a_dressed_person_whose_arms_lie(seed):
    world = BulletWorld(seed=seed)
    lying = world.truth_frame().arms
    world.set_initial_state("gown_dressed")
    frame, mesh = world.truth_frame(), world.scene.mesh
    assert np.abs(frame.arms - lying).max() < 0.03
    for n, side in enumerate(SIDES):
        armhole, cuff = (frame.vertices[None, mesh.loops[f"{part}_{side}"]] for part in ("armhole", "cuff"))
        worn = sleeve(armhole, cuff, frame.arms[None, n])
        assert worn.on.all()
        assert worn.armhole.upper_arm[0] > 0.5
    assert coverage(frame.vertices, mesh.faces, frame.torso_front)[0] > 0.9
    collar, shoulders = frame.vertices[mesh.collar, 1].mean(), frame.arms[:, 0, 1].mean()
    assert abs(collar - shoulders) < 0.15, "the neckline lies at the neck [m]"
    np.testing.assert_allclose(world.observe().pose_base_in_map[:2], world.room.waypoints["bed_right"][:2], atol=1e-6)
    world.close()


def test_a_run_can_begin_where_another_one_was():
    before = BulletWorld(seed=1)
    before.set_initial_state("gown_worn")
    then = before.truth_frame()
    before.close()
    state = RecordedState(t=9.0, vertices=then.vertices, arms=then.arms, robot=np.array((-1.0, -0.2)))
    world = BulletWorld(seed=1)
    world.set_recorded_state(state)
    now, pose = world.truth_frame(), world.observe().pose_base_in_map
    assert np.abs(now.arms - then.arms).max() < 0.01
    assert np.linalg.norm(now.vertices - then.vertices, axis=1).mean() < 0.01  # it settles
    np.testing.assert_allclose(pose, world.room.waypoints["bed_left"], atol=1e-6)
    world.clock.wait_until(0.1)
    with pytest.raises(WorldError, match="before the run begins"):
        world.set_recorded_state(state)
    world.close()
    with pytest.raises(WorldError, match="the recorded gown has 3 vertices"):
        BulletWorld(seed=1).set_recorded_state(replace(state, vertices=np.zeros((3, 3))))
    bare = BulletWorld(seed=1)
    bare.remove_gown()
    with pytest.raises(WorldError, match="without a gown"):
        bare.set_recorded_state(replace(state, vertices=np.zeros((0, 3))))


def test_a_gown_that_was_recorded_on_its_hook_still_hangs():
    world = BulletWorld(seed=1)
    hung = world.truth_frame()
    world.set_recorded_state(RecordedState(t=0.0, vertices=hung.vertices, arms=hung.arms, robot=np.zeros(2)))
    world.clock.wait_until(1.0)
    fallen = hung.vertices[:, 2] - world.truth_frame().vertices[:, 2]  # it swings, but stays up
    assert abs(fallen.mean()) < 0.02
    assert np.abs(fallen[world.scene.hang_vertex]) < 0.01
    world.close()


def test_a_hand_that_is_driven_into_the_chest_is_held_back_and_everyone_sees_it():
    world = BulletWorld(seed=100)
    world.set_initial_state("gown_worn")
    frames = []
    recorder = SimpleNamespace(begin=lambda static: None, frame=frames.append, picture=lambda *_: None)
    world.attach_recorder(recorder, lambda error: None)
    low = np.array((0.35, -0.55, -0.95, 1.65, 0.65, 0.90, -0.30))  # fingers down, as high as the chest
    posture = np.stack((low, model.READY[1]))
    hand = world.kinematics.pose_hand_in_base("left", low)[:3, 3]
    a, _, radius = world._person.trunk["trunk_left"]
    world._robot = world._stand((float(a[0] - hand[0]), float(a[1] + 0.2 - hand[1]), 0.0), arm_positions=posture)
    until = world.clock.now() + 1.0
    while world.clock.now() < until:
        world.send(HandTwist(side="left", twist_in_map=np.array((0.0, 0.0, -0.1, 0.0, 0.0, 0.0)), duration=0.1))
        world.clock.wait_until(world.clock.now() + 0.05)
    wrench = world.observe().wrench_hand_in_map
    trunk = PERSON_PARTS.index("trunk")
    assert 30.0 < frames[-1].person_force[trunk] < 120.0  # there the motors give way: ISO/TS 15066 allows 140 N
    assert np.linalg.norm(wrench[0, :3]) == pytest.approx(frames[-1].person_force[trunk], rel=0.1)
    assert np.abs(wrench[1]).max() < 1.0  # the other hand touches nothing
    assert a[2] + radius - frames[-1].gripper_pose[0, 2] < 0.03  # it was told to go down by 9 cm
    assert np.delete(frames[-1].person_force, trunk).max() < 5.0
    world.close()
