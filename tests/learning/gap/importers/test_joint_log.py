import json
import struct

import numpy as np
import pytest
from caretree.learning.gap.cli import main
from caretree.learning.gap.errors import GapError
from caretree.learning.gap.importers.joint_log import import_logs, read_log
from caretree.learning.gap.measurement import load_set
from caretree.sim.log.log_file import LogFile
from caretree.sim.log.logged_world import logged_into
from caretree.sim.scripted.world import ScriptedWorld
from caretree.sim.waiting import wait

pytest.importorskip("mcap", reason="mcap is an extra: pip install 'caretree[log]'")
from mcap.writer import Writer

from .sticky_arm import LEFT, StickyArm, swing

JOINTS = ("left_[sew]?",)


@pytest.fixture
def swings(tmp_path):
    """Logs of three swings of an arm with dry friction of `level` [N m] in one joint."""

    def make(level, duration=12.0, logs=3):
        paths = [tmp_path / f"swing_{k}.mcap" for k in range(logs)]
        for k, path in enumerate(paths):
            with logged_into(StickyArm(seed=k, level=level), str(path), rate=100.0) as world:
                world.send(swing(k, duration))
                wait(world.clock, duration)
        return paths

    return make


@pytest.mark.parametrize(("level", "verdict"), [(1.0, "effects"), (0.0, "adequate")])
def test_a_log_of_hidden_friction_is_named_and_one_without_is_not(swings, tmp_path, level, verdict):
    logs, out = [str(path) for path in swings(level)], tmp_path / "out"
    assert main(["import", *logs, "--joints", *JOINTS, "--out", str(tmp_path / "set")]) == 0
    assert main(["run", str(tmp_path / "set"), "--out", str(out)]) == 0
    found = json.loads((out / "verdict.json").read_text())
    assert found["verdict"] == verdict
    named = [(each["name"], each["target"]) for each in found["effects"]]
    assert named == ([("coulomb_friction", "left_e1")] if level else [])
    if level:
        (size, *_) = found["effects"][0]["parameters"]
        assert size["low"] < level < size["high"]
        assert found["gap"]["after"] < 0.2 * found["gap"]["before"]


def test_a_single_log_is_cut_in_two(swings, tmp_path):
    (log,) = swings(0.0, duration=2.0, logs=1)
    found = load_set(import_logs([log], tmp_path / "set", JOINTS))
    assert [(e.name, e.role) for e in found.episodes] == [("first", "fit"), ("second", "heldout")]
    assert sum(len(e.t) for e in found.episodes) == pytest.approx(200, abs=2)
    assert set(found.episodes[0].columns) == {"t", *(f"{c}{j + 1}" for c in ("q", "dq", "tau") for j in range(7))}


def test_joints_stand_from_shoulder_to_wrist_whatever_they_are_called(swings, tmp_path):
    (log,) = swings(0.0, duration=0.5, logs=1)
    state = read_log(log).topics["/joint_states"][5]
    columns = load_set(import_logs([log], tmp_path / "set", JOINTS)).episodes[0].columns
    assert [columns[f"q{j + 1}"][5] for j in range(7)] == pytest.approx([state.position[name] for name in LEFT])


def cdr(t, names, position, velocity, effort):
    """A `sensor_msgs/msg/JointState` of ROS 2."""
    data = bytearray(struct.pack("<II", int(t), round(t % 1 * 1e9)))

    def padded(size):
        data.extend(b"\0" * (-len(data) % size))

    for text in ("base", None, *names):
        if text is None:
            padded(4)
            data.extend(struct.pack("<I", len(names)))
        else:
            padded(4)
            data.extend(struct.pack("<I", len(text) + 1) + text.encode() + b"\0")
    for values in (position, velocity, effort):
        padded(4)
        data.extend(struct.pack("<I", len(values)))
        if values:
            padded(8)
            data.extend(struct.pack(f"<{len(values)}d", *values))
    return b"\0\1\0\0" + bytes(data)


@pytest.fixture
def of_ros2(tmp_path):
    """A log as rosbag2 writes it, without speeds, with gripper messages between those of the arm."""
    path = tmp_path / "ros2.mcap"
    names = [f"shoulder_{a}_joint" for a in ("pan", "lift")]
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start(profile="ros2", library="test")
        schema = writer.register_schema("sensor_msgs/msg/JointState", "ros2msg", b"")
        channel = writer.register_channel("/joint_states", "cdr", schema)
        for n in range(40):
            at = 100.0 + 0.01 * n
            writer.add_message(channel, n, cdr(at, names[::-1], [0.2, 0.1 * n], [], [2.0, 1.0]), n)
            writer.add_message(channel, n, cdr(at, ["finger"], [0.5], [], [0.1]), n)
        writer.finish()
    return path


def test_a_robot_of_ros_2_is_read(of_ros2, tmp_path):
    found = load_set(import_logs([of_ros2], tmp_path / "set", ["shoulder_*"], robot="ur10"))
    columns = found.episodes[0].columns
    assert list(columns) == ["t", "q1", "q2", "tau1", "tau2"]
    np.testing.assert_allclose(columns["t"], 0.01 * np.arange(24), atol=1e-8)
    np.testing.assert_allclose(columns["q1"], 0.1 * np.arange(24))
    assert set(columns["tau1"]) == {1.0}


def test_what_is_wrong_is_one_sentence(of_ros2, tmp_path, capsys):
    def said(*options):
        assert main(["import", *options, "--out", str(tmp_path / "set")]) == 2
        assert not (tmp_path / "set").exists()
        (line,) = capsys.readouterr().err.splitlines()
        return line

    ros2 = str(of_ros2)
    assert "no such file" in said("nowhere.mcap", "--joints", "a")
    assert "does not bring the robot's URDF, name one with --robot" in said(ros2, "--joints", "a")
    assert "is called elbow; there are shoulder_lift" in said(ros2, "--joints", "elbow", "--robot", "ur10")
    assert "there is no topic /arm" in said(ros2, "--joints", "*", "--robot", "ur10", "--topic", "/arm")
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(of_ros2.read_bytes()[:400])
    assert "is no whole MCAP file" in said(str(cut), "--joints", "*")
    (tmp_path / "text.mcap").write_text("hello " * 20)
    assert "is no whole MCAP file" in said(str(tmp_path / "text.mcap"), "--joints", "*")
    empty = LogFile(tmp_path / "empty.mcap")
    empty.close()
    assert "has no joint states" in said(str(empty.path), "--joints", "*")


def test_two_topics_are_told_apart(tmp_path):
    path = tmp_path / "two.mcap"
    with logged_into(ScriptedWorld(seed=1), str(path)) as world:
        world.observe()
        content = {"timestamp": {"sec": 1, "nsec": 0}, "joints": [{"name": "a", "position": 0.0, "effort": 0.0}]}
        world._file.write(1.0, [("/other", "foxglove.JointStates", content)])
    with pytest.raises(GapError, match=r"several topics of joint states, name one with --topic: /joint_states, /other"):
        import_logs([path], tmp_path / "set", ["a"])
