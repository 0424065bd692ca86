"""Finds out why a subtree failed."""

from __future__ import annotations

import py_trees
from py_trees.common import Status

from ...skills.core.reasons import Failure, Reason


def failure_of(node: py_trees.behaviour.Behaviour) -> Failure:
    """Why `node` failed: its own failure, or that of the child that decided.

    A fallback reports its last child, a sequence and a parallel the child that failed.
    """
    own = getattr(node, "failure", None)
    if isinstance(own, Failure):
        return own
    failed = [child for child in node.children if child.status == Status.FAILURE]
    if failed:
        return failure_of(failed[-1])
    return Failure(Reason.INTERNAL_ERROR, node.feedback_message or "failed without a reason", node.name)
