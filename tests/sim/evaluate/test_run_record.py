import json

import numpy as np
import pytest
from caretree.sim.errors import RecordError
from caretree.sim.evaluate.run_record import Checks, Judgement, NotRecordedError, RunRecord
from caretree.sim.record.record import RUN_FILE, TRUTH_FILE


@pytest.fixture
def directory(make_record, tmp_path):
    """A record with a parameter and a cup."""
    folder = make_record(tmp_path / "run")
    with np.load(folder / TRUTH_FILE) as stored:
        arrays = {name: stored[name] for name in stored.files}
    arrays["object_cup"] = np.tile([0.1, 0.2, 0.3, 0, 0, 0, 1.0], (len(arrays["t"]), 1))
    np.savez(folder / TRUTH_FILE, **arrays)
    run = json.loads((folder / RUN_FILE).read_text())
    run["parameters"]["build"] = {"seconds": 8.0}
    (folder / RUN_FILE).write_text(json.dumps(run))
    return folder


def test_a_judge_is_given_truth_and_what_was_asked_for_but_not_what_the_tree_says(directory):
    record = RunRecord(directory)
    assert record.parameters == {"seconds": 8.0}
    assert record.object("cup")[-1, :3] == pytest.approx((0.1, 0.2, 0.3))
    assert record.force("left_arm").max() == pytest.approx(2.0)
    assert not hasattr(record, "outcome")
    with pytest.raises(RecordError, match="no object 'mug': there are cup"):
        record.object("mug")
    with pytest.raises(RecordError, match="no part 'nose', but torso"):
        record.force("nose")


@pytest.mark.parametrize(
    ("entries", "said"),
    [
        ({"seed": "x"}, "run.json is damaged: seed is 'x', but a whole number is asked for"),
        ({"seed": 1.5}, "run.json is damaged: seed is '1.5'"),
        ({"parameters": "none"}, "run.json is damaged: parameters is 'none'"),
        ({"parameters": {"build": [3]}}, "run.json is damaged: parameters is"),
    ],
)
def test_an_edited_record_is_one_sentence(directory, entries, said):
    run = json.loads((directory / RUN_FILE).read_text())
    (directory / RUN_FILE).write_text(json.dumps(run | entries))
    with pytest.raises(RecordError, match=said):
        RunRecord(directory)


def test_the_record_is_to_blame_for_a_parameter_that_it_lacks(directory):
    parameters = RunRecord(directory).parameters
    with pytest.raises(NotRecordedError, match=r"run.json is damaged: it lacks the task's parameter 'arm'"):
        parameters["arm"]
    assert parameters.get("arm") is None


def test_checks_collect_numbers_and_problems(directory):
    checks = Checks(RunRecord(directory))
    checks.at_least("held_up", 9.0, 8.0, "s")
    checks.at_most("speed", 0.3, 0.2, "m/s")
    checks.at_least("lost", np.nan, 1.0, "m")
    checks.that(True, "never said")
    checks.unharmed()
    checks.arms_lie()
    found = checks.judgement()
    assert not found.success
    assert found.problems == (
        "speed is 0.3 m/s, at most 0.2 is allowed",
        "lost is nan m, at least 1 is asked for",
    )
    assert found.numbers["held_up_s"] == 9.0
    assert found.numbers["speed_m_per_s"] == 0.3
    assert "robot_depth_head_m" in found.numbers


def test_a_robot_inside_the_person_harms_them(directory):
    with np.load(directory / TRUTH_FILE) as stored:
        arrays = {name: stored[name] for name in stored.files}
    arrays["robot_capsules"][:, 0] = (0.0, 0.3, -0.1, 0.0, 0.3, -0.1, 0.05)
    arrays["holds_arm"][-1, 0] = 1
    np.savez(directory / TRUTH_FILE, **arrays)
    checks = Checks(RunRecord(directory))
    checks.unharmed()
    problems = checks.judgement().problems
    assert any("inside the person's trunk" in problem for problem in problems)
    assert "the robot still holds an arm at the end" in problems


def test_a_judgement_does_not_contradict_itself():
    assert str(Judgement(success=False, problems=("too slow",))) == "did NOT reach its goal\n  - too slow"
    for wrong in ({"success": True, "problems": ("x",)}, {"success": False}):
        with pytest.raises(RecordError, match="without problems"):
            Judgement(**wrong)
