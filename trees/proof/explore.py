"""Runs a tree with stubs for leaves through every combination of their outcomes, in milliseconds.

Each leaf succeeds, fails in each way that makes a difference to anybody above and in one that nobody reacts to, or,
under a timeout, never ends.  A situation that was met before is not followed again, so the work grows with
the number of situations, not with the number of ways through the tree.

Where every node of the tree resumes what is running, a leaf lets one tick go by before it ends, and the other ways on
begin from what the tree was between these two ticks.  Any other tree is followed from its start each time.
"""

from __future__ import annotations

import gc
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any, Literal, NamedTuple

import py_trees
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from ...sim.scripted.clock import SteppedClock
from ...sim.scripted.world import ScriptedWorld
from ...skills.core.context import Context
from ...skills.core.reasons import Reason
from ...skills.core.skill import Skill
from ..nodes.condition import Condition
from ..nodes.decorators import FailSafe, RecoverBy, Retry, Stage, Timeout, Wrapper
from .memory import Memory
from .quick_nodes import RESUMING, quickened, quickened_wrapper, remembers
from .stub import KeyMissing, Stub

# What the guard or the world can do to any skill, whatever the skill says of itself.
FROM_OUTSIDE = (Reason.FORCE_LIMIT, Reason.SPEED_LIMIT, Reason.SENSOR_LOST, Reason.SENSOR_STALE, Reason.EMERGENCY_STOP)
OTHER = Reason.INTERNAL_ERROR  # stands for every reason that nobody reacts to
TICKS_MAX = 2000
FINDINGS_MAX = 20
ATTEMPTS = 2  # followed of each retry: a third begins as the second one did, with the same data unset


class _Known(Exception):  # noqa: N818 ends an execution, no defect
    """This situation has been explored already."""


class _Round(Exception):  # noqa: N818 a finding about the tree
    """The same situation twice in one execution."""


class _Point(NamedTuple):
    """An execution between two ticks.

    Attributes:
        number: by which the memory of the nodes knows it.
        board: keys written so far.
        time: of the clock [s].
        way: leaves and outcomes so far.
        moved: whether one of them moved the robot outside of a safe branch.
    """

    number: int
    board: frozenset[str]
    time: float
    way: tuple[tuple[Stub, Any], ...]
    moved: bool


class _Branch(NamedTuple):
    """A way to follow: `choices` from `point` on, whatever comes then; `trail` are the situations up to there."""

    point: _Point
    choices: list[int]
    trail: tuple[int, ...]


class Explorer:
    """Explores one tree; the tree's leaves are replaced and it cannot be run afterwards.

    Args:
        root: of the tree.
        limit: executions after which it gives up and says so.

    Attributes:
        board: keys written in the present execution.
        changed: nodes that are no longer as they were at the last point.
        executions: how many were followed.
        situations: how many different ones were met.
        complete: whether everything was explored.
        findings: one sentence for each fault, with the way that leads to it.
    """

    def __init__(self, root: Behaviour, limit: int = 200_000) -> None:
        self.board: set[str] = set()
        self.changed: set[Behaviour] = set()
        self.executions = 0
        self.complete = False
        self.findings: list[str] = []
        self._limit = limit
        world = ScriptedWorld()
        self._clock: SteppedClock = world.time
        self._context = Context(world=world, guard=None)  # type: ignore[arg-type] stubs neither send nor ask the guard
        self._root = self._replace_leaves(root)
        self._nodes = list(self._root.iterate())
        for node in self._nodes:
            if isinstance(node, (Retry, RecoverBy)):
                node.attempts = min(node.attempts, ATTEMPTS)
        self._options = {node: self._outcomes(node) for node in self._nodes if isinstance(node, Stub)}
        self._inner = [node for node in self._nodes if node not in self._options]
        self._forms = {node: _Form.of(node) for node in self._nodes}
        self._timeouts = [node for node in self._nodes if isinstance(node, Timeout)]
        self._resumes = all(_resumes(node) for node in self._inner)
        self._reads, self._writes = self._keys_below("reads"), self._keys_below("writes")
        self._counting = {leaf: _counting(leaf) for leaf in self._options}
        self._read: dict[Any, frozenset[str]] = {}  # by leaf and what tries are left to those above
        self._in_safe = {leaf for node in self._nodes if isinstance(node, FailSafe) for leaf in node.safe.iterate()}
        self._numbers: dict[Any, int] = {}  # of every situation
        self._seen: set[int] = set()
        self._given: list[int] = []  # choices to begin with
        self._taken: list[int] = []  # choices made since the point where this execution began
        self._trail: tuple[int, ...] = ()  # situations of the present execution, those before its point first
        self._way: list[tuple[Stub, Any]] = []
        self._moved = False  # some leaf on that way moved the robot outside of a safe branch
        self._active = {leaf: frozenset((leaf, *(above for above, _ in _ancestors(leaf)))) for leaf in self._options}
        self._asked: Stub | None = None  # the leaf that lets a tick go by
        self._hung = False  # some leaf chose in this tick never to end
        for node in self._inner:
            self._watch(node)
        self.changed.clear()
        self._memory = Memory(self._nodes, self.changed)
        self._point = self._here()
        self._stack = [_Branch(self._point, [], ())]

    @property
    def situations(self) -> int:
        """Different points of decision met."""
        return len(self._seen)

    def explore(self) -> None:
        """Follow every way."""
        collects = gc.isenabled()
        gc.disable()  # what is kept of situations is much and forms no circles: looking for some takes a sixth of all
        try:
            while self._stack:
                if self.executions >= self._limit or len(self.findings) >= FINDINGS_MAX:
                    return
                self.executions += 1
                self._execute(self._stack.pop())
            self.complete = True
        finally:
            self._numbers.clear()  # as much garbage to look through for whatever comes next
            if collects:
                gc.enable()

    def choose(self, leaf: Stub) -> Any:
        """The outcome of `leaf` in this execution: True, a Reason, None for never, or `later` to be asked again."""
        options = self._options[leaf]
        if len(self._taken) < len(self._given):  # an execution followed this way before and knows its situations
            choice = self._given[len(self._taken)]
        elif self._asked is not leaf and self._meet(leaf) == "later":
            return "later"
        else:
            self._asked, choice = None, 0
            ways = [[*self._taken, other] for other in range(1, len(options))]
            self._stack += [_Branch(self._point, way, self._trail) for way in ways]
        self._taken.append(choice)
        self._way.append((leaf, options[choice]))
        self._moved |= leaf.commands and leaf not in self._in_safe
        self._hung |= options[choice] is None
        return options[choice]

    def _meet(self, leaf: Stub) -> Literal["now", "later"]:
        """Note the situation in which `leaf` has to choose; when it shall do so."""
        situation = self._numbers.setdefault(self._situation(leaf), len(self._numbers))
        if situation in self._trail:
            raise _Round(f"the tree goes round for ever at {leaf.name}")
        self._trail = (*self._trail, situation)
        if situation in self._seen:
            raise _Known
        self._seen.add(situation)
        if not self._resumes:
            return "now"
        self._asked = leaf
        return "later"

    def _execute(self, branch: _Branch) -> None:
        self._go_to(branch)
        try:
            for _ in range(TICKS_MAX):
                if self._asked is not None:
                    self._point, self._taken, self._given = self._here(), [], []
                for _ in self._root.tick():
                    pass
                if self._root.status != Status.RUNNING:
                    self._judge()
                    return
                self._pass_time()
            self._find("the tree does not end")
        except _Known:
            return
        except (KeyMissing, _Round) as finding:
            self._find(str(finding))

    def _pass_time(self) -> None:
        """When a leaf hangs, the next timeout is what happens next."""
        running = [node.ends for node in self._timeouts if node.status == Status.RUNNING]
        if self._hung and running:
            self._clock.time = max(self._clock.time, min(running))
        self._hung = False

    def _judge(self) -> None:
        if self._root.status != Status.FAILURE:
            return
        moved = [n for n, (leaf, _) in enumerate(self._way) if leaf.commands and leaf not in self._in_safe]
        if moved and not any(leaf in self._in_safe for leaf, _ in self._way[moved[-1] :]):
            self._find("the tree fails without a safe branch")

    def _find(self, what: str) -> None:
        steps = [f"{leaf.name} {_said(outcome)}" for leaf, outcome in self._way[-6:]]
        more = "... " if len(self._way) > 6 else ""
        self.findings.append(f"{what}, after {more}{', '.join(steps) or 'nothing'}")

    def _watch(self, node: Behaviour) -> None:
        """Hear of every tick and stop of a node; nothing else changes one, but a stage that begins what it counts."""
        change = partial(self.changed.add, node)
        if remembers(node):
            node.tick, node.stop = quickened(node, change)  # type: ignore[arg-type,assignment]
        elif type(node) in RESUMING:
            counted = [below for below in node.iterate() if isinstance(below, (Retry, RecoverBy))]
            begin = partial(self.changed.update, (node, *counted)) if isinstance(node, Stage) else change
            node.tick, node.stop = quickened_wrapper(node, begin, change)  # type: ignore[arg-type,assignment]

    def _here(self) -> _Point:
        return _Point(
            number=self._memory.keep(),
            board=frozenset(self.board),
            time=self._clock.time,
            way=tuple(self._way),
            moved=self._moved,
        )

    def _go_to(self, branch: _Branch) -> None:
        point = branch.point
        if not self._resumes:  # there may be nodes that nobody hears of
            self.changed.update(self._nodes)
        self._memory.go_back(point.number)
        self._point = point
        self.board.clear()
        self.board |= point.board
        self._clock.time, self._way, self._moved = point.time, list(point.way), point.moved
        self._trail = branch.trail
        self._given, self._taken, self._asked, self._hung = branch.choices, [], None, False

    def _situation(self, leaf: Stub) -> Any:
        """All that decides what can happen from here on."""
        return leaf, self._read_from(leaf) & self.board, self._moved, self._state(self._root, self._active[leaf])

    def _read_from(self, leaf: Stub) -> frozenset[str]:
        """Keys that may be read from `leaf` on; what nobody reads changes nothing."""
        left = tuple(above.attempts - above.tried for above in self._counting[leaf])
        keys = self._read.get((leaf, left))
        if keys is None:
            keys = self._read[leaf, left] = self._look_ahead(leaf)
        return keys

    def _look_ahead(self, leaf: Stub) -> frozenset[str]:
        """Keys read by a leaf, by what comes after it, and by all that is tried again while tries are left.

        A body that is tried again reads nothing that it wrote before: its data is unset.
        """
        keys = set(self._reads[leaf])
        for above, child in _ancestors(leaf):
            n = above.children.index(child)
            readers: list[Behaviour] = []
            if remembers(above) or type(above) is FailSafe:
                readers = above.children[n + 1 :]
            elif type(above) is Stage:  # the pre-condition stands after the body, and comes before it
                readers = above.children[:n]
            elif isinstance(above, (Retry, RecoverBy)):
                body, *recoveries = above.children
                left = above.attempts - above.tried
                if child is not body or left > 0:
                    keys |= self._reads[body] - self._writes[body]
                if left > (child is not body):  # a recovery is followed by a try
                    readers = recoveries
            elif type(above) is not Timeout:
                readers = [above]
            keys = keys.union(*(self._reads[reader] for reader in readers))
        return frozenset(keys)

    def _state(self, node: Behaviour, active: frozenset[Behaviour]) -> Any:
        """Of a node at work its status, memory and children; of any other the status only, for it will start afresh."""
        status = node.status
        if node not in active and status is not Status.RUNNING:
            return status._value_  # as text: that of an enum is hashed in Python
        kind: Any = node  # with the attributes that its form says it has
        form = self._forms[node]
        state: list[Any] = [status._value_]
        if form.counts:
            state.append(kind.tried)
        if form.keeps_failure and (not form.recovers or kind.recovering is not None):
            state.append(kind.failure.reason._name_ if kind.failure else None)
        if form.remembers:
            child = kind.current_child
            return (*state, child, child and self._state(child, active))
        return (*state, *(self._state(child, active) for child in node.children))

    def _keys_below(self, what: Literal["reads", "writes"]) -> dict[Behaviour, frozenset[str]]:
        """Keys that may be read, or written, at or below each node."""
        below: dict[Behaviour, frozenset[str]] = {}
        for node in self._nodes:  # children come before their parents
            keys = getattr(node, what) if isinstance(node, Stub) else ()
            below[node] = frozenset(keys).union(*(below[child] for child in node.children))
        return below

    def _outcomes(self, stub: Stub) -> list[Any]:
        """True, then one reason for each way of reacting above, then `never` under a timeout."""
        reacting: list[RecoverBy] = []
        timed = False
        for above, child in _ancestors(stub):
            if child is above.children[0]:  # in the body, not in a recovery
                reacting += [above] if isinstance(above, RecoverBy) else []
                timed |= isinstance(above, Timeout)
        leaf = stub.leaf
        if isinstance(leaf, Condition):
            possible = {leaf.reason}
        else:
            possible = set(leaf.reasons) if isinstance(leaf, Skill) else set()
            possible |= set(FROM_OUTSIDE) if isinstance(leaf, Skill) else set()
        ways: dict[Any, Reason] = {}  # reasons with the same recoveries all the way up lead to the same situations
        for reason in sorted(possible, key=lambda reason: reason.name):
            way = tuple(node.recoveries.get(reason) for node in reacting)
            if any(way):
                ways.setdefault(way, reason)
        return [True, OTHER, *ways.values(), *([None] if timed and isinstance(leaf, Skill) else [])]

    def _replace_leaves(self, root: Behaviour) -> Behaviour:
        if not root.children:
            return Stub(root, self)
        for node in list(root.iterate()):
            if isinstance(node, Wrapper):
                node.bind(self._context)
            for n, child in enumerate(node.children):
                if child.children:
                    continue
                stub = Stub(child, self)
                node.children[n] = stub
                if isinstance(node, py_trees.decorators.Decorator):
                    node.decorated = stub
                if isinstance(node, Stage) and node.precondition is child:
                    node.precondition = stub
                if isinstance(node, RecoverBy):
                    node.recoveries = {r: stub if tree is child else tree for r, tree in node.recoveries.items()}
                policy = getattr(node, "policy", None)
                if isinstance(policy, py_trees.common.ParallelPolicy.SuccessOnSelected):
                    policy.children = [stub if each is child else each for each in policy.children]
        return root


@dataclass(frozen=True)
class _Form:
    """What of a node decides how it goes on; asking its class at every situation takes longer than all else."""

    counts: bool
    recovers: bool
    keeps_failure: bool
    remembers: bool

    @classmethod
    def of(cls, node: Behaviour) -> _Form:
        remembers = isinstance(node, Wrapper) or getattr(node, "memory", False) is True
        return cls(
            counts=isinstance(node, (Retry, RecoverBy)),
            recovers=isinstance(node, RecoverBy),
            keeps_failure=isinstance(node, (FailSafe, RecoverBy)),
            remembers=remembers and isinstance(node, py_trees.composites.Composite),
        )


def _counting(leaf: Stub) -> tuple[Any, ...]:
    """Those above a leaf that try again."""
    return tuple(above for above, _ in _ancestors(leaf) if type(above) in (Retry, RecoverBy))


def _ancestors(node: Behaviour) -> Iterator[tuple[Behaviour, Behaviour]]:
    """Each node above, with the child that leads down."""
    child = node
    while child.parent is not None:
        yield child.parent, child
        child = child.parent


def _resumes(node: Behaviour) -> bool:
    return type(node) in RESUMING or remembers(node)


def _said(outcome: Any) -> str:
    if outcome is None:
        return "never ends"
    return "succeeds" if outcome is True else f"fails ({outcome.name.lower()})"
