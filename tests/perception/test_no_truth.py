"""Perception knows images, proprioception and the room; it cannot reach the simulator's truth."""

import ast
from pathlib import Path

import caretree.perception

ALLOWED_FROM_SIM = {"world", "errors", "quantity", "robot.gripper"}  # the last two are data without a world


def test_imports_from_sim_are_the_contracts_only():
    files = sorted(Path(caretree.perception.__file__).parent.rglob("*.py"))
    assert len(files) > 10
    for file in files:
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, ast.ImportFrom) and node.level == 2 + (file.parent.name != "perception"):
                package, _, module = (node.module or "").partition(".")
                assert package == "sim", f"{file.name} imports {node.module}"
                assert module in ALLOWED_FROM_SIM, f"{file.name} imports sim.{module}"
            if isinstance(node, (ast.Import, ast.ImportFrom)):
                names = [a.name for a in node.names] if isinstance(node, ast.Import) else [node.module or ""]
                assert not any(n.startswith(("pybullet", "caretree.sim")) for n in names), file.name
