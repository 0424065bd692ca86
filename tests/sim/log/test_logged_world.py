import json
from dataclasses import replace

import numpy as np
import pytest
from caretree.sim.abilities import HasKinematics, SupportsFaults
from caretree.sim.faults import FaultyWorld, parse_fault
from caretree.sim.log.log_file import LogFile
from caretree.sim.log.logged_world import URDF, logged, logged_into
from caretree.sim.log.messages import ROBOT
from caretree.sim.scripted.clock import SteppedClock
from caretree.sim.scripted.world import ScriptedWorld
from caretree.sim.testing import check_world
from caretree.sim.waiting import wait
from caretree.sim.world import BaseVelocity, GripperOpening, SensorLost, World
from caretree.trees.cli import main

pytest.importorskip("mcap", reason="mcap is an extra: pip install 'caretree[log]'")
from mcap.reader import make_reader


@pytest.fixture
def path(tmp_path):
    return tmp_path / "run.mcap"


def told(path, topic):
    with path.open("rb") as file:
        return [json.loads(message.data) for _, _, message in make_reader(file).iter_messages(topics=[topic])]


def times(path, topic):
    return [each["timestamp"]["sec"] + 1e-9 * each["timestamp"]["nsec"] for each in told(path, topic)]


def test_a_measurement_is_written_once(path):
    with logged_into(ScriptedWorld(seed=1), str(path)) as world:
        for _ in range(3):
            world.observe()
        wait(world.clock, 0.5)
        world.observe()
    assert times(path, "/joint_states") == pytest.approx([0.0, 0.5])
    assert times(path, "/measured") == pytest.approx([0.0, 0.5])


def test_the_robot_comes_with_the_log(path):
    with logged_into(ScriptedWorld(seed=1), str(path)):
        pass
    with path.open("rb") as file:
        told_of = {each.name: each.data for each in make_reader(file).iter_attachments()}
    assert set(told_of) == {URDF, ROBOT}
    assert b'name="left_w1"' in told_of[URDF]
    assert json.loads(told_of[ROBOT])["arms"]["left"][0] == "left_s0"


def test_a_robot_without_its_description_is_logged_too(path):
    world = ScriptedWorld(seed=1)

    def lost():
        raise OSError("no such file")

    world.robot = replace(world.robot, urdf=lost)
    with logged_into(world, str(path)) as measured:
        measured.observe()
    assert len(told(path, "/measured")) == 1


def test_pictures_are_throttled_for_each_camera(path):
    with logged_into(ScriptedWorld(seed=1), str(path)) as world:
        for n in range(31):
            wait(world.clock, 0.1 * n)
            world.look("head")
            world.look("left_hand")
    assert times(path, "/head_camera/image") == pytest.approx([0.0, 1.0, 2.0, 3.0])
    assert times(path, "/left_hand_camera/depth") == pytest.approx([0.0, 1.0, 2.0, 3.0])


class Clipping(ScriptedWorld):
    def send(self, command):
        if isinstance(command, BaseVelocity):
            command = BaseVelocity(velocity=np.clip(command.velocity, -0.1, 0.1), duration=command.duration)
        return super().send(command)


def test_what_was_really_sent_is_written(path):
    with logged_into(Clipping(seed=1), str(path)) as world:
        answered = world.send(BaseVelocity(velocity=np.array((3.0, 0.0, 0.0))))
        world.stop()
    assert answered.velocity.tolist() == [0.1, 0.0, 0.0]
    move, stop = told(path, "/sent")
    assert move["velocity"] == [0.1, 0.0, 0.0]
    assert stop["command"] == "stop"


def test_a_command_that_is_lost_on_its_way_was_not_sent(path):
    with logged_into(ScriptedWorld(seed=1), str(path)) as measured:
        world = FaultyWorld(measured, [parse_fault("lost_command@let go:start")])
        world.on_phase("let go", "start")
        world.send(GripperOpening(side="left", opening=0.05))
    assert told(path, "/sent") == []


def test_what_is_not_measured_is_not_written_and_told_as_before(path):
    class Dead(ScriptedWorld):
        def observe(self):
            raise SensorLost("no joint states")

    with logged_into(Dead(seed=1), str(path), rate=20.0) as world:
        with pytest.raises(SensorLost):
            world.observe()
        wait(world.clock, 0.2)
    assert told(path, "/measured") == []


def test_between_ticks_it_measures_as_often_as_asked(path):
    with logged_into(ScriptedWorld(seed=1), str(path), rate=50.0) as world:
        assert isinstance(world.clock, SteppedClock)
        wait(world.clock, 1.0)
    assert times(path, "/joint_states") == pytest.approx(np.arange(0.02, 1.001, 0.02))


class Late:
    """A wall clock that passes 10 ms with each wait, whatever is asked for."""

    def __init__(self):
        self.time = 0.0

    def now(self):
        return self.time

    def wait_until(self, time):
        self.time += min(time - self.time, 0.01)


def test_a_wall_clock_stays_one_and_may_come_back_early(path):
    inner = ScriptedWorld(seed=1)
    inner.clock = Late()
    with logged_into(inner, str(path), rate=20.0) as world:
        assert not isinstance(world.clock, SteppedClock)
        world.clock.wait_until(1.0)
        assert world.clock.now() == pytest.approx(0.01)
        wait(world.clock, 0.1)
        assert world.clock.now() == pytest.approx(0.1)


def test_abilities_are_passed_on(path):
    with logged_into(ScriptedWorld(seed=1), str(path)) as world:
        assert isinstance(world, HasKinematics)
        assert isinstance(world, SupportsFaults)
        assert world.kinematics is not None
        world.fault_grip_slip("left")
        world.fault_move_person()
        assert world.inner.person_offset[0] == 0.1
    assert not isinstance(logged(Bare(), None), SupportsFaults)
    assert logged(Bare(), None).kinematics is None


class Bare(World):
    """A world without abilities."""

    def __init__(self):
        whole = ScriptedWorld(seed=1)
        self.clock, self.room, self.robot = whole.clock, whole.room, whole.robot
        self.observe, self.look, self.send, self.stop = whole.observe, whole.look, whole.send, whole.stop

    def observe(self): ...

    def look(self, camera): ...

    def send(self, command): ...

    def stop(self): ...


@pytest.mark.parametrize("rate", [None, 100.0])
def test_it_keeps_every_law(tmp_path, rate):
    files = []

    def make():
        files.append(LogFile(tmp_path / f"{len(files)}.mcap"))
        return logged(ScriptedWorld(seed=1), files[-1], rate)

    plain = check_world(lambda: ScriptedWorld(seed=1))
    assert check_world(make) == plain
    for file in files:
        file.close()


RUN = ("run", "wave", "--world", "scripted")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_a_run_is_the_same_with_its_log_and_is_repeated(folder, capsys):
    assert main([*RUN, "--out", "plain"]) == 0
    assert main([*RUN, "--out", "logged", "--log", "run.mcap"]) == 0
    assert capsys.readouterr().out.endswith("run.mcap\n")
    hashes = [json.loads((folder / each / "run.json").read_text())["trace_hash"] for each in ("plain", "logged")]
    assert hashes[0] == hashes[1]
    assert [each["command"] for each in told(folder / "run.mcap", "/sent")].count("JointTrajectory") == 2


def test_without_a_name_the_log_lies_in_the_record(folder, capsys):
    assert main([*RUN, "--out", "r", "--log"]) == 0
    assert capsys.readouterr().out.endswith("r/log.mcap\n")
    assert len(told(folder / "r" / "log.mcap", "/joint_states")) > 10


def test_a_run_that_was_measured_more_often_repeats_too(folder):
    assert main([*RUN, "--out", "r", "--log", "run.mcap", "--log-rate", "50"]) == 0
    assert len(told(folder / "run.mcap", "/joint_states")) > 250
    assert main(["replay", "r"]) == 0


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--log", "there.mcap"), "there.mcap is there already: give another file with --log"),
        (("--log-rate", "50"), "--log-rate is the rate of the log: give --log too"),
        (("--log", "new.mcap", "--log-rate", "5000"), "'5000' is no rate: 0.1 to 1000 Hz is asked for"),
        (("--log", "new.mcap", "--log-rate", "nan"), "'nan' is no rate: 0.1 to 1000 Hz is asked for"),
    ],
)
def test_a_users_mistake_is_one_sentence(folder, capsys, options, said):
    (folder / "there.mcap").touch()
    assert main([*RUN, "--out", "r", *options]) == 2
    assert said in capsys.readouterr().err
    assert not (folder / "r/run.json").exists()
    assert not (folder / "new.mcap").exists()
