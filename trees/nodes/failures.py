"""Finds out why a subtree failed."""

from __future__ import annotations

import py_trees
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from ...skills.core.reasons import Failure, Reason
from .condition import Condition


def failure_of(node: Behaviour) -> Failure:
    """Why `node` failed: its own failure, or that of the child that decided.

    A fallback reports its last child, a sequence and a parallel the child that failed.
    """
    own = getattr(node, "failure", None)
    if isinstance(own, Failure):
        return own
    failed = _failed(node)
    if failed:
        return failure_of(failed[-1])
    return Failure(Reason.INTERNAL_ERROR, node.feedback_message or "failed without a reason", node.name)


def cause_of(node: Behaviour) -> Failure:
    """What a person is told of why `node` failed.

    As `failure_of`, but where the last alternatives of a fallback did not even begin, as what they are for did not
    hold, the one before them is the cause, and not that question.
    """
    failure, failed = failure_of(node), _failed(node)
    if isinstance(node, py_trees.composites.Selector):
        failed = [child for child in failed if not _never_began(child)] or failed
        return cause_of(failed[-1]) if failed else failure
    told = [child for child in failed if failure_of(child) == failure]  # not a wrapper's own
    return cause_of(told[-1]) if told else failure


def _failed(node: Behaviour) -> list[Behaviour]:
    return [child for child in node.children if child.status == Status.FAILURE]


def _never_began(node: Behaviour) -> bool:
    """Whether it failed with the question that it begins with, which was answered."""
    if isinstance(node, Condition):
        return node.failure is not None and node.failure.reason == node.reason
    first = node.children[0] if node.children else None
    return first is not None and first.status == Status.FAILURE and _never_began(first)
