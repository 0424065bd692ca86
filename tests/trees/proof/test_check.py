"""`caretree check` against trees with one planted fault each: it must name the fault, and nothing else."""

import gc
import itertools
import re

import numpy as np
import py_trees
import pytest
from caretree.perception.senses import Senses
from caretree.sim.scripted.world import ScriptedWorld
from caretree.skills.core.ports import Input, Key, Output
from caretree.skills.core.reasons import Reason
from caretree.skills.core.skill import Skill
from caretree.trees.nodes.composers import fallback, parallel, reactive_fallback, sequence
from caretree.trees.nodes.decorators import Condition, FailSafe, RecoverBy, Retry, Stage, Timeout
from caretree.trees.proof.check import check, check_quickly, rehearse
from caretree.trees.proof.explore import Explorer
from caretree.trees.run.task import TaskError, load_task

from ..planted import Release, task_of


class Leaf(Skill):
    """Ends at once."""

    def steps(self):
        yield


class Make(Leaf):
    made = Output(float)
    reasons = (Reason.GRASP_MISSED,)


class Use(Leaf):
    used = Input(float)
    reasons = (Reason.UNREACHABLE,)


class Name(Leaf):
    word = Output(str)


class See(Leaf):
    commands = False
    seen = Output(float)


K = Key("k")


def safe(context, body):
    return FailSafe("safe", body, Release("release", context))


def findings(build):
    return check(task_of(build)).findings


@pytest.mark.extra
def test_the_shipped_tasks_hold():
    from caretree.trees.run.task import task_names

    for name in task_names():
        report = check(load_task(name))
        assert report.ok, (name, report.findings)
        assert report.complete


def test_a_good_tree_holds():
    def build(context):
        return safe(context, sequence("s", Make("make", context, made=K), Use("use", context, used=K)))

    report = check(task_of(build))
    assert report.ok
    assert report.skills == 3
    assert report.executions > 3


@pytest.mark.parametrize(
    ("build", "words"),
    [
        (
            lambda c: sequence("s", Use("use", c, used=K), Make("make", c, made=K)),
            ["input used reads 'k', which is not written on every way to here (written by 'make')"],
        ),
        (lambda c: Use("use", c, used=K), ["(written by nobody)"]),
        (
            lambda c: sequence("s", Name("name", c, word=K), Use("use", c, used=K)),
            ["input used takes float, but 'k' holds str"],
        ),
        (
            lambda c: sequence("s", fallback("f", Make("make", c, made=K), Make("other", c)), Use("use", c, used=K)),
            ["not written on every way to here (written by 'make')"],
        ),
        (lambda c: fallback("f", Make("make", c, made=K), Use("use", c, used=K)), ["not written on every way"]),
        (
            lambda c: sequence(
                "s",
                Make("make", c, made=K),
                RecoverBy("r", Use("use", c, used=K), {Reason.UNREACHABLE: lambda: Make("again", c, made=K)}),
            ),
            [],
        ),
        (
            lambda c: RecoverBy(
                "r",
                sequence("s", Make("make", c, made=K), Use("use", c, used=K)),
                {Reason.UNREACHABLE: lambda: Use("recover", c, used=K)},
            ),
            ["r/recover: input used reads 'k', which is not written on every way"],
        ),
        (
            lambda c: sequence(
                "s",
                Make("first", c, made=K),
                Retry("retry", sequence("body", Use("use", c, used=K), Make("make", c, made=K)), attempts=2),
            ),
            ["retry/body/use: input used reads 'k', which is not written on every way"],
        ),
        (
            lambda c: sequence(
                "s", parallel("p", See("see", c, seen=K), Make("make", c), policy="one"), Use("use", c, used=K)
            ),
            ["not written on every way"],
        ),
        (lambda c: sequence("s", parallel("p", See("see", c, seen=K), Make("make", c)), Use("use", c, used=K)), []),
        (lambda c: sequence("s", Timeout("t", Make("make", c, made=K), seconds=3.0), Use("use", c, used=K)), []),
        (lambda c: sequence("s", Stage("A", None, Make("make", c, made=K)), Use("use", c, used=K)), []),
    ],
)
def test_wiring(build, words):
    found = [each for each in findings(lambda context: safe(context, build(context))) if "input" in each]
    assert len(found) == len(words), found
    for sentence, word in zip(found, words, strict=True):
        assert word in sentence


FORCED = py_trees.decorators


@pytest.mark.parametrize(
    ("build", "after"),
    [
        # a child that failed has written nothing, whatever the decorator above it says
        (lambda c, make, use: sequence("s", FORCED.FailureIsSuccess("force", make), use), "make fails"),
        (lambda c, make, use: fallback("s", FORCED.SuccessIsFailure("force", make), use), "make fails"),
        (lambda c, make, use: sequence("s", FORCED.Inverter("not", make), use), "make fails"),
        # below ForceSuccess nothing fails, so that the next alternative, which writes, is never begun
        (
            lambda c, make, use: sequence(
                "s", fallback("f", FORCED.FailureIsSuccess("force", Leaf("leaf", c)), make), use
            ),
            "leaf succeeds",
        ),
    ],
)
def test_what_is_written_below_a_decorator_that_forces_an_outcome_is_not_counted_on(build, after):
    def tree(context):
        return safe(context, build(context, Make("make", context, made=K), Use("use", context, used=K)))

    found = findings(tree)
    assert "use: input used reads 'k', which is not written on every way to here (written by 'make')" in found[0]
    assert any(f"use reads 'k', which has not been written, after {after}" in each for each in found), (
        "running the stubs finds the same"
    )


@pytest.mark.parametrize("force", [FORCED.FailureIsSuccess, FORCED.SuccessIsFailure, FORCED.Inverter])
def test_what_was_written_before_such_a_decorator_is_there_after_it(force):
    def build(context):
        forced = force("force", Leaf("leaf", context))
        body = fallback("f", sequence("s", forced, Use("use", context, used=K)), Use("else", context, used=K))
        return safe(context, sequence("all", Make("make", context, made=K), body))

    assert findings(build) == []


def test_the_safe_branch_may_not_count_on_the_body():
    def build(context):
        return FailSafe(
            "safe",
            Make("make", context, made=K),
            sequence("s", Use("use", context, used=K), Release("release", context)),
        )

    found = findings(build)
    assert "safe/s/use: input used reads 'k'" in found[0]
    assert any("use reads 'k', which has not been written, after make fails" in each for each in found), (
        "running the stubs finds the same"
    )


@pytest.mark.parametrize(
    ("build", "word"),
    [
        (lambda c: Make("make", c), "moves the robot, but no FailSafe is above it"),
        (lambda c: FailSafe("safe", Make("make", c), See("see", c)), "safe branch moves nothing"),
        (lambda c: safe(c, sequence("s", Make("twice", c), Make("twice", c))), "2 skills are called 'twice'"),
        (lambda c: safe(c, py_trees.decorators.Retry("r", Make("make", c), 3)), "py_trees' Retry keeps the data"),
        (
            lambda c: safe(c, py_trees.decorators.Timeout("t", Make("make", c), 3.0)),
            "py_trees' Timeout counts wall time",
        ),
        (
            lambda c: safe(c, py_trees.composites.Selector("s", memory=False, children=[Make("a", c), Make("b", c)])),
            "could let 'a' and 'b' command in one tick",
        ),
        (
            lambda c: safe(c, py_trees.composites.Sequence("s", memory=False, children=[Make("a", c), Make("b", c)])),
            "starts 'a' again on every tick",
        ),
        (
            lambda c: safe(
                c,
                py_trees.composites.Parallel(
                    "p", py_trees.common.ParallelPolicy.SuccessOnAll(), [Make("a", c), Make("b", c)]
                ),
            ),
            "would wait for each other",
        ),
    ],
)
def test_planted_faults_are_named(build, word):
    report = check(task_of(build))
    assert not report.ok
    assert any(word in each for each in report.findings), report.findings


def test_a_way_round_the_fail_safe_is_found_by_running_it():
    """The body of the fail-safe succeeds, and what moves afterwards fails unprotected."""

    def build(context):
        return sequence("s", safe(context, Make("make", context)), Make("late", context))

    found = findings(build)
    assert any("the tree fails without a safe branch, after make succeeds, late fails" in each for each in found), found


def test_an_idle_recovery_is_noted():
    def build(context):
        return safe(
            context, RecoverBy("r", Use("use", context, used=1.0), {Reason.MULTI_LAYER: lambda: Make("shake", context)})
        )

    report = check(task_of(build))
    assert report.ok
    assert "no skill below says that it fails with multi_layer" in report.notes[0]


def test_a_tree_that_goes_round_forever_is_found():
    class Again(py_trees.decorators.Decorator):
        def update(self):
            return py_trees.common.Status.RUNNING

    found = findings(lambda context: safe(context, Again("again", Make("make", context))))
    assert any("goes round for ever at make" in each for each in found)


def test_every_combination_is_followed():
    """Three leaves that each succeed or fail, in a fallback of a sequence: the ways can be counted by hand."""

    def build(context):
        return sequence("s", *(Condition(name, lambda c: True) for name in "abc"))

    explorer = Explorer(build(None))
    explorer.explore()
    assert explorer.executions == 4, "fff.., sf., ssf, sss"
    assert explorer.situations == 3
    assert explorer.complete


class Forgetful(Explorer):
    """Follows every way to its end, even from situations met before."""

    class _Nothing(set):
        def __contains__(self, item):
            return False

    def __init__(self, root):
        super().__init__(root, limit=3_000)
        self._seen = self._Nothing()


def random_tree(rng, context, depth, names):
    """Any tree that can be built, sound or not."""
    kind = rng.integers(2, 8) if depth > 0 else 0
    name = f"n{next(names)}"
    if kind < 2:
        keys = {"used": Key(f"k{rng.integers(2)}")} if rng.random() < 0.15 else {}
        return (Use if keys else Make)(name, context, **(keys or {"made": Key(f"k{rng.integers(2)}")}))

    def below():
        return random_tree(rng, context, depth - 1, names)

    if kind == 2:
        return sequence(name, below(), below())
    if kind == 3:
        return fallback(name, below(), below())
    if kind == 4:
        return Retry(name, below(), attempts=2)
    if kind == 5:
        reason = (Reason.UNREACHABLE, Reason.GRASP_MISSED)[rng.integers(2)]
        return RecoverBy(name, below(), {reason: below}, attempts=2)
    if kind == 6:
        return Timeout(name, below(), seconds=2.0)
    return safe(context, below())


@pytest.mark.parametrize("seed", range(40))
def test_remembering_situations_hides_nothing(seed):
    """Against following every way of a random tree: the same faults are found, with less work."""
    found = []
    for kind in (Explorer, Forgetful):
        rng = np.random.default_rng(seed)
        explorer = kind(random_tree(rng, _context(), 3, itertools.count()))
        explorer._find = lambda what, e=explorer: e.findings.append(what) if what not in e.findings else None
        explorer.explore()
        found.append((sorted(explorer.findings), explorer.complete))
    if found[1][1]:
        assert found[0] == found[1]


def test_timeouts_expire_in_the_exploration():
    ended = []

    def build(context):
        body = Timeout("in time", See("slow", context), seconds=5.0)
        return fallback("f", body, Condition("instead", lambda c: True))

    explorer = Explorer(task_of(build).build(_context()))
    judge = explorer._judge
    explorer._judge = lambda: (ended.append([(leaf.name, outcome) for leaf, outcome in explorer._way]), judge())
    explorer.explore()
    assert any(way[0] == ("slow", None) and way[1][0] == "instead" for way in ended), ended


def test_a_large_tree_with_recoveries_stays_affordable():
    def build(context):
        def leaf(n):
            return RecoverBy(
                f"r{n}",
                Make(f"m{n}", context),
                {
                    Reason.GRASP_MISSED: lambda: Make(f"x{n}", context),
                    Reason.FORCE_LIMIT: lambda: Make(f"y{n}", context),
                    Reason.SENSOR_STALE: lambda: See(f"z{n}", context),
                },
                attempts=3,
            )

        return safe(context, Retry("retry", sequence("s", *(leaf(n) for n in range(8))), attempts=2))

    report = check(task_of(build))
    assert report.ok, report.findings
    assert report.executions < 500


def test_what_only_a_finished_part_reads_does_not_multiply_the_ways():
    def build(context):
        def part(n):
            key = Key(f"k{n}")
            makes = sequence(f"s{n}", Make(f"m{n}", context, made=key), Use(f"u{n}", context, used=key))
            return fallback(f"f{n}", makes, See(f"do without {n}", context))

        return safe(context, sequence("s", *(part(n) for n in range(8))))

    report = check(task_of(build))
    assert report.ok, report.findings
    assert report.situations == 8 * 3 + 1, "two of them at each part, once more without, and the safe branch"


def test_what_is_read_two_leaves_farther_on_is_told_apart():

    def build(context):
        first = fallback("f", Make("make", context, made=K), See("do without", context))
        body = sequence("s", first, Make("once more", context), Use("use", context, used=K))
        return safe(context, Retry("twice", body, attempts=2))

    assert any("use reads 'k'" in each for each in findings(build))


def test_an_unexplored_rest_is_not_called_proof():
    def build(context):
        return safe(context, sequence("s", *(Make(f"m{n}", context) for n in range(10))))

    explorer = Explorer(task_of(build).build(_context()), limit=3)
    explorer.explore()
    assert not explorer.complete


def test_a_watched_branch_is_explored():
    def build(context):
        return safe(context, reactive_fallback("w", See("see", context), Make("make", context)))

    assert check(task_of(build)).ok


def _context():
    from caretree.sim.scripted.world import ScriptedWorld
    from caretree.skills.core.context import Context
    from caretree.trees.guard.guard import GuardedWorld

    guard = GuardedWorld(ScriptedWorld())
    return Context(world=guard, guard=guard)


def test_a_scripted_twin_has_to_be_whole():
    methods = {name: lambda self, *_, **__: None for name in Senses.__abstractmethods__ - {"head", "arm"}}
    half = type(Senses)("Half", (Senses,), methods)

    def build(context):
        return safe(context, See("see", context, seen=K))

    with pytest.raises(TaskError, match=r"^planted\.py:1: the senses Half lack arm, head$"):
        check(task_of(build, lambda seed: (ScriptedWorld(seed=seed), half())))
    with pytest.raises(TaskError, match=r"^planted\.py:1: scripted\(\) gave dict as senses, which is no Senses$"):
        check(task_of(build, lambda seed: (ScriptedWorld(seed=seed), {"arm": None})))


class Wrong(Leaf):
    def steps(self):
        yield
        raise KeyError("over here")


def test_a_rehearsal_finds_errors_of_the_tasks_own_code():
    assert rehearse(task_of(lambda context: safe(context, Leaf("leaf", context)))).findings == []
    report = rehearse(task_of(lambda context: safe(context, sequence("s", Wrong("wrong", context)))))
    (found,) = report.findings  # once, where it was made
    said = r"safe/s/wrong: on the scripted world, it makes an error: KeyError: 'over here' \(at test_check\.py:\d+\)"
    assert re.fullmatch(said, found)
    missed = rehearse(task_of(lambda context: safe(context, Condition("c", lambda c: False))))
    assert missed.findings == []
    assert missed.notes[0].startswith("on its scripted world it ends as safe stop: The stage could not begin")


def test_the_quick_part_asks_no_combination():
    report = check_quickly(task_of(lambda context: safe(context, Use("use", context, used=K))))
    assert report.findings == [
        "safe/use: input used reads 'k', which is not written on every way to here (written by nobody)"
    ]
    assert report.executions == 0


def test_an_exploration_leaves_the_collection_of_garbage_as_it_was():
    assert gc.isenabled()
    Explorer(task_of(lambda context: safe(context, Make("n", context, made=Key("k")))).build(_context())).explore()
    assert gc.isenabled()
