"""How each node that is no leaf of a task stands in XML: one table for reading, writing and the palette.

BehaviorTree.CPP's own tags are used where they mean the same.  `Stage`, `RecoverBy` and `FailSafe` are this project's:
to BehaviorTree.CPP they are control nodes that a robot's own program registers.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import py_trees
from py_trees.behaviour import Behaviour
from py_trees.common import ParallelPolicy

from ...skills.core.reasons import Reason
from ..nodes.composers import check_children, fallback, parallel, reactive_fallback, sequence
from ..nodes.decorators import FailSafe, RecoverBy, Retry, Stage, Timeout
from .document import nearest
from .values import ValueTextError

Attributes = Mapping[str, str]
Category = Literal["Action", "Condition", "Control", "Decorator"]
Direction = Literal["input_port", "output_port"]


@dataclass(frozen=True)
class PortModel:
    """A port as the palette shows it.

    Attributes:
        name: of the attribute.
        doc: what it is.
        type: for people.
        default: text; None where it must be given.
        direction: of the data.
    """

    name: str
    doc: str
    type: str = "std::string"
    default: str | None = None
    direction: Direction = "input_port"


@dataclass(frozen=True)
class Form:
    """One kind of node.

    Attributes:
        tag: in XML.
        category: that BehaviorTree.CPP sorts it into.
        least: children at least.
        most: children at most; None for any number.
        fits: whether a node is of this kind.
        make: the node, from its name, its children in the order of the file, and its attributes.
        attributes: those of a node, besides its name.
        parts: children of a node in the order of the file.
        ports: its attributes in the palette.
        native: whether BehaviorTree.CPP has it itself.
    """

    tag: str
    category: Category
    least: int
    most: int | None
    fits: Callable[[Any], bool]
    make: Callable[[str, Sequence[Behaviour], Attributes], Behaviour]
    attributes: Callable[[Any], Attributes] = lambda node: {}
    parts: Callable[[Any], Sequence[Behaviour]] = lambda node: node.children
    ports: tuple[PortModel, ...] = ()
    native: bool = True


def whole(attributes: Attributes, name: str, default: int | None = None) -> int:
    """The attribute `name` as a whole number.

    Raises:
        ValueTextError: it is none, or is not given although there is no default.
    """
    text = attributes.get(name)
    if text is None and default is not None:
        return default
    try:
        return int(text or "")
    except ValueError:
        raise ValueTextError(f"{name} is {text or 'not given'}, but a whole number is asked for") from None


def _parallel(name: str, children: Sequence[Behaviour], attributes: Attributes) -> Behaviour:
    success, failure = whole(attributes, "success_count", -1), whole(attributes, "failure_count", 1)
    if failure != 1:
        raise ValueTextError(f"failure_count is {failure}, but a parallel node here fails with its first child: 1")
    if success in (-1, len(children)):
        return parallel(name, *children, policy="all")
    if success == 1:
        return parallel(name, *children, policy="one")
    raise ValueTextError(f"success_count is {success}, but -1 (all children) or 1 (the first) is asked for")


def _parallel_attributes(node: py_trees.composites.Parallel) -> Attributes:
    return {"success_count": "-1" if type(node.policy) is ParallelPolicy.SuccessOnAll else "1", "failure_count": "1"}


def _timeout_attributes(node: Timeout) -> Attributes:
    milliseconds = round(node.seconds * 1000)
    if milliseconds / 1000 != node.seconds:
        raise ValueTextError(f"{node.seconds!r} s cannot be written in whole milliseconds, as BehaviorTree.CPP does")
    return {"msec": str(milliseconds)}


def _stage(name: str, children: Sequence[Behaviour], _: Attributes) -> Behaviour:
    return Stage(name, children[0], children[1]) if len(children) == 2 else Stage(name, None, children[0])


def _recover_by(name: str, children: Sequence[Behaviour], attributes: Attributes) -> Behaviour:
    body, *recoveries = children
    groups = [group.split(",") for group in attributes.get("reasons", "").split(";")]
    if len(groups) != len(recoveries):
        raise ValueTextError(
            f"reasons names {len(groups)} groups, but {len(recoveries)} recoveries stand below the body; "
            'one group for each, as in "GRASP_MISSED,NOTHING_SEEN;ARM_LOST"'
        )
    makers: dict[Reason, Callable[[], Behaviour]] = {}
    for group, recovery in zip(groups, recoveries, strict=True):
        make = _giving(recovery)
        for word in group:
            reason = Reason.__members__.get(word.strip())
            if reason is None:
                raise ValueTextError(f"there is no reason {word.strip()!r}; {nearest(word, Reason.__members__)}")
            if reason in makers:
                raise ValueTextError(f"reason {reason.name} is named twice")
            makers[reason] = make
    return RecoverBy(name, body, makers, attempts=whole(attributes, "attempts", 2))


def _giving(node: Behaviour) -> Callable[[], Behaviour]:
    return lambda: node


def _recover_by_attributes(node: RecoverBy) -> Attributes:
    groups = [
        ",".join(reason.name for reason, tree in node.recoveries.items() if tree is recovery)
        for recovery in node.children[1:]
    ]
    return {"attempts": str(node.attempts), "reasons": ";".join(groups)}


def _remembering(kind: type, memory: bool) -> Callable[[Any], bool]:
    return lambda node: type(node) is kind and node.memory is memory


def _parallel_fits(node: Any) -> bool:
    plain = (ParallelPolicy.SuccessOnAll, ParallelPolicy.SuccessOnOne)
    return type(node) is py_trees.composites.Parallel and type(node.policy) in plain


def _of(kind: type) -> Callable[[Any], bool]:
    return lambda node: type(node) is kind


def _reactive_sequence(name: str, children: Sequence[Behaviour], _: Attributes) -> Behaviour:
    return py_trees.composites.Sequence(name, memory=False, children=check_children(name, tuple(children)))


FORMS = (
    Form(
        "Sequence",
        "Control",
        1,
        None,
        _remembering(py_trees.composites.Sequence, True),
        lambda name, children, _: sequence(name, *children),
    ),
    Form(
        "ReactiveSequence",
        "Control",
        1,
        None,
        _remembering(py_trees.composites.Sequence, False),
        _reactive_sequence,
    ),
    Form(
        "Fallback",
        "Control",
        1,
        None,
        _remembering(py_trees.composites.Selector, True),
        lambda name, children, _: fallback(name, *children),
    ),
    Form(
        "ReactiveFallback",
        "Control",
        1,
        None,
        _remembering(py_trees.composites.Selector, False),
        lambda name, children, _: reactive_fallback(name, *children),
    ),
    Form(
        "Parallel",
        "Control",
        1,
        None,
        _parallel_fits,
        _parallel,
        _parallel_attributes,
        ports=(PortModel("success_count", "", "int", "-1"), PortModel("failure_count", "", "int", "1")),
    ),
    Form(
        "RetryUntilSuccessful",
        "Decorator",
        1,
        1,
        _of(Retry),
        lambda name, children, attributes: Retry(name, children[0], attempts=whole(attributes, "num_attempts")),
        lambda node: {"num_attempts": str(node.attempts)},
        ports=(PortModel("num_attempts", "", "int"),),
    ),
    Form(
        "Timeout",
        "Decorator",
        1,
        1,
        _of(Timeout),
        lambda name, children, attributes: Timeout(name, children[0], seconds=whole(attributes, "msec") / 1000),
        _timeout_attributes,
        ports=(PortModel("msec", "", "unsigned int"),),
    ),
    Form(
        "Inverter",
        "Decorator",
        1,
        1,
        _of(py_trees.decorators.Inverter),
        lambda name, children, _: py_trees.decorators.Inverter(name, children[0]),
    ),
    Form(
        "ForceSuccess",
        "Decorator",
        1,
        1,
        _of(py_trees.decorators.FailureIsSuccess),
        lambda name, children, _: py_trees.decorators.FailureIsSuccess(name, children[0]),
    ),
    Form(
        "ForceFailure",
        "Decorator",
        1,
        1,
        _of(py_trees.decorators.SuccessIsFailure),
        lambda name, children, _: py_trees.decorators.SuccessIsFailure(name, children[0]),
    ),
    Form(
        "AlwaysSuccess",
        "Action",
        0,
        0,
        _of(py_trees.behaviours.Success),
        lambda name, _, __: py_trees.behaviours.Success(name),
    ),
    Form(
        "AlwaysFailure",
        "Action",
        0,
        0,
        _of(py_trees.behaviours.Failure),
        lambda name, _, __: py_trees.behaviours.Failure(name),
    ),
    Form(
        "Stage",
        "Control",
        1,
        2,
        _of(Stage),
        _stage,
        parts=lambda node: [*([node.precondition] if node.precondition else []), node.body],
        native=False,
    ),
    Form(
        "RecoverBy",
        "Control",
        2,
        None,
        _of(RecoverBy),
        _recover_by,
        _recover_by_attributes,
        ports=(
            PortModel("attempts", "how often the first child may be tried in all", "int", "2"),
            PortModel(
                "reasons", "for each further child the reasons it answers, as GRASP_MISSED,NOTHING_SEEN;ARM_LOST"
            ),
        ),
        native=False,
    ),
    Form(
        "FailSafe",
        "Control",
        2,
        2,
        _of(FailSafe),
        lambda name, children, _: FailSafe(name, children[0], children[1]),
        native=False,
    ),
)
BY_TAG = {form.tag: form for form in FORMS}
# BehaviorTree.CPP's nodes that have no counterpart, with what does the same here.
ELSEWHERE = {
    "Repeat": "write its child as often as it is needed",
    "KeepRunningUntilFailure": "a task must end",
    "Delay": "use HoldStill",
    "Sleep": "use HoldStill",
    "RunOnce": "write a condition",
    "SequenceWithMemory": "use Sequence",
    "AsyncSequence": "use Sequence",
    "AsyncFallback": "use Fallback",
    "ParallelAll": "use Parallel",
    "IfThenElse": "use Fallback with a condition",
    "WhileDoElse": "use ReactiveFallback with a condition",
    "TryCatch": "use FailSafe",
    "Script": "write a skill",
    "ScriptCondition": "write a condition",
    "Precondition": "use Stage with a condition",
    "SetBlackboard": "write a skill",
    "UnsetBlackboard": "outputs are unset by themselves",
    "Switch2": "use RecoverBy or Fallback",
}


def form_of(node: Behaviour) -> Form | None:
    """The form of a node; None where it is a leaf, or a node that XML has no form for."""
    return next((form for form in FORMS if form.fits(node)), None)
