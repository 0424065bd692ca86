"""Sequence, fallback and parallel that refuse what py_trees lets pass.

py_trees takes a misspelt parallel policy for "one is enough", `memory="yes"` for False, and starts the
higher branch of a memory-less selector before it stops the lower one.  Here such trees cannot be built.
"""

from __future__ import annotations

from typing import Literal, get_args

import py_trees
from py_trees.behaviour import Behaviour
from py_trees.common import ParallelPolicy

from ...sim.errors import CaretreeError
from ...skills.core.skill import Skill

Policy = Literal["all", "one"]


class TreeError(CaretreeError):
    """A tree that must not be built."""


def commanding(node: Behaviour) -> list[Skill]:
    """Skills below and including `node` that move the robot."""
    return [leaf for leaf in node.iterate() if isinstance(leaf, Skill) and leaf.commands]


def check_children(name: str, children: tuple[Behaviour, ...]) -> list[Behaviour]:
    """The children as a list.

    Raises:
        TreeError: there are none, one is no node, is given twice or has another parent.
    """
    if not isinstance(name, str) or not name:
        raise TreeError(f"a node's first argument is its name, but {name!r} was given")
    if not children:
        raise TreeError(f"{name!r} has no children: an empty sequence succeeds and an empty fallback fails, silently")
    for child in children:
        if not isinstance(child, Behaviour):
            raise TreeError(f"a child of {name!r} is {child!r}, but nodes are asked for")
        if child.parent is not None:
            raise TreeError(f"{child.name!r} already belongs to {child.parent.name!r}; build another one for {name!r}")
    if len({id(child) for child in children}) < len(children):
        raise TreeError(f"{name!r} is given the same child twice; build another one")
    return list(children)


def sequence(name: str, *children: Behaviour) -> py_trees.composites.Sequence:
    """All children in turn; fails with the first that fails.  A running child is resumed, not restarted."""
    return py_trees.composites.Sequence(name, memory=True, children=check_children(name, children))


def fallback(name: str, *children: Behaviour) -> py_trees.composites.Selector:
    """The children in turn until one succeeds; fails with the last.  A running child is resumed, not preempted."""
    return py_trees.composites.Selector(name, memory=True, children=check_children(name, children))


def reactive_fallback(name: str, *children: Behaviour) -> py_trees.composites.Selector:
    """Like `fallback`, but earlier children are asked again on every tick and preempt later ones.

    Raises:
        TreeError: more than one child moves the robot, so that two could command in one tick.
    """
    nodes = check_children(name, children)
    movers = [child.name for child in nodes if commanding(child)]
    if len(movers) > 1:
        raise TreeError(f"{name!r} could let {movers[0]!r} and {movers[1]!r} command in one tick; use fallback()")
    return py_trees.composites.Selector(name, memory=False, children=nodes)


def parallel(name: str, *children: Behaviour, policy: Policy = "all") -> py_trees.composites.Parallel:
    """All children in every tick; fails with the first failure.

    Args:
        name: of the node.
        *children: at most one of them moves the robot.
        policy: `all` succeeds with the last child, `one` with the first.

    Raises:
        TreeError: an unknown policy, or several children that move the robot.
    """
    if policy not in get_args(Policy):
        raise TreeError(f"policy of {name!r} is {policy!r}, but one of {', '.join(get_args(Policy))} is asked for")
    nodes = check_children(name, children)
    movers = [child.name for child in nodes if commanding(child)]
    if len(movers) > 1:
        raise TreeError(f"{movers[0]!r} and {movers[1]!r} in {name!r} would wait for each other; use sequence()")
    chosen = ParallelPolicy.SuccessOnAll() if policy == "all" else ParallelPolicy.SuccessOnOne()
    return py_trees.composites.Parallel(name, policy=chosen, children=nodes)
