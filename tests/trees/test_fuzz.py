"""Input of every kind, damaged at random: one sentence or a run that ends safely, never a traceback or a hang.

A few hundred inputs, the same every time; `CARETREE_FUZZ=10000 pytest tests/trees/test_fuzz.py` tries so many, others
every time.
"""

import contextlib
import io
import json
import os
import shutil
import tempfile
from dataclasses import replace
from pathlib import Path

import pytest
from caretree.sim.command_line import BAD_INPUT
from caretree.sim.errors import CaretreeError
from caretree.sim.faults import FAULTS, PHASES
from caretree.skills import HoldStill, MoveJoint, Retreat
from caretree.skills.core.reasons import Reason, SkillFailure
from caretree.skills.core.skill import Skill
from caretree.trees import FailSafe, RecoverBy, Retry, Stage, Timeout, fallback, parallel, sequence
from caretree.trees.cli import main
from caretree.trees.commands.export import exported
from caretree.trees.guard.limits import DEFAULT
from caretree.trees.nodes.condition import Condition
from caretree.trees.proof.check import check
from caretree.trees.run.runner import Run
from caretree.trees.run.task import load_task
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from .planted import task_of

KINDS = 8  # of input, one test each
WANTED = int(os.environ.get("CARETREE_FUZZ", "0"))
EXAMPLES = max(1, WANTED // KINDS) if WANTED else 25
STATUSES = {0, 1, BAD_INPUT}  # documented in docs/first-run.md; nobody presses Ctrl-C here
CHECKS = [HealthCheck.too_slow, HealthCheck.function_scoped_fixture, HealthCheck.data_too_large]

fuzz = settings(
    max_examples=EXAMPLES, deadline=None, derandomize=not WANTED, database=None, suppress_health_check=CHECKS
)
odd_text = st.text(max_size=12) | st.sampled_from(
    ["", "\x00", "\ud800", "\u202e", "../..", "nan", "1e999", "-1", "~", "9" * 5000]
)
odd_value = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | odd_text,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=5,
)


@pytest.fixture(autouse=True)
def in_an_empty_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    before = list(Skill.registry)
    yield
    Skill.registry[:] = before


@pytest.fixture(scope="module")
def record():
    """A finished run of the wave on the scripted world."""
    with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
        assert main(["run", "wave", "--world", "scripted", "--out", f"{folder}/run"]) == 0
        yield Path(folder) / "run"


def answer(*argv):
    """Exit status of a command; what it says on stderr is one sentence, and there only where something is wrong."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            status = main(list(argv))
        except SystemExit as end:  # of --help and --version
            status = end.code
    told = err.getvalue()
    assert status in STATUSES, (argv, status, told)
    assert "Traceback" not in told + out.getvalue(), (argv, told)
    assert told.count("\n") == (status == BAD_INPUT), (argv, status, told)
    return status


def damaged(draw, text):
    """`text` with a piece left out, doubled, moved or replaced."""
    first = draw(st.integers(0, len(text)))
    last = draw(st.integers(first, min(len(text), first + 30)))
    other = draw(st.integers(0, len(text)))
    piece = draw(st.sampled_from(["", 2 * text[first:last], text[other : other + 20]]) | odd_text)
    return text[:first] + piece + text[last:]


COMMANDS = ("check", "skills", "export", "completion", "report", "replay", "evaluate", "new", "run", "inject")
OPTIONS = (
    "--tree --seed --world --stage --sample --set --tuning --inject --fault --gown --world-kind --json --help -n --"
)
WORDS = (*COMMANDS, *OPTIONS.split(), *["wave", "dressing", "xml", "bash", "lay", "occlusion", "easy+", "@", ":", "0"])


@fuzz
@given(st.sampled_from(COMMANDS), st.lists(st.sampled_from(WORDS) | odd_text, max_size=5))
def test_command_lines(command, words):
    answer(command, *words, *(["--world", "scripted"] if command in ("run", "inject") else []), "--nowhere")
    if command in ("check", "skills", "export", "evaluate", "report", "replay", "completion"):
        answer(command, *(word for word in words if word != "dressing"))


@fuzz
@given(
    st.one_of(odd_text, st.integers().map(str), st.builds("{}-{}".format, st.integers(), st.integers())),
    st.one_of(odd_text, st.sampled_from(["hand up", "wait"])),
    st.sampled_from((*FAULTS, "x", "")),
    st.sampled_from((*PHASES, "x", "")),
)
def test_options(number, node, fault, phase):
    answer("trials", "no-such-task.py", "--seeds", number, "--jobs", "0")
    answer("run", "wave", "--world", "scripted", "--seed", number, "--stage", "none")
    answer("run", "wave", "--world", "scripted", "--inject", f"{fault}@{node}:{phase}", "--gown", number or "x")
    answer("run", "wave", "--world", "scripted", "--set", f"move_joint.{node}={number}", "--stage", "none")


YAML = "move_joint: {speed: 0.4, tolerance: &a 0.1}\nhold_still: {seconds: *a}\nx: [&b [1, 1], *b]\n<<: {a: 1e3}\n"


@fuzz
@given(st.data())
def test_tuning_files(data):
    text = data.draw(st.text(max_size=40)) if data.draw(st.booleans()) else damaged(data.draw, YAML)
    Path("t.yaml").write_text(text, encoding="utf-8", errors="surrogatepass")
    answer("run", "wave", "--world", "scripted", "--tuning", "t.yaml", "--stage", "none")


TASK_FILE = """from caretree.skills import HoldStill, MoveJoint, Reason, Retreat
from caretree.trees import Condition, FailSafe, RecoverBy, Retry, Stage, Timeout, sequence


def warm(context):
    return context.now() >= 0


def build(context):
    up = MoveJoint("up", context, side="left", joint="w1", angle=0.3)
    again = RecoverBy("again", up, {Reason.COMMAND_LOST: lambda: HoldStill("wait", context)}, attempts=3)
    body = Stage("wave", Condition("warm", warm), Timeout("in time", Retry("r", again, attempts=2), seconds=9.0))
    return FailSafe("safely", sequence("s", body), Retreat("let go", context, hand_distance=0.0, ready="never"))
"""


@fuzz
@given(st.data())
def test_task_files(data):
    Path("t.py").write_text(damaged(data.draw, TASK_FILE), encoding="utf-8", errors="surrogatepass")
    if answer("check", "t.py") == 0:
        shutil.rmtree("r", ignore_errors=True)
        answer("run", "t.py", "--world", "scripted", "--out", "r")


class Does(Skill):
    """Ends as it is told."""

    how = None

    def steps(self):
        if self.how is spin:
            spin()
        yield
        if isinstance(self.how, BaseException):
            raise self.how
        if self.how == "recursion":
            self.how.__class__ = self.steps()  # a mistake of its own


def spin(*unused):
    while True:
        pass


ERRORS = (SystemExit(3), GeneratorExit(), StopIteration(), RecursionError(), MemoryError(), BaseException("x"))
ENDS = (None, None, None, "recursion", SkillFailure(Reason.GRASP_MISSED), *ERRORS, KeyError("\ud800"), spin)


@st.composite
def trees(draw):
    """A function that builds a tree at random."""
    names = draw(st.lists(odd_text, min_size=8, max_size=8))
    shape = draw(st.lists(st.integers(0, 10), min_size=1, max_size=8))
    ends = draw(st.lists(st.sampled_from(ENDS), min_size=8, max_size=8))

    def leaf(context, kind, name, end):
        if kind == 0:
            return HoldStill(name, context)
        if kind == 1:
            return MoveJoint(name, context, side="left", joint="w1", angle=0.1)
        if kind == 2:
            return Condition(name, spin if end is spin else lambda context: end)
        made = Does(name, context)
        made.how = end
        return made

    def around(context, kind, name, body):
        if kind == 5:
            return Retry(name, body, attempts=2)
        if kind == 6:
            return Timeout(name, body, seconds=2.0)
        if kind == 7:
            return Stage(name, None, body)
        if kind == 8:
            return RecoverBy(name, body, {Reason.GRASP_MISSED: lambda: HoldStill(name + "r", context)})
        return parallel(name, body, body)  # the same twice: no tree

    def build(context):
        nodes = []
        for kind, name, end in zip(shape, names, ends, strict=False):
            name += str(len(nodes)) + str(kind)
            if kind <= 4 or not nodes:
                nodes.append(leaf(context, kind, name, end))
            elif kind == 9:
                nodes = [(fallback if len(name) % 2 else sequence)(name, *nodes)]
            else:
                nodes.append(around(context, kind, name, nodes.pop()))
        safe = Retreat("let go", context, hand_distance=0.0, ready="never")
        return FailSafe("safely", nodes[0] if len(nodes) == 1 else sequence("all", *nodes), safe)

    return build


@fuzz
@given(st.data())
def test_trees(data):
    """A tree that is refused is refused by an error of the project; any other ends, and its hands are open."""
    task = task_of(data.draw(trees()))
    world, senses = task.scripted(0)
    try:
        run = Run(task, world, senses=senses, limits=replace(DEFAULT, tick=0.5, run=30.0))
    except CaretreeError:
        return
    result = run.run()
    assert result.outcome in ("success", "failure", "safe_stop")
    if result.outcome == "safe_stop":
        assert world.observe().gripper_opening.min() > 0.07
    hangs = any(spin in (getattr(node, "how", None), getattr(node, "test", None)) for node in run.root.iterate())
    if not hangs:  # check waits a minute
        check(task)


@fuzz
@given(st.data())
def test_records(record, data):
    shutil.rmtree("r", ignore_errors=True)
    shutil.copytree(record, "r")
    for name in ("run.json", "trace.jsonl"):
        path = Path("r") / name
        how = data.draw(st.sampled_from(["whole", "text", "value"]))
        if how == "text":
            path.write_text(damaged(data.draw, path.read_text()), encoding="utf-8", errors="surrogatepass")
        elif how == "value" and name == "run.json":
            run = json.loads(path.read_text())
            target = data.draw(st.sampled_from([run, run["parameters"], run["versions"]]))
            target[data.draw(st.sampled_from(sorted(target)) | odd_text)] = data.draw(odd_value)
            path.write_text(json.dumps(run), encoding="utf-8")
    Path("r/report.html").unlink(missing_ok=True)
    for command in ("replay", "report", "evaluate"):
        answer(command, "r")


@fuzz
@given(st.data())
def test_rows_of_campaigns(data):
    row = {"node": "wait", "phase": "step", "fault": "occlusion", "outcome": "success", "reason": "", "unsafe": ""}
    rows = [json.dumps(row | data.draw(st.dictionaries(st.sampled_from(sorted(row)), odd_value, max_size=2)))]
    rows.append(damaged(data.draw, json.dumps(row)))
    Path("i").mkdir(exist_ok=True)
    Path("i/inject.jsonl").write_text("\n".join(rows), encoding="utf-8", errors="surrogatepass")
    answer("inject", "wave", "--fault", "occlusion", "--sample", "1", "--out", "i")


@fuzz
@given(st.data())
def test_trees_in_xml(data):
    text = exported(load_task("wave"), folder=Path(".")).partition("<TreeNodesModel>")[0] + "</root>"
    Path("t.xml").write_text(damaged(data.draw, text), encoding="utf-8", errors="surrogatepass")
    answer("check", "t.xml")
