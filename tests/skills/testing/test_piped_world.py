"""The whole dressing tree does the same with the world behind a pipe, where there is no truth to be reached."""

import gc
import threading
from dataclasses import fields, make_dataclass, replace
from multiprocessing import Pipe
from types import FrameType, FunctionType, ModuleType

import numpy as np
import pytest
from caretree.sim.bullet.world import BulletWorld
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.remote.values import UndeclaredError, packed, unpacked
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.scene.scene import Scene
from caretree.sim.scripted.world import ScriptedWorld
from caretree.sim.world import CAMERAS, Frame, HandTwist, Observation, RoomMap, SensorLost, World, WorldError
from caretree.skills.scripted.rehearsal import RehearsalWorld
from caretree.skills.testing import PipedWorld
from caretree.skills.testing.piped_world import serve
from caretree.trees.guard.limits import Limits
from caretree.trees.run.runner import Run
from caretree.trees.run.task import load_task
from caretree.trees.tasks.dressing.rehearsal import GownScript

REHEARSAL = "caretree.skills.scripted.rehearsal:RehearsalWorld"
BULLET = "caretree.sim.bullet.world:BulletWorld"
# The whole contract: a new field, or more numbers in one that there is, may bring the truth.
OBSERVED = {
    "time": (),
    "arm_positions": (2, 7),
    "arm_velocities": (2, 7),
    "arm_efforts": (2, 7),
    "head_pan": (),
    "pose_base_in_map": (3,),
    "twist_base": (3,),
    "gripper_opening": (2,),
    "gripper_force": (2,),
    "wrench_hand_in_map": (2, 6),
    "pose_hand_in_map": (2, 4, 4),
    "emergency_stop": (),
}
PICTURED = {"camera", "stamp", "rgb", "depth", "intrinsics", "pose_camera_in_map"}
MAPPED = {"free", "origin", "resolution", "waypoints", "bed"}
PLACES = {"start", "rail", "rail_back", "lay", "bed_right", "bed_left", "bed_head"}


@pytest.fixture
def piped():
    """Makes worlds behind pipes."""
    worlds = []

    def make(kind, **options):
        worlds.append(PipedWorld(kind, kinematics=kinematics_of(BAXTER), **options))
        return worlds[-1]

    yield make
    for world in worlds:
        world.close()


def in_reach(start):
    """Everything that can be reached from an object, as the garbage collector sees it, but for code and its globals."""
    found, new = {}, [start]
    while new:
        each = new.pop()
        if id(each) in found or isinstance(each, (type, ModuleType, FrameType)):
            continue
        found[id(each)] = each
        inside = [each.__closure__, each.__defaults__] if isinstance(each, FunctionType) else gc.get_referents(each)
        new.extend(inside)
    return list(found.values())


def worlds_in_reach(run):
    return {type(each).__name__ for each in in_reach(run.context) if isinstance(each, (World, Scene))}


@pytest.mark.no_cover  # counting lines doubles its time
def test_the_rehearsed_dressing_is_the_same_and_its_world_is_out_of_reach(piped):
    task, runs = load_task("dressing"), []
    for world in (RehearsalWorld(seed=107), piped(REHEARSAL, seed=107)):
        runs.append(Run(task, world, seed=107, senses=GownScript(world)))
    direct, behind = [run.run() for run in runs]
    assert direct.outcome == "success"
    assert direct.trace_hash == behind.trace_hash
    assert worlds_in_reach(runs[0]) == {"RehearsalWorld"}, "else the search finds nothing anywhere"
    assert worlds_in_reach(runs[1]) == {"PipedWorld"}


@pytest.mark.no_cover  # counting lines doubles its time
def test_dressing_in_physics_is_the_same_and_its_scene_is_out_of_reach(piped):
    task, runs, looks = load_task("dressing"), [], []
    for world in (BulletWorld(seed=100), piped(BULLET, seed=100)):
        runs.append(Run(task, world, seed=100, limits=Limits(run=6.0)))
        look = world.look
        world.look = lambda camera, look=look: looks.append(camera) or look(camera)
    direct, behind = [run.run() for run in runs]
    assert looks
    assert direct.trace_hash == behind.trace_hash
    assert worlds_in_reach(runs[0]) == {"BulletWorld", "Scene"}
    assert worlds_in_reach(runs[1]) == {"PipedWorld"}
    for world in (run.world for run in runs):
        seen, frame = world.observe(), world.look("head")
        assert {name: np.shape(getattr(seen, name)) for name in OBSERVED} == OBSERVED
        assert frame.rgb.shape == (*frame.depth.shape, 3)
        assert len(frame.intrinsics) == 4
        assert frame.pose_camera_in_map.shape == (4, 4)
        assert set(world.room.waypoints) == PLACES
    other = piped(BULLET, seed=101)
    assert all(np.array_equal(a, b) for a, b in zip(*(packed(w.room)[1].values() for w in (other, world)), strict=True))
    world.close(), runs[0].world.close()


def test_the_contract_declares_this_and_no_more():
    assert {field.name for field in fields(Observation)} == set(OBSERVED)
    assert {field.name for field in fields(Frame)} == PICTURED
    assert {field.name for field in fields(RoomMap)} == MAPPED
    assert {name for name in dir(World) if not name.startswith("_")} == {"observe", "look", "send", "stop", "close"}
    assert set(World.__annotations__) == {"clock", "room", "robot"}
    assert CAMERAS == ("head", "left_hand", "right_hand")


def with_attribute(seen):
    object.__setattr__(seen, "gown_vertices", np.zeros((3, 3)))
    return seen


@pytest.mark.parametrize(
    ("plant", "said"),
    [
        (with_attribute, "Observation has gown_vertices, which the contract does not declare"),
        (
            lambda seen: make_dataclass("Observation", ["layers"], bases=(Observation,), frozen=True, kw_only=True)(
                **vars(seen), layers=2
            ),
            "a world gives a Observation, but its contract knows",
        ),
        (lambda seen: replace(seen, head_pan=ScriptedWorld()), "a world gives a ScriptedWorld"),
        (lambda seen: replace(seen, arm_efforts=np.array([ScriptedWorld()])), "a world gives a ndarray"),
        (lambda seen: replace(seen, time=type("Time", (float,), {"truth": 3})(1.0)), "a world gives a Time"),
    ],
)
def test_what_is_not_declared_is_refused(plant, said):
    seen = ScriptedWorld().observe()
    assert isinstance(unpacked(packed(seen)), Observation)
    with pytest.raises(UndeclaredError, match=said):
        packed(plant(seen))


def test_values_come_out_as_they_went_in():
    command = HandTwist(side="left", twist_in_map=np.arange(6.0), duration=0.3)
    back = unpacked(packed(command))
    assert type(back) is HandTwist
    assert np.array_equal(back.twist_in_map, command.twist_in_map)
    assert (back.side, back.duration) == ("left", 0.3)
    assert unpacked(packed(np.float64(0.5))) == 0.5
    room = unpacked(packed(ScriptedWorld().room))
    assert room.waypoints == ScriptedWorld().room.waypoints


def test_the_pipe_answers_what_the_contract_asks_and_nothing_else():
    near, far = Pipe()
    world, closed = ScriptedWorld(seed=3), []
    world.close = lambda: closed.append(True)
    serving = threading.Thread(target=serve, args=(far, world))
    serving.start()

    def ask(*question):
        near.send(question)
        return near.recv()

    assert ask("now", ()) == ("", 0.0)
    assert ask("wait_until", (0.5,)) == ("", None)
    assert ask("now", ()) == ("", 0.5)
    assert ask("look", ("tail",))[0] == "SensorLost"
    assert ask("truth_frame", ())[0] == "KeyError"
    assert ask("person_offset", ())[0] == "KeyError"
    near.close()
    serving.join()
    assert closed


def test_errors_of_the_world_are_the_same_behind_the_pipe(piped):
    world = piped(REHEARSAL, begins="gown_in_hands", seed=107)
    with pytest.raises(SensorLost, match="tail"):
        world.look("tail")
    world.close()
    world.close()
    with pytest.raises(WorldError, match="has ended"):
        world.observe()
    with pytest.raises(WorldError, match=r"no world: .*'nowhere'"):
        piped(REHEARSAL, begins="nowhere")
    with pytest.raises(WorldError, match="one beginning only"):
        piped("caretree.sim.scripted.world:ScriptedWorld", begins="gown_in_hands")
