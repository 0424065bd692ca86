import json

import numpy as np
import pytest
from caretree.sim.errors import RecordError
from caretree.sim.record.recorded_stretch import EMPTY, FIRM, MOVED, read_stretch

from .recorded_lift import CLOSE, WAIT, write_record
from .test_measured import ARMS

TAKEN = 5.0 + WAIT + CLOSE


@pytest.fixture
def record(tmp_path):
    return write_record(tmp_path, ARMS)


def test_a_stretch_begins_at_rest_and_is_looked_at_once_the_hand_has_moved(record):
    stretch = read_stretch(record)
    assert stretch.hand == 0
    assert stretch.robot.t[0] < TAKEN - 0.4
    assert stretch.held.part.max() == 4  # the right upper arm, which bears the load
    assert (stretch.held.part[stretch.robot.t < TAKEN - 1e-6] == -1).all()
    place = stretch.robot.pose_hand[:, 0, :3]
    first = int(np.flatnonzero(stretch.looked_at & (stretch.robot.t > TAKEN))[0])
    assert np.linalg.norm(place[first] - place[0]) > MOVED
    assert np.linalg.norm(place[first - 1] - place[0]) <= MOVED
    assert stretch.vertices is None


def test_before_it_an_empty_hand_is_looked_at_where_there_is_time(tmp_path):
    stretch = read_stretch(write_record(tmp_path, ARMS, wait=1.9))
    t, taken = stretch.robot.t, TAKEN + 0.9
    before = stretch.looked_at & (t < taken)
    assert t[before][0] == t[0]
    assert t[before][-1] == pytest.approx(taken - EMPTY, abs=0.07)
    assert not stretch.looked_at[(t > taken - EMPTY + 0.07) & (t < taken)].any()
    assert stretch.held_arm == 1


def test_a_load_under_which_an_arm_slips_ends_what_is_looked_at(tmp_path):
    load = np.zeros((200, 3))
    load[42:] = (0.0, 0.0, -FIRM - 1.0)
    stretch = read_stretch(write_record(tmp_path, ARMS, load=load))
    held = stretch.looked_at & (stretch.robot.t > TAKEN)
    assert held.any()
    assert stretch.robot.t[held][-1] < 5.0 + 42 / 15.0


def test_a_span_limits_what_is_looked_at(record):
    whole = read_stretch(record)
    late = read_stretch(record, TAKEN + 1.0)
    assert late.robot.t[late.looked_at][0] >= TAKEN + 1.0
    assert late.looked_at.sum() < whole.looked_at.sum()


def test_a_span_in_which_nothing_is_held_is_told_with_what_there_is(record):
    with pytest.raises(RecordError, match=r"no hand holds anything for 1 s between 0 and 5 s \(holds: left 6\.2 to"):
        read_stretch(record, 0.0, 5.0)
    with pytest.raises(RecordError, match=r"no hand holds an arm for 1 s \(holds: none\)"):
        read_stretch(record, hand="right")


def test_a_record_of_another_world_or_without_truth_is_told(record):
    run = json.loads((record / "run.json").read_text())
    (record / "run.json").write_text(json.dumps(run | {"world": "scripted"}))
    with pytest.raises(RecordError, match="only records of the bullet world"):
        read_stretch(record)
    (record / "run.json").write_text(json.dumps(run | {"parameters": run["parameters"] | {"robot": "ur5-pair"}}))
    with pytest.raises(RecordError, match="is of the robot ur5-pair, only records of baxter"):
        read_stretch(record)
    (record / "run.json").write_text(json.dumps(run))
    (record / "truth.npz").unlink()
    with pytest.raises(RecordError, match=r"holds no truth.npz"):
        read_stretch(record)


def test_a_base_that_faces_180_degrees_does_not_jump_by_a_turn(record):
    with np.load(record / "measured.npz") as file:
        columns = dict(file)
    columns["pose_base"][:, 2] = np.pi * np.where(np.arange(len(columns["t"])) % 2, -1.0, 1.0)
    np.savez(record / "measured.npz", **columns)
    assert not np.ptp(read_stretch(record).robot.pose_base[:, 2])
