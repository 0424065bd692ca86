"""From the elements of a file to the tree that the runner ticks.

Sub-trees are put in place, so that the tree is the same as one written in Python.  Each has keys of its own, as in
BehaviorTree.CPP: `target="{goal}"` binds its key `target` to the outer `goal`, `target="0.2"` to a constant,
`target="{=}"` to the outer key of that name, `_autoremap="true"` all keys but those that begin with `_`; `{@key}` is
the key of the outermost tree.  A `name` of a <SubTree> begins the names of the skills inside, as a scope does.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from py_trees.behaviour import Behaviour

from ...sim.errors import CaretreeError
from ...skills.core.context import Context
from ...skills.core.ports import Input, Key, PortError, ports_of, type_name
from ...skills.core.reasons import Reason
from ...skills.core.settings import SettingError
from ...skills.core.skill import Skill
from ..nodes.condition import Condition, inputs_of
from ..run.shape import DEPTH_MAX
from .document import Element, XmlError, nearest
from .files import TreeFiles
from .forms import BY_TAG, ELSEWHERE, Form
from .values import ValueTextError, from_text, is_pointer
from .vocabulary import REASON, Vocabulary

EXPLICIT = ("Action", "Condition", "Control", "Decorator", "SubTree")  # tags whose ID says what they are
SCRIPTS = ("_skipIf", "_successIf", "_failureIf", "_while", "_onSuccess", "_onFailure", "_onHalted", "_post")
NODES_MAX = 5000


@dataclass(frozen=True)
class Frame:
    """One place where a tree is put.

    Attributes:
        tree: its ID.
        outer: the place around it; None for the task's tree.
        prefix: begins the names of its skills.
        own: begins the names of its own keys.
        bound: keys that are another key outside, or a constant's text.
        shares: whether all other keys are those of outside.
    """

    tree: str
    outer: Frame | None = None
    prefix: str = ""
    own: str = ""
    bound: Mapping[str, Key | str] | None = None
    shares: bool = False

    def look_up(self, name: str) -> Key | str:
        """The key that `name` stands for here, or a constant's text.

        Raises:
            PortError: it is no name for a key.
        """
        if name.startswith("@"):
            frame = self
            while frame.outer is not None:
                frame = frame.outer
            return frame.look_up(name[1:])
        if self.bound and name in self.bound:
            return self.bound[name]
        if self.shares and self.outer is not None and not name.startswith("_"):
            return self.outer.look_up(name)
        return Key(self.own + name)

    def inside(self) -> list[str]:
        """IDs of this tree and of those around it, outermost first."""
        return [*(self.outer.inside() if self.outer else []), self.tree]


class Builder:
    """Builds one tree.

    Args:
        files: that hold it.
        vocabulary: leaves that it may have.
        context: that they are built with.
    """

    def __init__(self, files: TreeFiles, vocabulary: Vocabulary, context: Context) -> None:
        self._files = files
        self._vocabulary = vocabulary
        self._context = context
        self._nodes = 0
        self._places = 0

    def build(self) -> Behaviour:
        """The task's tree.

        Raises:
            XmlError: it cannot be built; says where.
            SettingError: the run sets a number that a skill does not have.
        """
        return self._tree(Frame(self._files.main), 0)

    def _tree(self, frame: Frame, depth: int) -> Behaviour:
        return self._node(self._files.trees[frame.tree].children[0], frame, depth)

    def _node(self, element: Element, frame: Frame, depth: int) -> Behaviour:
        self._nodes += 1
        if self._nodes > NODES_MAX or depth > DEPTH_MAX:
            element.refuse(f"the tree has over {NODES_MAX} nodes, or over {DEPTH_MAX} inside each other")
        for name in element.attributes:
            if name in SCRIPTS:
                element.refuse(f"{name} is a script of BehaviorTree.CPP; write a condition in Python and name it here")
        if element.tag == "SubTree":
            return self._tree(self._inner(element, frame), depth + 1)
        kind = element.needed("ID") if element.tag in EXPLICIT else element.tag
        name = element.attributes.get("name") or kind
        given = self._given(element)
        if kind in self._vocabulary.skills:
            self._without_children(element)
            return self._placed(
                element, lambda: self._skill(element, self._vocabulary.skills[kind], name, given, frame)
            )
        if kind in self._vocabulary.conditions:
            self._without_children(element)
            test = self._vocabulary.conditions[kind]
            return self._placed(element, lambda: self._condition(element, test, name, given, frame))
        if kind not in BY_TAG:
            if kind in ELSEWHERE:
                element.refuse(f"BehaviorTree.CPP's {kind} has no counterpart here: {ELSEWHERE[kind]}")
            element.refuse(f"there is no node {kind!r}; {nearest(kind, self._vocabulary.names())}")
        form = BY_TAG[kind]
        self._check_form(element, form, given)
        children = [self._node(child, frame, depth + 1) for child in element.children]
        constants = {port: self._constant(element, port, text, frame) for port, text in given.items()}
        return self._placed(element, lambda: form.make(name, children, constants))

    def _given(self, element: Element) -> dict[str, str]:
        """The ports of a node: `name`, `ID` and what editors note for themselves are none."""
        if element.tag not in EXPLICIT and "ID" in element.attributes:
            element.refuse(f"<{element.tag}> has no ID; it is called {element.tag} already")
        return {
            name: f"{{{name}}}" if text == "{=}" else text
            for name, text in element.attributes.items()
            if name not in ("name", "ID") and not name.startswith("_")
        }

    def _inner(self, element: Element, frame: Frame) -> Frame:
        """The place of a sub-tree."""
        tree = element.needed("ID")
        if tree not in self._files.trees:
            element.refuse(f"there is no tree {tree!r}; {nearest(tree, self._files.trees)}")
        around = frame.inside()
        if tree in around:
            element.refuse(f"tree {tree!r} contains itself: {' > '.join([*around, tree])}")
        self._without_children(element)
        shares = element.attributes.get("_autoremap", "false")
        if shares not in ("true", "false", "1", "0"):
            element.refuse(f"_autoremap is {shares!r}, but true or false is asked for")
        shared = shares in ("true", "1")
        given = self._given(element)
        for port, default in self._files.models.get(tree, {}).items():
            if port not in given and not shared:
                if default is None:
                    element.refuse(f"tree {tree!r} needs its port {port}, as its model in <TreeNodesModel> says")
                given[port] = default
        known = {*self._mentioned(tree), *self._files.models.get(tree, {})}
        for port in given:
            if port not in known:
                element.refuse(
                    f"tree {tree!r} uses no key {port!r}; {nearest(port, known) if known else 'it uses none'}"
                )
        self._places += 1
        name = element.attributes.get("name", "")
        bound = {port: self._looked_up(element, text, frame) for port, text in given.items()}
        own = f"{re.sub(r'[^0-9A-Za-z_]', '_', name or tree)}_{self._places}__"
        prefix = frame.prefix + (f"{name}/" if name else "")
        return Frame(tree, frame, prefix, own if own[0].isalpha() else f"tree_{own}", bound, shared)

    def _mentioned(self, tree: str) -> set[str]:
        """Keys that stand in a tree, and in those below it that share its keys."""
        keys: set[str] = set()
        elements, seen = list(self._files.trees[tree].children), {tree}
        while elements:
            element = elements.pop()
            elements += element.children
            texts = [f"{{{port}}}" if text == "{=}" else text for port, text in element.attributes.items()]
            keys |= {text[1:-1].strip() for text in texts if is_pointer(text) and not text.startswith("{@")}
            inner = element.attributes.get("ID", "")
            shares = element.tag == "SubTree" and element.attributes.get("_autoremap") in ("true", "1")
            if shares and inner in self._files.trees and inner not in seen:
                seen.add(inner)
                elements += self._files.trees[inner].children
        return keys

    def _bound(self, element: Element, text: str, frame: Frame) -> Key | str:
        """What a leaf's port is given: a key, which is told as it is written here, or a constant's text."""
        found = frame.look_up(text[1:-1].strip()) if is_pointer(text) else text
        return found.written_as(text, f"{element.file}:{element.line}") if isinstance(found, Key) else found

    def _looked_up(self, element: Element, text: str, frame: Frame) -> Key | str:
        if not is_pointer(text):
            return text
        try:
            return frame.look_up(text[1:-1].strip())
        except PortError as error:
            element.refuse(str(error))

    def _constant(self, element: Element, port: str, text: str, frame: Frame) -> str:
        found = self._looked_up(element, text, frame)
        if isinstance(found, Key):
            element.refuse(
                f"{port} is {text}, but <{element.tag}> needs a constant there: the tree is proved before it runs"
            )
        return found

    def _check_form(self, element: Element, form: Form, given: Mapping[str, str]) -> None:
        count = len(element.children)
        if count < form.least or (form.most is not None and count > form.most):
            most = "or more" if form.most is None else f"to {form.most}" if form.most > form.least else ""
            element.refuse(
                f"{form.tag} has {count} children, but {' '.join(filter(None, (str(form.least), most)))} are asked for"
            )
        known = [port.name for port in form.ports]
        for port in given:
            if port not in known:
                element.refuse(f"{form.tag} has no port {port!r}; {nearest(port, known) if known else 'it has none'}")

    def _without_children(self, element: Element) -> None:
        if element.children:
            element.refuse(f"<{element.tag}> is a leaf, but {len(element.children)} nodes stand below it")

    def _placed(self, element: Element, make: Callable[[], Behaviour]) -> Behaviour:
        """What `make` gives; its error says where it comes from."""
        try:
            return make()
        except (SettingError, XmlError):
            raise
        except CaretreeError as error:
            element.refuse(str(error))

    def _skill(self, element: Element, kind: type[Skill], name: str, given: Mapping[str, str], frame: Frame) -> Skill:
        ports = dict(ports_of(kind))
        bound: dict[str, Any] = {}
        for port, text in given.items():
            if port not in ports:
                raise PortError(f"{kind.__name__} has no port {port!r}; {nearest(port, [*ports, 'name'])}")
            found = self._bound(element, text, frame)
            declared = ports[port]
            if isinstance(found, str):
                if not isinstance(declared, Input):
                    raise PortError(f"{kind.__name__}.{port} is an output and takes a {{key}}, not {found!r}")
                found = _read(f"{kind.__name__}.{port}", found, declared.kind, declared.default)
            bound[port] = found
        for port, declared in ports.items():
            if isinstance(declared, Input) and declared.required and port not in bound:
                raise PortError(_lacking(kind.__name__, port, declared.kind))
        return kind(frame.prefix + name, self._context, **bound)

    def _condition(
        self, element: Element, test: Callable[..., object], name: str, given: Mapping[str, str], frame: Frame
    ) -> Condition:
        kinds = inputs_of(test)
        bound: dict[str, Any] = {}
        for port, text in given.items():
            found = self._bound(element, text, frame)
            if port == REASON:
                if found not in Reason.__members__:
                    raise PortError(f"there is no reason {text!r}; {nearest(text, Reason.__members__)}")
                continue
            if port not in kinds:
                raise PortError(f"{name!r} has no port {port!r}; {nearest(port, [*kinds, REASON, 'name'])}")
            bound[port] = _read(f"{name}.{port}", found, kinds[port], None) if isinstance(found, str) else found
        for port, parameter in inspect.signature(test).parameters.items():
            if port in kinds and port not in bound and parameter.default is parameter.empty:
                raise PortError(_lacking(repr(name), port, kinds[port]))
        return Condition(name, test, Reason[given.get(REASON, Reason.PRECONDITION.name)], **bound)


def _lacking(what: str, port: str, kind: Any) -> str:
    return f'{what} needs {port}="...": a {type_name(kind)}, or a {{key}}'


def _read(port: str, text: str, kind: Any, default: Any) -> Any:
    try:
        return from_text(text, kind, default)
    except ValueTextError as error:
        raise PortError(f"{port}: {error}") from None
