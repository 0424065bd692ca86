"""The tree of a run as XML for Groot2: each node with its number, each stage a tree of its own that can be folded.

Unlike what `caretree export xml` writes it need not be read again, so it shows every tree: constants that XML cannot
hold stand as text, and a node without a form of its own under the name of its class.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

from py_trees.behaviour import Behaviour

from ...sim.errors import CaretreeError
from ...skills.core.ports import Input, Key, ports_of
from ...skills.core.skill import Skill
from ..btcpp.forms import PortModel, form_of
from ..btcpp.values import ValueTextError, same, to_text
from ..btcpp.vocabulary import identifier, ports_of_condition, ports_of_skill
from ..btcpp.writer import MAIN, free_name, tree_name
from ..nodes.condition import Condition, inputs_of
from ..nodes.decorators import Stage
from .protocol import LARGEST_UID

LONGEST = 80  # characters of a constant that are shown


@dataclass
class ShownTree:
    """A tree with the numbers that Groot2 calls its nodes by.

    Args:
        root: of the tree.

    Attributes:
        xml: of the whole tree.
        uids: numbers of a node: its own, and of a stage also that of the place where its tree is put in.
        boards: names under which the values of keys are asked for, the whole tree's first.

    Raises:
        CaretreeError: the tree has more nodes than the protocol has numbers for.
    """

    root: Behaviour
    xml: str = field(init=False)
    uids: dict[Behaviour, list[int]] = field(init=False, default_factory=dict)
    boards: list[str] = field(init=False, default_factory=list)

    def __post_init__(self) -> None:
        self._numbers = self._count()
        self._document = Element("root", BTCPP_format="4", main_tree_to_execute=MAIN)
        self._models: dict[str, Element] = {}
        self._tree(MAIN, "", self.root)
        models = SubElement(self._document, "TreeNodesModel")
        models.extend(self._models[name] for name in sorted(self._models))
        ElementTree.indent(self._document)
        self.xml = ElementTree.tostring(self._document, encoding="unicode", xml_declaration=True)

    def nodes(self) -> dict[int, Behaviour]:
        """The node behind each number."""
        return {uid: node for node, uids in self.uids.items() for uid in uids}

    def _count(self) -> Iterator[int]:
        yield from range(1, LARGEST_UID + 1)
        raise CaretreeError(f"Groot2 cannot show more than {LARGEST_UID} nodes")

    def _tree(self, name: str, path: str, root: Behaviour) -> None:
        self.boards.append(name)
        tree = SubElement(self._document, "BehaviorTree", ID=name, _fullpath=path)
        self._node(tree, root, top=True)

    def _node(self, above: Element, node: Behaviour, top: bool = False) -> None:
        uid = next(self._numbers)
        self.uids.setdefault(node, []).append(uid)
        if isinstance(node, Stage) and not top:
            name = free_name(tree_name(node), self.boards)
            SubElement(above, "SubTree", ID=name, _fullpath=name, _uid=str(uid))
            self._tree(name, name, node)
            return
        category, tag, ports = _model(node)
        if tag not in self._models:
            self._models[tag] = _model_element(category, tag, ports)
        element = SubElement(above, tag, {"name": node.name, "_uid": str(uid), **_attributes(node)})
        form = form_of(node)
        for part in form.parts(node) if form is not None else node.children:
            self._node(element, part)


def _model(node: Behaviour) -> tuple[str, str, list[PortModel]]:
    """Category, tag and ports of a kind of node."""
    if isinstance(node, Skill):
        return "Action", type(node).__name__, ports_of_skill(type(node))
    if isinstance(node, Condition):
        named = identifier(node.test)
        return "Condition", named if named.isidentifier() else "Condition", ports_of_condition(node.test)
    form = form_of(node)
    if form is not None:
        return form.category, form.tag, list(form.ports)
    category = "Action" if not node.children else "Decorator" if len(node.children) == 1 else "Control"
    return category, type(node).__name__, []


def _model_element(category: str, tag: str, ports: list[PortModel]) -> Element:
    model = Element(category, ID=tag)
    for port in ports:
        element = SubElement(model, port.direction, name=port.name, type=port.type)
        if port.default is not None:
            element.set("default", port.default)
        element.text = port.doc or None
    return model


def _attributes(node: Behaviour) -> dict[str, str]:
    if isinstance(node, Skill):
        found = {}
        for name, port in ports_of(type(node)):
            bound = node.bindings[name]
            if isinstance(bound, Key):
                found[name] = f"{{{bound.name}}}"
            elif isinstance(port, Input) and (port.required or not same(bound, port.default)):
                found[name] = _text(bound, port.kind, port.default)
        return found
    if isinstance(node, Condition):
        kinds = inputs_of(node.test)
        return {
            name: f"{{{bound.name}}}" if isinstance(bound, Key) else _text(bound, kinds[name])
            for name, bound in node.bindings.items()
        }
    form = form_of(node)
    try:
        return dict(form.attributes(node)) if form is not None else {}
    except ValueTextError:
        return {}


def _text(value: object, kind: object, default: object = None) -> str:
    try:
        return to_text(value, kind, default)
    except ValueTextError:
        return " ".join(str(value).split())[:LONGEST]
