"""Quickened nodes against py_trees' own: the same leaves are ticked, and every node ends up as it would have."""

import itertools
from types import SimpleNamespace

import numpy as np
import py_trees
import pytest
from caretree.skills.core.reasons import Failure, Reason
from caretree.trees.nodes.decorators import FailSafe, RecoverBy, Retry, Stage, Timeout
from caretree.trees.proof.quick_nodes import RESUMING, quickened, quickened_wrapper, remembers
from py_trees.common import Status


class Leaf(py_trees.behaviour.Behaviour):
    """Ends as a list says, one entry per tick."""

    def __init__(self, name, asked):
        super().__init__(name)
        self.asked = asked
        self.failure = None

    def update(self):
        status, reason = self.asked(self.name)
        self.failure = Failure(reason, "", self.name) if status is Status.FAILURE else None
        return status


def random_wrapper(rng, name, below):
    made = (
        lambda: Retry(name, below(), attempts=int(rng.integers(1, 4))),
        lambda: RecoverBy(name, below(), {Reason.UNREACHABLE: below, Reason.GRASP_MISSED: below}),
        lambda: Stage(name, below() if rng.random() < 0.5 else None, below()),
        lambda: Timeout(name, below(), seconds=7.0),
        lambda: FailSafe(name, below(), below()),
    )
    return made[rng.integers(len(made))]()


def random_tree(rng, depth, names, asked):
    if depth == 0:
        return Leaf(f"leaf {next(names)}", asked)

    def below():
        return random_tree(rng, rng.integers(depth), names, asked)

    if rng.random() < 0.4:
        return random_wrapper(rng, f"node {next(names)}", below)
    children = [below() for _ in range(rng.integers(0 if depth < 3 else 1, 4))]
    kind = (py_trees.composites.Sequence, py_trees.composites.Selector)[rng.integers(2)]
    return kind(f"node {next(names)}", memory=True, children=children)


SAID = ("status", "current_child", "failure", "tried", "ends", "entered", "made_safe", "recovering", "result")


def told_of(node):
    """All that is to be known of a node; of a child its name."""
    values = [getattr(node, name, None) for name in SAID]
    return [value.name if isinstance(value, py_trees.behaviour.Behaviour) else value for value in values]


def story(seed, quick):
    """What is asked and what every node is after each of many ticks and stops of a random tree."""
    rng = np.random.default_rng(seed)
    told = []

    def asked(name):
        told.append(name)
        status = (Status.RUNNING, Status.SUCCESS, Status.FAILURE)[rng.choice(3, p=(0.2, 0.5, 0.3))]
        return status, (Reason.UNREACHABLE, Reason.CLOTH_SLIPPED)[rng.integers(2)]

    root = random_tree(rng, 4, itertools.count(), asked)
    nodes = list(root.iterate())
    clock = SimpleNamespace(now=lambda: clock.time)
    changed = set()
    for node in nodes:
        if hasattr(node, "bind"):
            node.bind(clock)
        if quick and remembers(node):
            node.tick, node.stop = quickened(node, lambda node=node: changed.add(node))
        elif quick and type(node) in RESUMING:
            counts = {node, *node.iterate()} if isinstance(node, Stage) else {node}
            node.tick, node.stop = quickened_wrapper(
                node, lambda counts=counts: changed.update(counts), lambda node=node: changed.add(node)
            )
    for clock.time in range(60):
        before = [told_of(node) for node in nodes]
        changed.clear()
        if rng.random() < 0.1:
            root.stop(Status.INVALID)
        else:
            root.tick_once()
        after = [told_of(node) for node in nodes]
        told.append(after)
        if quick:
            inner = [n for n, node in enumerate(nodes) if not isinstance(node, Leaf)]
            assert all(nodes[n] in changed for n in inner if before[n] != after[n]), "a change was not told"
    return told


@pytest.mark.parametrize("seed", range(60))
def test_a_quickened_tree_does_what_py_trees_own_does(seed):
    assert story(seed, quick=True) == story(seed, quick=False)


def test_only_nodes_that_remember_are_quickened():
    assert remembers(py_trees.composites.Sequence("s", memory=True))
    assert remembers(py_trees.composites.Selector("f", memory=True))
    assert not remembers(py_trees.composites.Selector("f", memory=False))

    class Own(py_trees.composites.Sequence):
        pass

    assert not remembers(Own("s", memory=True)), "it may tick otherwise"
