"""The shape that a tree must have before anybody walks through it: each node in one place, none too deep."""

from __future__ import annotations

from py_trees.behaviour import Behaviour

from ...sim.errors import CaretreeError

DEPTH_MAX = 150  # nodes inside each other: a tick is several Python frames deep for each


class ShapeError(CaretreeError):
    """What `build` gave is no tree, or too deep a one."""


def check_shape(root: Behaviour) -> None:
    """Walk through the tree without recursion.

    Raises:
        ShapeError: a node contains itself, stands in two places, or lies too deep.
    """
    above: dict[Behaviour, Behaviour | None] = {root: None}
    waiting = [(root, 1)]
    while waiting:
        node, depth = waiting.pop()
        if depth > DEPTH_MAX:
            raise ShapeError(f"{node.name!r} is node {depth} inside another, but at most {DEPTH_MAX} are followed")
        for child in node.children:
            if child in above:
                wrong = "contains itself" if _contains(child, node, above) else "stands in two places"
                raise ShapeError(f"{child.name!r} {wrong}: in {node.name!r} too; build another one")
            above[child] = node
            waiting.append((child, depth + 1))


def _contains(node: Behaviour, other: Behaviour, above: dict[Behaviour, Behaviour | None]) -> bool:
    """Whether `other` is `node` or lies below it."""
    here: Behaviour | None = other
    while here is not None and here is not node:
        here = above[here]
    return here is node
