"""Proof before motion: `caretree check TASK` shows that the wiring holds and that every failure ends safely."""

from __future__ import annotations

import collections
import unicodedata
from dataclasses import dataclass, field
from typing import Any

import py_trees
from py_trees.behaviour import Behaviour
from py_trees.common import ParallelPolicy

from ...sim.errors import CaretreeError
from ...skills.core.context import Context
from ...skills.core.reasons import Reason
from ...skills.core.skill import Skill
from ..guard.guard import GuardedWorld
from ..nodes.composers import commanding
from ..nodes.condition import Condition
from ..nodes.decorators import FailSafe, RecoverBy, Retry, Wrapper
from ..run.runner import Run
from ..run.task import Task
from ..run.trace import paths_of
from ..run.worlds import tick_rate_of
from .explore import FROM_OUTSIDE, Explorer
from .leaves import leaf_findings
from .wiring import Wiring

# py_trees' own nodes that break a law of this project when skills are below them.
REFUSED = {
    py_trees.decorators.Retry: "keeps the data of failed attempts; use caretree.trees.decorators.Retry",
    py_trees.decorators.Repeat: "keeps the data of earlier rounds; build the body as often as it is needed",
    py_trees.decorators.Timeout: "counts wall time; use caretree.trees.decorators.Timeout",
    py_trees.decorators.EternalGuard: "refuses numpy's truth values; use reactive_fallback() or a Condition",
}


@dataclass
class CheckReport:
    """What a check found.

    Attributes:
        findings: one sentence for each fault; empty when the task holds.
        notes: oddities that harm nobody.
        skills: number of skills.
        executions: ways followed with stub leaves.
        situations: different points of decision met.
        complete: whether all were followed.
    """

    findings: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    skills: int = 0
    executions: int = 0
    situations: int = 0
    complete: bool = False

    @property
    def ok(self) -> bool:
        """Whether the task may run."""
        return not self.findings and self.complete


def check(task: Task) -> CheckReport:
    """Check a task without moving anything.

    Raises:
        TaskError: the tree cannot even be built.
    """
    report = check_quickly(task)
    explorer = Explorer(fresh_tree(task))
    explorer.explore()
    report.findings += explorer.findings
    report.executions, report.situations, report.complete = explorer.executions, explorer.situations, explorer.complete
    if not explorer.complete and not explorer.findings:
        report.findings.append(f"the tree is too large to prove: gave up after {explorer.executions} executions")
    return report


def check_quickly(task: Task, stage: str | None = None) -> CheckReport:
    """The part of a check that takes no time: names, nodes, leaves, fail-safes and wiring; `caretree run` asks for it.

    Args:
        task: to check.
        stage: that is run alone, or a span of them; None for the whole task.

    Raises:
        TaskError: the tree cannot even be built, or there is no such stage.
    """
    report = CheckReport()
    root, context = _built(task, **task.parameters(stage))
    paths = paths_of(root)
    report.skills = sum(isinstance(node, Skill) for node in root.iterate())
    report.findings += _names(root) + _nodes(root, paths) + _fail_safes(root, paths)
    report.findings += leaf_findings(root, context, paths)
    report.notes += _idle_recoveries(root, paths)
    wiring = Wiring(paths)
    wiring.check(root)
    report.findings += wiring.findings
    return report


def refuse_faulty(task: Task, stage: str | None, otherwise: str = "") -> None:
    """Refuse a task with faults that show without running it.

    Args:
        task: to check.
        stage: that is run alone, or a span of them; None for the whole task.
        otherwise: what else can be done, for the reader.

    Raises:
        CaretreeError: it has some.
    """
    findings = check_quickly(task, stage).findings
    if findings:
        more = f", and {len(findings) - 1} more" if len(findings) > 1 else ""
        told = ", ".join([f"`caretree check {task.file}` tells all", *([otherwise] if otherwise else [])])
        raise CaretreeError(f"{findings[0]}{more}; {told}")


def rehearse(task: Task) -> CheckReport:
    """Run the task once on its scripted world: errors of its own code are findings, another bad end is a note.

    Raises:
        TaskError: the tree cannot even be built.
    """
    report = CheckReport(complete=True)
    world, senses = task.scripted(0)
    try:
        run = Run(task, world, rate_hz=tick_rate_of(world), senses=senses)
        result = run.run()
    finally:
        world.close()
    if run.interrupted:
        raise KeyboardInterrupt
    errors: dict[str, str] = {}  # by what happened: the leaf tells it first, then those above
    for event in run.trace.events:
        if event.get("reason") == Reason.INTERNAL_ERROR.name and event.get("detail"):
            errors.setdefault(event["detail"], event["node"])
    report.findings += [f"{node}: on the scripted world, it makes an error: {error}" for error, node in errors.items()]
    report.findings += _undeclared(run)
    if run.context.errors and not errors:  # a node of py_trees' own, or the runner
        error = run.context.errors[0].strip().splitlines()[-1]
        cause = "" if error in result.reason else f"; before that, {error}"
        report.findings.append(f"on its scripted world: {result.reason}{cause}")
    elif result.outcome != "success" and not errors:
        report.notes.append(f"on its scripted world it ends as {result.outcome.replace('_', ' ')}: {result.reason}")
    return report


ANY_SKILL = (*FROM_OUTSIDE, Reason.TIMEOUT, Reason.WORLD_LOST, Reason.INTERRUPTED, Reason.INTERNAL_ERROR)


def _undeclared(run: Run) -> list[str]:
    """Skills that failed with a reason that they do not name, so that no recovery from it was explored."""
    skills = {path: node for node, path in paths_of(run.root).items() if isinstance(node, Skill)}
    told: dict[str, None] = {}
    for event in run.trace.events:
        skill, reason = skills.get(event.get("node", "")), event.get("reason")
        if skill is not None and reason and reason not in {r.name for r in (*skill.reasons, *ANY_SKILL)}:
            kind = type(skill).__name__
            told[f"{event['node']}: failed with {reason}, which the reasons of {kind} do not name"] = None
    return list(told)


def fresh_tree(task: Task) -> Behaviour:
    """The task's tree, built on its scripted world.

    Raises:
        TaskError: it cannot be built.
    """
    return _built(task)[0]


def _built(task: Task, **params: Any) -> tuple[Behaviour, Context]:
    world, senses = task.scripted(0)
    guard = GuardedWorld(world)
    context = Context(world=guard, guard=guard, senses=senses)
    root = task.build(context, **params)
    for node in root.iterate():
        if isinstance(node, (Wrapper, Condition)):
            node.bind(context)
    return root, context


def _names(root: Behaviour) -> list[str]:
    counts = collections.Counter(node.name for node in root.iterate() if isinstance(node, Skill))
    # A terminal would obey a control character in a name that it shows.
    unshown = [node.name for node in root.iterate() if any(unicodedata.category(c) == "Cc" for c in node.name)]
    return [f"a node is called {name!r}; a name holds no control characters" for name in unshown] + [
        f"{count} skills are called {name!r}, but faults and records find a skill by its name"
        for name, count in counts.items()
        if count > 1
    ]


def _nodes(root: Behaviour, paths: dict[Behaviour, str]) -> list[str]:
    found = []
    for node in root.iterate():
        movers = [child.name for child in node.children if commanding(child)]
        where = paths[node]
        for kind, why in REFUSED.items():
            if isinstance(node, kind) and any(isinstance(leaf, Skill) for leaf in node.iterate()):
                found.append(f"{where}: py_trees' {kind.__name__} {why}")
        if isinstance(node, py_trees.composites.Selector) and node.memory is not True and len(movers) > 1:
            found.append(
                f"{where}: a selector without memory could let {movers[0]!r} and {movers[1]!r} command in one "
                "tick; use fallback()"
            )
        if isinstance(node, py_trees.composites.Sequence) and node.memory is not True and len(movers) > 1:
            found.append(f"{where}: a sequence without memory starts {movers[0]!r} again on every tick; use sequence()")
        if isinstance(node, py_trees.composites.Parallel):
            if len(movers) > 1:
                found.append(f"{where}: {movers[0]!r} and {movers[1]!r} would wait for each other; use sequence()")
            if not isinstance(node.policy, ParallelPolicy.Base):
                found.append(f"{where}: policy {node.policy!r} is no ParallelPolicy; use parallel()")
    return found


def _fail_safes(root: Behaviour, paths: dict[Behaviour, str]) -> list[str]:
    covered: set[Behaviour] = set()
    found = []
    for node in root.iterate():
        if isinstance(node, FailSafe):
            covered |= set(node.iterate())
            if not commanding(node.safe):
                found.append(f"{paths[node]}: its safe branch moves nothing, so it cannot release or back off")
    return found + [
        f"{paths[leaf]}: it moves the robot, but no FailSafe is above it"
        for leaf in commanding(root)
        if leaf not in covered
    ]


def _idle_recoveries(root: Behaviour, paths: dict[Behaviour, str]) -> list[str]:
    notes = []
    for node in root.iterate():
        if isinstance(node, Retry) and node.attempts == 1:
            notes.append(f"{paths[node]}: one attempt is no retry")
        if not isinstance(node, RecoverBy):
            continue
        leaves = [leaf for leaf in node.body.iterate() if not leaf.children]
        said = {reason for leaf in leaves for reason in getattr(leaf, "reasons", ())} | set(FROM_OUTSIDE)
        said |= {getattr(leaf, "reason", None) for leaf in leaves}  # of conditions
        notes += [
            f"{paths[node]}: no skill below says that it fails with {reason.name.lower()}; that recovery is idle"
            for reason in node.recoveries
            if reason not in said
        ]
    return notes
