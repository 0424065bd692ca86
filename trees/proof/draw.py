"""A tree as text: what is below what, which recovery answers which reason, which skill reads and writes what."""

from __future__ import annotations

from py_trees.behaviour import Behaviour

from ...skills.core.ports import Key
from ...skills.core.skill import Skill
from ..nodes.condition import Condition
from ..nodes.decorators import FailSafe, RecoverBy, Stage


def drawn(node: Behaviour, depth: int = 0, when: str = "") -> list[str]:
    """One line for each node, parents first, children indented: when it runs, its name, its kind, its data.

    Args:
        node: root of what is drawn.
        depth: how far the first line is indented.
        when: said before the first line's name.
    """
    lines = [f"{'  ' * depth}{when}{node.name}  ({type(node).__name__}{_data(node)})"]
    if isinstance(node, RecoverBy):
        reasons: dict[Behaviour, list[str]] = {}
        for reason, recovery in node.recoveries.items():
            reasons.setdefault(recovery, []).append(reason.name)
        parts = [(node.body, ""), *((recovery, f"if {', '.join(names)}: ") for recovery, names in reasons.items())]
    elif isinstance(node, FailSafe):
        parts = [(node.body, ""), (node.safe, "if it fails: ")]
    elif isinstance(node, Stage) and node.precondition is not None:
        parts = [(node.precondition, "first: "), (node.body, "")]
    else:
        parts = [(child, "") for child in node.children]
    for child, why in parts:
        lines += drawn(child, depth + 1, why)
    return lines


def _data(node: Behaviour) -> str:
    if isinstance(node, Condition):
        read = ", ".join(key.name for key in node.reads().values())
        return f"; reads {read}" if read else ""
    if not isinstance(node, Skill):
        return ""
    keys = {
        word: [bound.name for name, _ in ports if isinstance(bound := node.bindings[name], Key)]
        for word, ports in (("reads", node.inputs()), ("writes", node.outputs()))
    }
    return "".join(f"; {word} {', '.join(names)}" for word, names in keys.items() if names)
