"""Quickened nodes against py_trees' own: the same leaves are ticked, and every node ends up as it would have."""

import itertools

import numpy as np
import py_trees
import pytest
from caretree.trees.proof.quick_nodes import quickened, remembers
from py_trees.common import Status


class Leaf(py_trees.behaviour.Behaviour):
    """Ends as a list says, one entry per tick."""

    def __init__(self, name, asked):
        super().__init__(name)
        self.asked = asked

    def update(self):
        return self.asked(self.name)


def random_tree(rng, depth, names, asked):
    if depth == 0:
        return Leaf(f"leaf {next(names)}", asked)
    children = [
        random_tree(rng, rng.integers(depth), names, asked) for _ in range(rng.integers(0 if depth < 3 else 1, 4))
    ]
    kind = (py_trees.composites.Sequence, py_trees.composites.Selector)[rng.integers(2)]
    return kind(f"node {next(names)}", memory=True, children=children)


def story(seed, quick):
    """What is asked and what every node is after each of many ticks and stops of a random tree."""
    rng = np.random.default_rng(seed)
    told = []

    def asked(name):
        told.append(name)
        return (Status.RUNNING, Status.SUCCESS, Status.FAILURE)[rng.choice(3, p=(0.2, 0.5, 0.3))]

    root = random_tree(rng, 4, itertools.count(), asked)
    nodes = list(root.iterate())
    changed = []
    for node in nodes if quick else ():
        if remembers(node):
            node.tick, node.stop = quickened(node, lambda node=node: changed.append(node))
    for _ in range(60):
        before = [(node.status, getattr(node, "current_child", None)) for node in nodes]
        changed.clear()
        if rng.random() < 0.1:
            root.stop(Status.INVALID)
        else:
            root.tick_once()
        after = [(node.status, getattr(node, "current_child", None)) for node in nodes]
        told.append([(status, child and child.name) for status, child in after])
        if quick:
            inner = [n for n, node in enumerate(nodes) if remembers(node)]
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
