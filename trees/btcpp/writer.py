"""From a tree to the XML that BehaviorTree.CPP 4 and Groot2 read: each stage a tree of its own, keys shared by all."""

from __future__ import annotations

import re
from collections.abc import Container, Mapping
from xml.sax.saxutils import escape, quoteattr

from py_trees.behaviour import Behaviour

from ...sim.errors import CaretreeError
from ...skills.core.ports import Input, Key, ports_of
from ...skills.core.reasons import Reason
from ...skills.core.skill import Skill
from ..nodes.condition import Condition, inputs_of
from ..nodes.decorators import Stage
from .forms import FORMS, PortModel, form_of
from .values import ValueTextError, is_pointer, same, to_text
from .vocabulary import REASON, Vocabulary, ports_of_condition, ports_of_skill

INDENT = "  "
MAIN = "Task"


class ExportError(CaretreeError):
    """A tree that XML cannot hold; says which node, and what to do."""


def written(root: Behaviour, vocabulary: Vocabulary, python: str) -> str:
    """The file for a tree.

    Args:
        root: of the tree.
        vocabulary: leaves that a reader of the file will know.
        python: task or file that brings what of them is not the package's; empty if there is none.

    Raises:
        ExportError: the tree holds something that XML cannot.
    """
    return _Writing(vocabulary).file(root, python)


class _Writing:
    def __init__(self, vocabulary: Vocabulary) -> None:
        self._vocabulary = vocabulary
        self._trees: dict[str, list[str]] = {}

    def file(self, root: Behaviour, python: str) -> str:
        main = self._tree(MAIN, root)
        lines = ['<?xml version="1.0" encoding="UTF-8"?>']
        lines += [f"<?caretree python={quoteattr(python)}?>"] if python else []
        lines += [f'<root BTCPP_format="4" main_tree_to_execute={quoteattr(main)}>']
        for name in (main, *(name for name in self._trees if name != main)):
            body = self._trees[name]
            lines += [f"{INDENT}<BehaviorTree ID={quoteattr(name)}>", *body, f"{INDENT}</BehaviorTree>", ""]
        lines += [*self._models(), "</root>", ""]
        return "\n".join(lines)

    def _tree(self, name: str, root: Behaviour) -> str:
        """Write a tree of its own and return its ID."""
        body = self._node(root, 2, top=True)
        found = free_name(name, {*self._trees, *self._vocabulary.names()})
        self._trees[found] = body
        return found

    def _node(self, node: Behaviour, depth: int, top: bool = False) -> list[str]:
        if isinstance(node, Stage) and not top:
            tree = self._tree(tree_name(node), node)
            return [f'{INDENT * depth}<SubTree ID={quoteattr(tree)} _autoremap="true"/>']
        try:
            tag, attributes, parts = self._parts(node)
        except ValueTextError as error:
            raise ExportError(f"{node.name!r}: {error}") from None
        text = "".join(f" {name}={quoteattr(value)}" for name, value in {"name": node.name, **attributes}.items())
        if not parts:
            return [f"{INDENT * depth}<{tag}{text}/>"]
        inner = [line for part in parts for line in self._node(part, depth + 1)]
        return [f"{INDENT * depth}<{tag}{text}>", *inner, f"{INDENT * depth}</{tag}>"]

    def _parts(self, node: Behaviour) -> tuple[str, Mapping[str, str], list[Behaviour]]:
        """Tag, attributes and children of a node."""
        if isinstance(node, Skill):
            return self._skill(node)
        if isinstance(node, Condition):
            return self._condition(node)
        form = form_of(node)
        if form is None:
            raise ValueTextError(
                f"a {type(node).__name__} cannot be written in XML; there are {', '.join(each.tag for each in FORMS)}, "
                "skills and conditions"
            )
        return form.tag, form.attributes(node), list(form.parts(node))

    def _skill(self, skill: Skill) -> tuple[str, Mapping[str, str], list[Behaviour]]:
        kind = type(skill)
        if self._vocabulary.skills.get(kind.__name__) is not kind:
            raise ValueTextError(f"{kind.__name__} is not in the task's file, so that a reader would not find it")
        attributes = {}
        for name, port in ports_of(kind):
            bound = skill.bindings[name]
            if isinstance(bound, Key):
                attributes[name] = f"{{{bound.name}}}"
            elif isinstance(port, Input) and (port.required or not same(bound, port.default)):
                attributes[name] = _constant(name, bound, port.kind, port.default)
        return kind.__name__, attributes, []

    def _condition(self, node: Condition) -> tuple[str, Mapping[str, str], list[Behaviour]]:
        tag = next((tag for tag, test in self._vocabulary.conditions.items() if test is node.test), None)
        if tag is None:
            called = getattr(node.test, "__name__", repr(node.test))
            raise ValueTextError(
                f"it asks the function {called!r}, which XML cannot name: write it at the top of the task's file "
                "and name it in CONDITIONS = (...,)"
            )
        kinds = inputs_of(node.test)
        attributes = {
            name: f"{{{bound.name}}}" if isinstance(bound, Key) else _constant(name, bound, kinds[name], None)
            for name, bound in node.bindings.items()
        }
        if node.reason is not Reason.PRECONDITION:
            attributes[REASON] = node.reason.name
        return tag, attributes, []

    def _models(self) -> list[str]:
        """The palette of Groot2: every leaf, and the nodes that BehaviorTree.CPP does not have itself."""
        lines = [f"{INDENT}<TreeNodesModel>"]
        for form in FORMS:
            if not form.native:
                lines += _model(form.category, form.tag, form.ports)
        for name, kind in sorted(self._vocabulary.skills.items()):
            lines += _model("Action", name, ports_of_skill(kind))
        for name, test in sorted(self._vocabulary.conditions.items()):
            lines += _model("Condition", name, ports_of_condition(test))
        return [*lines, f"{INDENT}</TreeNodesModel>"]


def _constant(name: str, value: object, kind: object, default: object) -> str:
    try:
        return to_text(value, kind, default)
    except ValueTextError as error:
        raise ValueTextError(f"its {name}: {error}; hand it on by a key") from None


def _model(category: str, name: str, ports: list[PortModel] | tuple[PortModel, ...]) -> list[str]:
    if not ports:
        return [f'{INDENT * 2}<{category} ID="{name}"/>']
    lines = [f'{INDENT * 2}<{category} ID="{name}">']
    for port in ports:
        default = "" if port.default is None or is_pointer(port.default) else f" default={quoteattr(port.default)}"
        head = f"{INDENT * 3}<{port.direction} name={quoteattr(port.name)} type={quoteattr(port.type)}{default}"
        lines.append(f"{head}>{escape(port.doc)}</{port.direction}>" if port.doc else f"{head}/>")
    return [*lines, f"{INDENT * 2}</{category}>"]


def tree_name(stage: Behaviour) -> str:
    """An ID that BehaviorTree.CPP takes for the tree of a stage: no spaces, points or slashes."""
    words = re.findall(r"\w+", stage.name)
    return "".join(word[0].upper() + word[1:] for word in words) + "Stage"


def free_name(name: str, taken: Container[str]) -> str:
    """`name`, numbered if it is taken."""
    found, number = name, 2
    while found in taken:
        found, number = f"{name}{number}", number + 1
    return found
