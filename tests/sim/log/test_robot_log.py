import numpy as np
import pytest
from caretree.sim.errors import RecordError
from caretree.sim.log.log_file import LogFile
from caretree.sim.log.logged_world import logged_into
from caretree.sim.log.messages import Observed
from caretree.sim.log.robot_log import held, read_log
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.scripted.world import ScriptedWorld
from caretree.sim.waiting import wait
from caretree.sim.world import BaseVelocity, GripperOpening

pytest.importorskip("mcap", reason="mcap is an extra: pip install 'caretree[log]'")


def test_what_was_written_is_read(tmp_path):
    path = tmp_path / "run.mcap"
    with logged_into(ScriptedWorld(seed=1), str(path)) as world:
        first = world.observe()
        frame = world.look("head")
        world.send(BaseVelocity(velocity=np.array((0.1, 0.0, 0.0))))
        wait(world.clock, 0.5)
        last = world.observe()
        world.stop()
    log = read_log(path)
    assert log.robot == BAXTER.name
    assert log.t == pytest.approx([first.time, last.time])
    assert log.roles.arms[:2] == BAXTER.joints_of("left")[:2]
    assert log.roles.head == BAXTER.head_joint
    arms = np.array([log.joints[name][:, 0] for name in log.roles.arms]).T
    assert arms == pytest.approx(np.array([each.arm_positions.ravel() for each in (first, last)]), rel=1e-8)
    assert log.joints["base_x"][1, 0] == pytest.approx(last.pose_base_in_map[0])
    assert np.isnan(log.joints["base_x"][1, 1]), "the log does not tell how fast that joint is"
    assert log.wrench_hand.shape == (2, 2, 6)
    assert [content["command"] for _, content in log.sent] == ["BaseVelocity", "stop"]
    (picture,) = log.pictures["head"]
    assert picture.time == pytest.approx(frame.stamp)
    assert picture.rgb().shape == frame.rgb.shape
    assert np.abs(picture.rgb().astype(int) - frame.rgb).mean() < 6.0, "a JPEG is nearly the same"


def test_a_load_is_force_then_torque(tmp_path):
    world = ScriptedWorld(seed=1)
    path = tmp_path / "run.mcap"
    with logged_into(world, str(path)) as logging:
        seen = logging.observe()
    assert read_log(path).wrench_hand[0] == pytest.approx(seen.wrench_hand_in_map, rel=1e-8)


def test_bytes_that_are_no_jpeg_are_read_too(tmp_path, monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "cv2", None)
    path = tmp_path / "run.mcap"
    with logged_into(ScriptedWorld(seed=1), str(path)) as world:
        world.observe()
        frame = world.look("head")
    (picture,) = read_log(path).pictures["head"]
    assert np.array_equal(picture.rgb(), frame.rgb)


def test_what_is_no_log_is_refused(tmp_path):
    with pytest.raises(RecordError, match="no such file"):
        read_log(tmp_path / "no.mcap")
    (tmp_path / "text.mcap").write_text("hello")
    with pytest.raises(RecordError, match="is no whole MCAP file"):
        read_log(tmp_path / "text.mcap")


def test_a_log_cut_short_is_refused(tmp_path):
    path = tmp_path / "run.mcap"
    with logged_into(ScriptedWorld(seed=1), str(path)) as world:
        world.observe()
    path.write_bytes(path.read_bytes()[:-300])
    with pytest.raises(RecordError, match="is no whole MCAP file"):
        read_log(path)


def test_a_log_of_another_program_is_refused(tmp_path):
    file = LogFile(tmp_path / "other.mcap")
    file.write(0.0, Observed(BAXTER).messages(ScriptedWorld(seed=1).observe()))
    file.close()
    with pytest.raises(RecordError, match="is no log of this version: record it with `caretree run TASK --log`"):
        read_log(file.path)


def test_a_log_without_a_measurement_is_refused(tmp_path):
    with logged_into(ScriptedWorld(seed=1), str(tmp_path / "run.mcap")) as world:
        world.send(GripperOpening(side="left", opening=0.05))
    with pytest.raises(RecordError, match="is no log"):
        read_log(tmp_path / "run.mcap")


def test_the_latest_that_is_not_after():
    assert held(np.array((0.0, 1.0, 1.5, 9.0)), [1.0, 2.0]).tolist() == [-1, 0, 0, 1]
    assert held(np.array((0.0,)), []).tolist() == [-1]
