"""sim <- perception, learning <- skills <- trees; and nobody who acts can reach the truth."""

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
LAYERS = {"sim": 0, "perception": 1, "learning": 1, "skills": 2, "trees": 3}
# What of sim/ the acting parts may use: the contract, what is data, and the robot's own model.
ALLOWED_SIM = {"world", "errors", "robot", "scripted", "faults", "record"}
# These read records after a run, or start a world; the tree never calls them.
OUTSIDE_THE_TREE = {
    "trees/report/page.py",
    "trees/report/figures.py",
    "trees/campaign/trial.py",
    "trees/campaign/trials.py",
    "trees/commands/evaluate.py",
    "trees/run/worlds.py",
    "trees/campaign/trials_table.py",
    "skills/scripted/rehearsal.py",
}
FILES = sorted(path.relative_to(ROOT) for layer in LAYERS for path in (ROOT / layer).rglob("*.py"))


def imports(path):
    """Absolute module names within the project that a file imports, lazily or not."""
    package = list(path.parts[:-1])
    for node in ast.walk(ast.parse((ROOT / path).read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else []
            if node.level and len(base) + node.level < len(package) + 1:
                continue
            module = [*base, *(node.module.split(".") if node.module else [])]
            if not node.level:
                if module[0] != "caretree":
                    continue
                module = module[1:]
            for alias in node.names:
                yield [*module, alias.name]
        elif isinstance(node, ast.Import):
            for alias in node.names:
                if alias.name.startswith("caretree."):
                    yield alias.name.split(".")[1:]


@pytest.mark.parametrize("path", FILES, ids=str)
def test_imports_go_one_way(path):
    layer = path.parts[0]
    for module in imports(path):
        assert module[0] in LAYERS, f"{path} imports {'.'.join(module)}"
        allowed = module[0] == layer or LAYERS[module[0]] < LAYERS[layer]
        assert allowed, f"{path} imports {'.'.join(module)}, but sim <- perception, learning <- skills <- trees"


@pytest.mark.parametrize(
    "path",
    [p for p in FILES if p.parts[0] in ("perception", "skills", "trees") and p.as_posix() not in OUTSIDE_THE_TREE],
    ids=str,
)
def test_who_acts_imports_no_truth(path):
    for module in imports(path):
        if module[0] == "sim" and len(module) > 1:
            assert module[1] in ALLOWED_SIM, f"{path} imports sim.{module[1]}, which may know the truth"
            assert module[1:3] != ["record", "truth"], f"{path} imports the truth"
    for node in ast.walk(ast.parse((ROOT / path).read_text(encoding="utf-8"))):
        if isinstance(node, ast.Attribute):
            assert node.attr not in ("truth", "truth_frame", "truth_static"), f"{path}:{node.lineno} reads {node.attr}"


def test_the_scan_sees_what_it_should(tmp_path, monkeypatch):
    assert ["sim", "world", "World"] in list(imports(Path("trees/guard/guard.py")))
    assert ["sim", "bullet", "world", "BulletWorld"] in list(imports(Path("trees/run/worlds.py"))), (
        "lazy imports count too"
    )
    assert len(FILES) > 40
