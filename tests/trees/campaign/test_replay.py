import json

import pytest
from caretree.skills import HoldStill
from caretree.trees.campaign.replay import first_difference, replay
from caretree.trees.cli import main


@pytest.fixture
def record(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert (
        main(
            [
                "run",
                "wave",
                "--world",
                "scripted",
                "--seed",
                "5",
                "--out",
                "run",
                "--inject",
                "lost_command@hand up:start",
            ]
        )
        == 0
    )
    return tmp_path / "run"


STAGED = """
from caretree.sim.scripted.world import ScriptedWorld
from caretree.trees import TaskStage
from caretree.skills import MoveJoint, Retreat
from caretree.trees import FailSafe


class Prepared(ScriptedWorld):
    initial_states = ("low", "high")

    def set_initial_state(self, name):
        self._q[:] = {"high": 0.5}[name]


def scripted(seed):
    return Prepared(seed=seed), None


def up(context):
    return MoveJoint("up", context, side="left", joint="w1", angle=0.2)


STAGES = {"start": TaskStage(up, begins="low"), "go_on": TaskStage(up, begins="high")}


def build(context, stages=("start",)):
    safe = Retreat("let go", context, hand_distance=0.0, ready="never")
    return FailSafe("safely", STAGES[stages[0]].build(context), safe)
"""


def test_a_stage_begins_where_it_began(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "staged.py").write_text(STAGED)
    assert main(["run", "staged.py", "--world", "scripted", "--stage", "go_on", "--out", "run"]) == 0
    assert '"goal":[0.7]' in (tmp_path / "run" / "trace.jsonl").read_text()
    assert replay(tmp_path / "run").same


@pytest.mark.parametrize(
    ("parameters", "kind"), [({"world_kind": "easy+falling_arms"}, "easy+falling_arms"), ({}, "easy")]
)
def test_the_world_is_as_hard_as_it_was(record, parameters, kind, monkeypatch):
    run = json.loads((record / "run.json").read_text())
    run["parameters"] = parameters
    (record / "run.json").write_text(json.dumps(run))
    made = []

    def make(name, task, **options):
        made.append(options["kind"])
        return task.scripted(options["seed"])

    monkeypatch.setattr("caretree.trees.campaign.replay.make_world", make)
    replay(record)
    assert made == [kind]


def edit(path, change):
    lines = [json.loads(line) for line in path.read_text().splitlines()]
    path.write_text("".join(json.dumps(each) + "\n" for each in change(lines)))


def test_a_run_repeats_from_its_record(record):
    result = replay(record)
    assert result.same
    assert not result.versions


@pytest.mark.extra
@pytest.mark.parametrize(("inject", "rate"), [([], 3.0), (["--inject", "occlusion@towel/look:start"], 15.0)])
def test_a_rehearsal_is_ticked_more_often_where_a_fault_is_looked_at_and_repeats(tmp_path, monkeypatch, inject, rate):
    monkeypatch.chdir(tmp_path)
    assert main(["run", "hand_towel", "--world", "scripted", "--out", "run", *inject]) == 0
    assert json.loads((tmp_path / "run/run.json").read_text())["parameters"]["rate_hz"] == rate
    assert replay(tmp_path / "run").same


def test_a_changed_trace_is_told_with_its_first_difference(record, capsys):
    def later(events):
        events[3]["t"] += 0.1
        return events

    edit(record / "trace.jsonl", later)
    assert main(["replay", str(record)]) == 1
    assert capsys.readouterr().out.startswith("event 4 differs: it was ")


def test_a_hash_that_is_not_that_of_the_trace_is_told(record, capsys):
    run = json.loads((record / "run.json").read_text())
    (record / "run.json").write_text(json.dumps(run | {"trace_hash": "0" * 64}))
    assert main(["replay", str(record)]) == 1
    said = f"every event is the same, but run.json says {'0' * 64} of a trace of {run['trace_hash']}\n"
    assert capsys.readouterr().out == said


def test_a_shorter_trace_is_told():
    events = [{"t": 0.0, "kind": "node", "node": "a", "status": "RUNNING"}, {"t": 1.0, "kind": "end"}]
    assert first_difference(events, events) == ""
    assert first_difference(events, events[:1]) == "the recorded trace goes on after event 1 with end at 1.0 s {}"
    assert first_difference(events[:1], events) == "the new trace goes on after event 1 with end at 1.0 s {}"


def test_other_versions_are_named(record, capsys):
    run = json.loads((record / "run.json").read_text())
    run["versions"]["numpy"] = "0.1"
    (record / "run.json").write_text(json.dumps(run))
    edit(record / "trace.jsonl", lambda events: events[:-1])
    assert main(["replay", str(record)]) == 1
    assert "versions that changed: numpy: 0.1, now " in capsys.readouterr().out


@pytest.mark.parametrize(
    ("damage", "said"),
    [
        (lambda run: run.unlink(), "it is not a run record"),
        (lambda run: run.write_text("{"), "is damaged"),
        (lambda run: run.write_text(json.dumps({**json.loads(run.read_text()), "outcome": None})), "was cut short"),
        (lambda run: run.write_text(json.dumps({**json.loads(run.read_text()), "seed": "x"})), "is damaged"),
        (
            lambda run: run.write_text(json.dumps({**json.loads(run.read_text()), "task": "gone"})),
            "unknown task 'gone'",
        ),
    ],
)
def test_a_damaged_record_is_one_sentence(record, damage, said, capsys):
    damage(record / "run.json")
    assert main(["replay", str(record)]) == 2
    error = capsys.readouterr().err
    assert said in error
    assert error.count("\n") == 1


def test_an_operator_who_ends_the_second_run_is_no_difference(record, monkeypatch, capsys):
    def press(self):
        raise KeyboardInterrupt

    monkeypatch.setattr(HoldStill, "steps", press)
    assert main(["replay", str(record)]) == 130
    captured = capsys.readouterr()
    assert (captured.out, captured.err) == ("", "caretree: interrupted\n")
