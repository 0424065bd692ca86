"""The record survives a kill, a full disk and wrong input."""

import dataclasses
import errno
import io
import json
import os
from pathlib import Path

import numpy as np
import pytest
from caretree.sim.errors import RecordError
from caretree.sim.record.measured import MeasuredLog
from caretree.sim.record.record import RunResult, StageResult, is_finished, read_finished_run, read_run
from caretree.sim.record.recorder import PICTURE_GAP_MAX, Recorder
from caretree.sim.record.spool import open_spool
from caretree.sim.record.truth import TruthFrame, TruthStatic
from caretree.sim.record.video import VideoWriter, read_pictures
from caretree.sim.scripted.world import ScriptedWorld

RESULT = RunResult(
    outcome="failure",
    reason="The gown fell.",
    sim_time_s=0.5,
    stages=(StageResult(name="A", status="failure", attempts=2),),
    timing={"physics": 0.25},
)


def static() -> TruthStatic:
    loop = np.arange(3)
    names = ("armhole_left", "cuff_left", "armhole_right", "cuff_right")
    return TruthStatic(
        faces=np.array([[0, 1, 2]]),
        rest_vertices=np.eye(3),
        loops=dict.fromkeys(names, loop),
        arm_radii=np.full((2, 3), 0.05),
        person_parts=("head", "torso"),
        robot_capsule_names=("left_palm",),
        person_capsules=np.zeros((1, 7)),
        person_capsule_names=("head",),
        bed_top=0.6,
        face=np.zeros(6),
        neckline=np.arange(3),
    )


def truth(index: int, points: int = 100) -> TruthFrame:
    return TruthFrame(
        t=0.08 * index,
        vertices=np.eye(3) + index,
        arms=np.zeros((2, 4, 3)),
        torso_front=np.zeros((points, 6)),
        gripper_pose=np.zeros((2, 7)),
        gripper_closed=np.array([True, False]),
        gripper_load=np.full((2, 3), float(index)),
        person_force=np.array([0.0, index]),
        robot_capsules=np.full((1, 7), float(index)),
        holds_arm=np.array([-1, 1]),
    )


def recorder(directory: Path) -> Recorder:
    return Recorder(directory, task="dressing", seed=4, world="bullet", parameters={"gown": "small"})


def test_finished_record_holds_what_design_asks_for(tmp_path):
    record = recorder(tmp_path / "run")
    record.begin(static())
    for index in range(600):  # more than one chunk
        record.frame(truth(index))
    record.event({"t": 0.1, "node": "grasp"})
    record.finish(RESULT)
    run = read_finished_run(tmp_path / "run")
    assert {
        "task",
        "seed",
        "world",
        "outcome",
        "reason",
        "stages",
        "sim_time_s",
        "wall_time_s",
        "processor_time_s",
        "parameters",
        "versions",
        "trace_hash",
    } <= set(run)
    assert run["stages"][0] == {
        "name": "A",
        "status": "failure",
        "attempts": 2,
        "t_start": None,
        "t_end": None,
        "reason": "",
    }
    with np.load(tmp_path / "run" / "truth.npz") as stored:
        assert set(stored.files) == {
            "t",
            "vertices",
            "faces",
            "rest_vertices",
            "loop_armhole_left",
            "loop_cuff_left",
            "loop_armhole_right",
            "loop_cuff_right",
            "arms",
            "arm_radii",
            "torso_front",
            "gripper_pose",
            "gripper_closed",
            "gripper_load",
            "person_force",
            "person_parts",
            "robot_capsules",
            "robot_capsule_names",
            "holds_arm",
            "person_capsules",
            "person_capsule_names",
            "bed_top",
            "face",
            "neckline",
        }
        assert stored["vertices"].shape == (600, 3, 3)
        assert stored["vertices"].dtype == np.float32
        np.testing.assert_allclose(stored["t"], 0.08 * np.arange(600))
        np.testing.assert_allclose(stored["vertices"][:, 0, 1], np.arange(600))
        np.testing.assert_allclose(stored["person_force"][:, 1], np.arange(600))
        assert stored["gripper_closed"].dtype == bool
        assert list(stored["person_parts"]) == ["head", "torso"]
    assert {path.name for path in (tmp_path / "run").iterdir()} == {"run.json", "trace.jsonl", "truth.npz"}


def test_killed_run_keeps_frames_and_says_so(tmp_path):
    record = recorder(tmp_path)
    record.begin(static())
    for index in range(3):
        record.frame(truth(index))
    # no close, no finish: read what a kill would leave, with half a row at the end
    with (tmp_path / "truth.spool" / "frames.bin").open("ab") as file:
        file.write(b"half")
    assert not is_finished(read_run(tmp_path))
    with pytest.raises(RecordError, match="was cut short"):
        read_finished_run(tmp_path)
    _, frames = open_spool(tmp_path / "truth.spool")
    np.testing.assert_allclose(frames["t"], [0.0, 0.08, 0.16])
    record.close()
    again = recorder(tmp_path)  # a run cut short makes room for the next
    again.finish(RESULT)


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no /dev/full on this system to fill up")
def test_full_disk_while_recording_keeps_earlier_frames(tmp_path):
    record = recorder(tmp_path)
    record.begin(static())
    record.frame(truth(0))
    assert record._spool is not None
    record._spool.close()
    record._spool._file = open("/dev/full", "wb", buffering=0)  # noqa: SIM115 - closed by finish
    assert (tmp_path / "reserve").exists()
    with pytest.raises(RecordError, match="the disk is full"):
        record.frame(truth(1))
    assert not (tmp_path / "reserve").exists(), "its room is for the trace and the outcome"
    record.frame(truth(2))
    record.picture(0.2, np.zeros((48, 64, 3), np.uint8))
    record.event({"t": 0.3})
    with pytest.raises(RecordError, match="the disk is full: stopped while recording frame 1"):
        record.finish(RESULT)
    with np.load(tmp_path / "truth.npz") as stored:
        assert stored["t"].shape == (1,)
    assert not (tmp_path / "video.mp4").exists(), "bulky things are recorded no more"
    assert (tmp_path / "trace.jsonl").read_text() == '{"t":0.3}\n'
    assert read_finished_run(tmp_path)["outcome"] == "failure"


class Disk(io.FileIO):
    """A file on a disk with so much room [bytes], which a reserve may add to."""

    room = 0

    def write(self, data):
        written = min(len(data), self.room)
        if not written:
            raise OSError(errno.ENOSPC, "No space left on device")
        self.room -= written
        return super().write(bytes(data[:written]))


@pytest.mark.parametrize("freed", [0, 1000])
def test_a_full_disk_tears_no_line_of_the_trace(tmp_path, monkeypatch, freed):
    record = recorder(tmp_path)
    record._trace.close()
    disk = Disk(tmp_path / "trace.jsonl", "w")
    record._trace = io.TextIOWrapper(io.BufferedWriter(disk), line_buffering=True)
    disk.room = 20  # two lines and a half
    monkeypatch.setattr(record, "_make_room", lambda: setattr(disk, "room", disk.room + freed))
    for t in range(2):
        record.event({"t": t})
    with pytest.raises(RecordError, match="the disk is full"):
        record.event({"t": 2})
    if freed:
        record.event({"t": 3})
    with pytest.raises(RecordError, match="the disk is full"):
        record.finish(RESULT)
    assert read_finished_run(tmp_path)["outcome"] == "failure"
    lines = (tmp_path / "trace.jsonl").read_text().splitlines()
    assert lines[:2] == ['{"t":0}', '{"t":1}']
    if freed:
        assert lines[2:] == ['{"t":2}', '{"t":3}']


@pytest.mark.extra
def test_an_error_of_closing_does_not_keep_the_outcome_from_being_written(tmp_path, monkeypatch):
    record = recorder(tmp_path)
    record.begin(static())
    record.frame(truth(0))

    def close(self):
        raise RecordError("the video is broken")

    monkeypatch.setattr(VideoWriter, "close", close)
    record.picture(0.0, np.zeros((48, 64, 3), np.uint8))
    with pytest.raises(RecordError, match="the video is broken"):
        record.finish(RESULT)
    assert read_finished_run(tmp_path)["outcome"] == "failure"
    assert (tmp_path / "truth.npz").exists()


@pytest.mark.parametrize("shape", [(2, 6), None])
def test_measurements_that_cannot_be_written_do_not_keep_the_outcome_from_it(tmp_path, shape):
    record = recorder(tmp_path)
    seen = ScriptedWorld().observe()
    record.measured.sample(seen)
    positions = None if shape is None else np.zeros(shape)
    record.measured.sample(dataclasses.replace(seen, arm_positions=positions, pose_hand_in_map=positions))
    with pytest.raises(RecordError, match=r"measured\.npz cannot be written"):
        record.finish(RESULT)
    assert read_finished_run(tmp_path)["outcome"] == "failure"
    assert not list(tmp_path.glob("measured*"))


def test_an_error_of_the_program_does_not_keep_the_outcome_from_being_written(tmp_path, monkeypatch):
    record = recorder(tmp_path)
    monkeypatch.setattr(MeasuredLog, "write", lambda self, directory: directory + 1)
    with pytest.raises(RecordError, match="is not whole: TypeError"):
        record.finish(RESULT)
    assert read_finished_run(tmp_path)["outcome"] == "failure"


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no /dev/full on this system to fill up")
def test_full_disk_at_the_end_keeps_spool_and_outcome(tmp_path):
    record = recorder(tmp_path)
    record.begin(static())
    record.frame(truth(0))
    (tmp_path / "truth.npz.part").symlink_to("/dev/full")
    with pytest.raises(RecordError, match="the disk is full"):
        record.finish(RESULT)
    assert read_finished_run(tmp_path)["outcome"] == "failure"
    assert len(open_spool(tmp_path / "truth.spool")[1]) == 1
    assert not (tmp_path / "truth.npz").exists()


def test_finished_run_is_not_overwritten(tmp_path):
    recorder(tmp_path).finish(RESULT)
    with pytest.raises(RecordError, match="already holds a finished run"):
        recorder(tmp_path)


def test_trace_hash_follows_the_events(tmp_path):
    hashes = []
    for name, value in (("a", 1), ("b", 1), ("c", 2)):
        record = recorder(tmp_path / name)
        record.event({"t": 0.1, "value": value})
        record.finish(RESULT)
        hashes.append(read_run(tmp_path / name)["trace_hash"])
    assert hashes[0] == hashes[1] != hashes[2]


def test_shapes_are_checked_when_they_are_given(tmp_path):
    record = recorder(tmp_path)
    with pytest.raises(RecordError, match="before the recorder was begun"):
        record.frame(truth(0))
    record.begin(static())
    record.frame(truth(0))
    with pytest.raises(RecordError, match="the first frame has 100"):
        record.frame(truth(1, points=101))
    with pytest.raises(RecordError, match="begun twice"):
        record.begin(static())
    record.close()
    record = recorder(tmp_path)
    record.begin(static())
    with pytest.raises(RecordError, match="at least 100"):
        record.frame(truth(0, points=99))
    record.close()


@pytest.mark.parametrize(
    ("field", "value", "message"),
    [
        ("faces", np.array([[0, 1, 3]]), "0 to 2"),
        ("faces", np.array([[0.0, 1.0, 2.0]]), "integers"),
        ("arm_radii", np.zeros((2, 2)), "arm_radii has shape"),
        ("loops", {"armhole_left": np.arange(3)}, "loops are named"),
        ("person_capsules", np.zeros((2, 7)), "person_capsules has shape"),
        ("neckline", np.array([3]), "0 to 2"),
    ],
)
def test_bad_static_part_is_one_sentence(field, value, message):
    given = static()
    fields = {each.name: getattr(given, each.name) for each in dataclasses.fields(given)}
    with pytest.raises(RecordError, match=message):
        TruthStatic(**(fields | {field: value}))


@pytest.mark.parametrize(
    ("text", "message"),
    [("{", "is damaged"), ("[]", "holds a list"), (json.dumps({"outcome": "won"}), "has outcome 'won'")],
)
def test_damaged_run_json_is_one_sentence(tmp_path, text, message):
    (tmp_path / "run.json").write_text(text)
    with pytest.raises(RecordError, match=message):
        read_finished_run(tmp_path)


def test_missing_record_is_one_sentence(tmp_path):
    with pytest.raises(RecordError, match=r"holds no run\.json"):
        read_run(tmp_path)
    with pytest.raises(RecordError, match="is not a folder"):
        read_run(tmp_path / "nowhere")
    with pytest.raises(RecordError, match="outcome is 'won'"):
        RunResult(outcome="won", reason="", sim_time_s=0.0)  # type: ignore[arg-type] - the mistake under test


@pytest.mark.extra
def test_pictures_are_drawn_beside_the_run_and_all_are_in_the_video_at_the_end(tmp_path):
    recorder = Recorder(tmp_path / "run", task="dressing", seed=0, world="bullet")
    for k in range(4):  # so far apart that none may be left out
        recorder.film(k * PICTURE_GAP_MAX, lambda k=k: np.full((48, 64, 3), 60 * k, np.uint8))
    recorder.finish(RunResult(outcome="success", reason="", sim_time_s=2.0))
    shown = read_pictures(tmp_path / "run" / "video.mp4", [k * PICTURE_GAP_MAX for k in range(4)])
    np.testing.assert_allclose([picture.mean() for picture in shown], [0, 60, 120, 180], atol=6)


def _film_on(recorder):
    for k in range(1, 9):
        recorder.film(k * PICTURE_GAP_MAX, lambda: np.zeros((4, 4, 3), np.uint8))


def test_a_picture_that_cannot_be_added_is_told_with_the_next(tmp_path):
    recorder = Recorder(tmp_path / "run", task="dressing", seed=0, world="bullet")
    recorder.film(0.0, lambda: np.zeros((3, 3, 3), np.uint8))
    with pytest.raises(RecordError, match="even width and height"):
        _film_on(recorder)
    recorder.close()


def test_a_drawing_that_fails_is_one_sentence(tmp_path):
    recorder = Recorder(tmp_path / "run", task="dressing", seed=0, world="bullet")
    recorder.film(0.0, lambda: np.zeros(1) / [][0])
    with pytest.raises(RecordError, match="cannot be drawn: list index out of range"):
        recorder.finish(RunResult(outcome="success", reason="", sim_time_s=2.0))
    assert read_run(tmp_path / "run")["outcome"] == "success"


def test_a_record_without_a_video_draws_nothing(tmp_path):
    recorder = Recorder(tmp_path / "run", task="dressing", seed=0, world="bullet", films=False)
    recorder.film(0.0, lambda: np.zeros(1) / [][0])
    recorder.finish(RESULT)
    assert not (tmp_path / "run" / "video.mp4").exists()
