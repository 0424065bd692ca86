"""The fault campaign: every skill, every phase, every fault, each in a run of its own on a fresh world.

A fault counts as survived when the task still succeeds or ends in the safe stop, and afterwards no hand moves,
no arm is held, and, unless the task succeeded, the fingers are open.
"""

from __future__ import annotations

import collections
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
import py_trees
from py_trees.behaviour import Behaviour

from ...perception.senses import Senses
from ...sim.faults import FAULTS, PHASES, FaultSpec, FaultyWorld
from ...sim.record.record import RunResult
from ...sim.waiting import wait
from ...sim.world import SIDES, World
from ...skills.core.context import Phase
from ...skills.core.reasons import Reason, SkillFailure
from ...skills.core.skill import Skill
from ..nodes.decorators import FailSafe, RecoverBy
from ..run.runner import OPEN, Run
from ..run.task import Task
from ..run.worlds import prepare_stage

FaultKey = tuple[str, str, str]  # node, phase, fault
MakeWorld = Callable[[], tuple[World, Senses | None]]
SETTLE = 1.0  # [s] watched after the end for anything that still moves
MOVED = 0.02  # [rad] or [m] in that time
SIGNS = {"success": "ok", "safe_stop": "stop", "failure": "fail", "not_reached": "-"}


@dataclass(frozen=True, kw_only=True)
class Row:
    """How one injected fault ended.

    Attributes:
        node, phase, fault: what was injected where.
        outcome: of the run, or `not_reached`.
        reason: one sentence.
        unsafe: what was still wrong afterwards; empty when nothing was.
        time_to_safe: world time from the first fault to the end of the run, which stands still [s]; None where the
            fault did not begin.
    """

    node: str
    phase: str
    fault: str
    outcome: str
    reason: str = ""
    unsafe: str = ""
    time_to_safe: float | None = None

    @property
    def key(self) -> FaultKey:
        """What identifies the row."""
        return self.node, self.phase, self.fault

    @property
    def survived(self) -> bool:
        """Whether it ended in recovery or in the safe stop, and safely."""
        return not self.unsafe and self.outcome in ("success", "safe_stop", "not_reached")

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        return asdict(self)


class Campaign:
    """All faults at all nodes of one task.

    Args:
        task: to try.
        make_world: a fresh world, and senses if they are scripted, for every run.
        seed: of every run.
        faults: which ones.
        stage: run this stage alone, or a span of them; None for the whole task.

    Attributes:
        nominal: outcome without any fault.
        nodes: skills in the order of the tree.
    """

    def __init__(
        self,
        task: Task,
        make_world: MakeWorld,
        *,
        seed: int = 0,
        faults: tuple[str, ...] = FAULTS,
        stage: str | None = None,
    ) -> None:
        self._task = task
        self._stage = stage
        self._make_world = make_world
        self._seed = seed
        self._faults = faults
        self._reached: set[tuple[str, str]] = set()
        self._missed: set[tuple[str, str]] = set()  # places that a run of their own did not come to
        run = self._prepare(())
        self.nodes = [node.name for node in run.root.iterate() if isinstance(node, Skill)]
        self._movers = {node.name for node in run.root.iterate() if isinstance(node, Skill) and node.commands}
        self._safe = {
            leaf.name
            for node in run.root.iterate()
            if isinstance(node, FailSafe)
            for leaf in node.safe.iterate()
            if isinstance(leaf, Skill)
        }
        order: list[str] = []
        run.context.observers.append(lambda node, phase: self._reached.add((node, phase)))
        run.context.observers.append(lambda node, phase: order.append(node) if phase == "step" else None)
        self.nominal = _finished(run)
        run.world.close()
        moving = [node for node in order if node in self._movers]
        # to see the safe branch at work, the run is stopped where it is deepest in the task
        self._interrupt_at = moving[-1] if moving else None
        self._triggers = triggers_of(run.root)

    def plan(self) -> list[FaultKey]:
        """Every node, phase and fault."""
        return [(node, phase, fault) for node in self.nodes for phase in PHASES for fault in self._faults]

    def rows(self, keys: Iterable[FaultKey] | None = None) -> Iterator[Row]:
        """One row after the other: those of `keys`, or of the whole plan."""
        for key in self.plan() if keys is None else keys:
            yield self._row(*key)

    def _row(self, node: str, phase: str, fault: str) -> Row:
        stop_at, trigger = self._stop_at(node, phase), self._triggers[node]
        needed = (node, "step") if phase == "cancel" else (node, phase)
        reachable = stop_at is not None if node in self._safe else needed in self._reached or bool(trigger)
        if not reachable or self._missed & {(node, "start"), (node, phase)}:
            return Row(node=node, phase=phase, fault=fault, outcome="not_reached")
        run = self._prepare((FaultSpec(fault, node, phase),))
        if stop_at is not None:
            run.context.observers.append(lambda name, now: _stop(run, name, now, stop_at))
        if trigger and needed not in self._reached:
            run.context.observers.append(_Fail(trigger, needed))
        world = run.world
        assert isinstance(world, FaultyWorld)
        try:
            result = _finished(run)
            if not world.begun:  # whatever the fault
                self._missed.add((node, phase))
                return Row(node=node, phase=phase, fault=fault, outcome="not_reached")
            return Row(
                node=node,
                phase=phase,
                fault=fault,
                outcome=result.outcome,
                reason=result.reason,
                unsafe=unsafe_after(run, result.outcome),
                time_to_safe=round(result.sim_time_s - world.begun[0][1], 2),
            )
        finally:
            world.close()

    def _stop_at(self, node: str, phase: str) -> str | None:
        """The skill during which the operator stops the run, where that is how to reach the phase."""
        if node in self._safe:
            return self._interrupt_at
        return node if phase == "cancel" else None

    def _prepare(self, faults: tuple[FaultSpec, ...]) -> Run:
        inner, senses = self._make_world()
        prepare_stage(inner, self._task, self._stage)
        parameters = self._task.parameters(self._stage)
        return Run(self._task, FaultyWorld(inner, faults), seed=self._seed, senses=senses, params=parameters)


def _finished(run: Run) -> RunResult:
    """Run to the end; a run that the operator ended says nothing of the fault.

    Raises:
        KeyboardInterrupt: it was.
    """
    result = run.run()
    if run.interrupted:
        raise KeyboardInterrupt
    return result


def triggers_of(root: Behaviour) -> dict[str, dict[str, Reason]]:
    """What must fail, and why, for a skill to run at all: skill -> skills -> reason; empty where nothing need fail.

    A recovery runs when its body fails for one of its reasons, an alternative when all before it have failed.
    """
    return {leaf.name: _needed(leaf) for leaf in root.iterate() if isinstance(leaf, Skill)}


def _needed(leaf: Behaviour) -> dict[str, Reason]:
    made: dict[str, Reason] = {}
    child = leaf
    while child.parent is not None:
        above = child.parent
        if isinstance(above, RecoverBy) and child is not above.body:
            reason = next(reason for reason, tree in above.recoveries.items() if tree is child)
            made |= dict.fromkeys(_deciding(above.body), reason)
        elif isinstance(above, py_trees.composites.Selector):
            for earlier in above.children[: above.children.index(child)]:
                made |= dict.fromkeys(_deciding(earlier), Reason.INTERNAL_ERROR)  # nobody recovers from that
        child = above
    return made


def _deciding(node: Behaviour) -> list[str]:
    """Skills whose failure makes `node` fail, the earliest ones."""
    if isinstance(node, Skill):
        return [node.name]
    if isinstance(node, py_trees.composites.Selector):
        return [name for child in node.children for name in _deciding(child)]
    return next((found for child in node.children if (found := _deciding(child))), [])


class _Fail:
    """Makes skills fail, as if by their own doing, until the run has come to where it should."""

    def __init__(self, skills: Mapping[str, Reason], goal: tuple[str, str]) -> None:
        self._skills, self._goal, self._armed = skills, goal, True

    def __call__(self, name: str, phase: Phase) -> None:
        if (name, phase) == self._goal:
            self._armed = False
        elif self._armed and name in self._skills and phase == "start":
            raise SkillFailure(self._skills[name], "made to fail by the campaign")


def _stop(run: Run, name: str, phase: Phase, at: str) -> None:
    if name == at and phase == "step":
        run.request_stop(Reason.INTERRUPTED)


def unsafe_after(run: Run, outcome: str) -> str:
    """What is still wrong after a run: something moves, an arm is held, fingers are closed; empty when nothing is."""
    world = run.world.inner if isinstance(run.world, FaultyWorld) else run.world
    before = world.observe()
    wait(world.clock, world.clock.now() + SETTLE)
    after = world.observe()
    if np.abs(after.arm_positions - before.arm_positions).max() > MOVED:
        return "an arm still moves"
    if np.abs(after.pose_base_in_map - before.pose_base_in_map).max() > MOVED:
        return "the base still moves"
    for n, side in enumerate(SIDES):
        if run.guard.grip(side) == "arm" and after.gripper_opening[n] < OPEN:
            return f"the {side} hand still holds the person's arm"
        if outcome != "success" and after.gripper_opening[n] < OPEN:
            return f"the {side} hand is still closed"
    return ""


def table(rows: list[Row]) -> str:
    """One line for each node and phase, one column for each fault, and the count of outcomes."""
    faults = list(dict.fromkeys(row.fault for row in rows))
    cells = {row.key: "UNSAFE" if row.unsafe else SIGNS[row.outcome] for row in rows}
    places = list(dict.fromkeys((row.node, row.phase) for row in rows))
    head = ["node", "phase", *faults]
    lines = [head, *([*place, *(cells.get((*place, fault), "") for fault in faults)] for place in places)]
    widths = [max(len(line[n]) for line in lines) for n in range(len(head))]
    text = ["  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)).rstrip() for line in lines]
    counts = collections.Counter(row.outcome for row in rows)
    bad = [row for row in rows if not row.survived]
    text += ["", ", ".join(f"{counts[outcome]} {outcome.replace('_', ' ')}" for outcome in SIGNS if counts[outcome])]
    text += [
        f"not survived: {row.fault}@{row.node}:{row.phase}: {row.outcome}, {row.unsafe or row.reason}" for row in bad
    ]
    return "\n".join(text)
