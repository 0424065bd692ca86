import json
from pathlib import Path

import pytest
from caretree.sim.abilities import SupportsInitialStates
from caretree.sim.bullet.world import BulletWorld
from caretree.sim.errors import CaretreeError
from caretree.sim.scripted.world import ScriptedWorld
from caretree.skills import MoveJoint, Retreat
from caretree.skills.core.context import Context
from caretree.trees import tasks
from caretree.trees.cli import main
from caretree.trees.guard.guard import GuardedWorld
from caretree.trees.nodes.decorators import FailSafe, Stage
from caretree.trees.run.runner import run
from caretree.trees.run.task import Task, TaskError, load_task, task_names
from caretree.trees.run.worlds import prepare_stage

GOOD = """
from __future__ import annotations

from dataclasses import dataclass

from caretree.skills.core.ports import Input
from caretree.skills.core.skill import Skill
from caretree.trees.nodes.decorators import FailSafe


@dataclass
class Size:
    metres: float


class Wait(Skill):
    seconds = Input(float, default=0.5)

    def steps(self):
        yield from self.wait(self.seconds)


def build(context, seconds: float = 0.5):
    return FailSafe("safe", Wait("wait", context, seconds=seconds), Wait("stay", context))
"""


def build(task, **params):
    guard = GuardedWorld(ScriptedWorld())
    return task.build(Context(world=guard, guard=guard), **params)


def test_named_tasks_build():
    assert "wave" in task_names()
    for name in task_names():
        world, senses = load_task(name).scripted(0)
        guard = GuardedWorld(world)
        load_task(name).build(Context(world=guard, guard=guard, senses=senses))


@pytest.mark.parametrize(
    ("stage", "count", "begins"),
    [
        (None, 4, ""),
        ("take_down", 1, "gown_on_hook"),
        ("dress", 1, "gown_on_person"),
        ("lay-spread", 3, "gown_in_hands"),
        ("dress-spread", 2, "gown_on_person"),
    ],
)
def test_a_span_of_the_dressing_task_holds_its_stages_and_begins_where_they_do(stage, count, begins):
    task = load_task("dressing")
    root = build(task, **task.parameters(stage))
    assert len([node for node in root.iterate() if isinstance(node, Stage)]) == count
    assert task.initial_state(stage) == begins


def test_every_stage_begins_where_both_rooms_can_begin():
    task = load_task("dressing")
    world, _ = task.scripted(0)
    assert isinstance(world, SupportsInitialStates)
    begins = [*(stage.begins for stage in task.stages.values()), load_task("undress").initial_state(None)]
    assert begins == list(world.initial_states) == list(BulletWorld.initial_states)


def test_a_whole_task_begins_where_its_file_says(tmp_path):
    path = tmp_path / "mine.py"
    path.write_text(f"{GOOD}\n\nBEGINS = 'gown_worn'\n")
    assert load_task(str(path)).initial_state(None) == "gown_worn"
    prepare_stage(ScriptedWorld(), load_task(str(path)), None)  # a room that cannot be prepared is taken as it is
    path.write_text(f"{GOOD}\n\nBEGINS = 3\n")
    with pytest.raises(TaskError, match="BEGINS is the name of a state of the world, not int"):
        load_task(str(path))


@pytest.mark.parametrize("stages", ["{'go-on': TaskStage(build)}", "{'go_on': build}", "['go_on']"])
def test_stages_that_no_command_line_can_name_are_refused(tmp_path, stages):
    path = tmp_path / "mine.py"
    path.write_text(f"{GOOD}\n\nfrom caretree.trees import TaskStage\n\nSTAGES = {stages}\n")
    with pytest.raises(TaskError, match="STAGES is a dictionary of TaskStage by names of letters, digits"):
        load_task(str(path))


def test_a_stage_whose_beginning_the_world_lacks_is_refused():
    task = load_task("dressing")
    with pytest.raises(CaretreeError, match="stage 'lay' begins with 'gown_in_hands', but ScriptedWorld has one begin"):
        prepare_stage(ScriptedWorld(), task, "lay")


def test_a_users_own_file_runs(tmp_path):
    path = tmp_path / "mine.py"
    path.write_text(GOOD)
    task = load_task(str(path))
    assert task.name == "mine"
    result = run(task, ScriptedWorld(), params={"seconds": 2.0})
    assert result.outcome == "success"
    assert 2.0 < result.sim_time_s < 2.5


def test_a_task_may_keep_its_skills_beside_it(tmp_path):
    (tmp_path / "skills_beside_it.py").write_text(GOOD.split("def build")[0])
    (tmp_path / "mine.py").write_text(
        "from skills_beside_it import Wait\n\n\ndef build(context):\n    return Wait('wait', context)\n"
    )
    assert run(load_task(str(tmp_path / "mine.py")), ScriptedWorld()).outcome == "success"


@pytest.mark.parametrize(
    ("change", "line", "said"),
    [
        (lambda text: text.replace("def build(", "def make("), 1, "a task needs a function build(context)"),
        (lambda text: text.replace("    return FailSafe(", "    return FailSafe(("), 24, "was never closed"),
        (lambda text: text.replace("decorators import", "decorator import"), 8, "No module named"),
        (
            lambda text: text.replace("seconds=seconds)", "second=seconds)"),
            24,
            "Wait has no port 'second'; it has seconds",
        ),
        (lambda text: text.replace("    return FailSafe", "    FailSafe"), 23, "build() returned NoneType"),
        (lambda text: text + "\nraise KeyError('x')\n", 26, "KeyError: 'x'"),
        (lambda text: text + "\nraise SystemExit(3)\n", 26, "SystemExit: 3"),
        (
            lambda text: text.replace("from caretree.skills.core.ports", "from ...skills.ports"),
            6,
            "imports by full names",
        ),
        (lambda text: text.replace("seconds=seconds)", 'seconds="long")'), 24, "takes float, but was given str 'long'"),
    ],
)
def test_a_broken_file_is_told_with_its_line(tmp_path, change, line, said):
    path = tmp_path / "mine.py"
    path.write_text(change(GOOD))
    with pytest.raises(TaskError) as error:
        build(load_task(str(path)))
    assert str(error.value).startswith(f"{path}:{line}: ")
    assert said in str(error.value)
    assert "\n" not in str(error.value)


def test_unknown_tasks_files_and_parameters():
    with pytest.raises(
        TaskError, match=r"unknown task 'dance'; there are .*wave.*, or give the path of a \.py or \.xml file"
    ):
        load_task("dance")
    with pytest.raises(TaskError, match=r"task file nowhere/x\.py does not exist"):
        load_task("nowhere/x.py")
    with pytest.raises(TaskError, match=r"wave\.py:\d+: .*unexpected keyword argument 'colour'"):
        build(load_task("wave"), colour="red")


def test_a_task_of_the_package_is_found_by_its_path_too():
    wave = load_task("wave")
    assert load_task(str(Path(tasks.__file__).with_name("wave.py"))) == wave


def test_a_folder_is_no_task_file(tmp_path):
    (tmp_path / "task.py").mkdir()
    with pytest.raises(TaskError, match=r"is a folder, but a \.py file is asked for"):
        load_task(str(tmp_path / "task.py"))


def test_a_joint_that_is_where_it_should_be_need_not_move():
    def build(context):
        move = MoveJoint("up", context, side="left", joint="w1", angle=0.0)
        return FailSafe("safely", move, Retreat("let go", context, hand_distance=0.0, ready="never"))

    assert run(Task("still", build, Path("still.py")), ScriptedWorld()).outcome == "success"


TUNED = '''
from dataclasses import dataclass

from caretree.sim.quantity import Quantities, quantity
from caretree.skills import Input, Skill
from caretree.trees import FailSafe


@dataclass(frozen=True, kw_only=True)
class RestTuning(Quantities):
    """Numbers of a rest."""

    seconds: float = quantity(1.0, "s", "how long it rests", "choice: for a test")


class Rest(Skill):
    """Rests."""

    tuning = Input(RestTuning, default=RestTuning(), doc="its numbers")

    def steps(self):
        yield from self.wait(self.tuning.seconds)


def build(context):
    return FailSafe("safely", Rest("rest", context), Rest("rest again", context))
'''


def run_tuned(tmp_path, monkeypatch, *arguments):
    monkeypatch.chdir(tmp_path)
    Path("tuned.py").write_text(TUNED)
    return main(["run", "tuned.py", "--world", "scripted", "--out", "record", *arguments])


def test_numbers_set_for_a_run_act_and_are_recorded(tmp_path, monkeypatch, capsys):
    assert run_tuned(tmp_path, monkeypatch, "--set", "rest.seconds=4") == 0
    record = json.loads((tmp_path / "record" / "run.json").read_text())
    assert record["sim_time_s"] > 4.0
    assert record["parameters"]["tuning"] == {"rest": {"seconds": 4}}
    assert main(["replay", "record"]) == 0  # with the same numbers, or it would differ


@pytest.mark.parametrize(
    ("setting", "words"),
    [
        ("rest.secs=4", "did you mean seconds"),
        ("rst.seconds=4", "did you mean rest"),
        ("rest.seconds=long", "a number"),
    ],
)
def test_numbers_that_are_not_there_are_refused(tmp_path, monkeypatch, capsys, setting, words):
    assert run_tuned(tmp_path, monkeypatch, "--set", setting) == 2
    assert words in capsys.readouterr().err
    assert not (tmp_path / "record" / "run.json").exists()


FURNISHED = (
    GOOD
    + """

def scene(world, seed):
    from caretree.sim.scene.objects import Box

    world.add(Box(name="table", size=(0.4, 0.4, 0.7), position_in_map=(1.5, 1.0, 0.35)))
    world.remove_gown()
"""
)


def test_a_scene_furnishes_the_scripted_twin_too(tmp_path):
    path = tmp_path / "greet.py"
    path.write_text(FURNISHED)
    world, _ = load_task(str(path)).scripted(0)
    assert list(world.objects) == ["table"]
    assert not world.has_gown


@pytest.mark.parametrize(
    ("added", "words"),
    [
        ("def scene(world):\n    pass\n", r"greet.py:\d+: scene\(world, seed\) is called, but"),
        ("judge = 3\n", "judge is a int, but a function"),
        ("def scene(world, seed):\n    world.add(3)\n", r"greet.py:\d+: AttributeError"),
        ("def scene(world, seed):\n    1 / 0\n", r"greet.py:\d+: ZeroDivisionError"),
    ],
)
def test_a_wrong_scene_or_judge_is_told_with_its_line(tmp_path, added, words):
    path = tmp_path / "greet.py"
    path.write_text(f"{GOOD}\n\n{added}")
    with pytest.raises(TaskError, match=words):
        load_task(str(path)).scripted(0)


def test_what_a_judge_returns_is_checked(tmp_path, make_record):
    path = tmp_path / "greet.py"
    path.write_text(f"{GOOD}\n\ndef judge(record):\n    return True\n")
    with pytest.raises(TaskError, match=r"judge\(\) returned bool, but a Judgement"):
        load_task(str(path)).judged(make_record(tmp_path / "run"))


def test_a_parameter_that_a_task_does_not_have_ends_with_status_2(tmp_path, capsys):
    assert main(["run", "wave", "--world", "scripted", "--out", str(tmp_path / "r"), "--set", "arm=left"]) == 2
    assert "no parameter 'arm'; it has side" in capsys.readouterr().err


def test_a_parameter_is_set_and_recorded(tmp_path):
    out = tmp_path / "r"
    assert main(["run", "wave", "--world", "scripted", "--out", str(out), "--set", "side=right"]) == 0
    assert json.loads((out / "run.json").read_text())["parameters"]["build"] == {"side": "right"}
    assert "right_w1" in (out / "trace.jsonl").read_text()
    assert main(["replay", str(out)]) == 0
