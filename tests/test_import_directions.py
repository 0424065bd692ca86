"""sim <- perception, learning <- skills <- trees; and nobody who acts can reach the truth."""

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
LAYERS = {"sim": 0, "perception": 1, "learning": 1, "skills": 2, "trees": 3}
# What of sim/ the acting parts may use: the contract, what is data, and what a robot is made of.
ALLOWED_SIM = {
    "world",
    "abilities",
    "errors",
    "blame",
    "extras",
    "command_line",
    "quantity",
    "stopwatch",
    "compiled",
    "segments",
    "vector",
    "mechanics",
    "known_robots",
    "scripted",
    "pregrasp",
    "onnx_record",
    "faults",
    "fence",
    "portable_blas",
    "freshness",
    "observation_form",
    "waiting",
    "record",
    "remote",
    "world_kind",
    "yaml_text",
}
# These read records after a run, or start a world; the tree never calls them.
OUTSIDE_THE_TREE = {
    "trees/report/page.py",
    "trees/report/figures.py",
    "trees/watch/live.py",
    "trees/watch/playback.py",
    "trees/campaign/replay.py",
    "trees/campaign/trial.py",
    "trees/campaign/trials.py",
    "trees/campaign/on_cluster.py",
    "trees/campaign/rows_on_cluster.py",
    "trees/commands/evaluate.py",
    "trees/commands/export_lerobot.py",
    "trees/commands/robot.py",
    "trees/commands/run.py",
    "trees/commands/serve_robot.py",
    "trees/run/judging.py",
    "trees/run/task.py",
    "trees/run/worlds.py",
    "trees/campaign/trials_table.py",
    "trees/tasks/draw_blanket/room.py",
    "trees/tasks/hand_towel/room.py",
    "trees/tasks/undress/room.py",
    "trees/tasks/wash_arm/room.py",
    "trees/tasks/wipe_forearm/room.py",
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


def modules():
    """Module name -> file, of the whole project; a folder's name stands for its __init__."""
    return {".".join(path.with_suffix("").parts).removesuffix(".__init__"): path for path in FILES}


def circles(graph):
    """Groups of nodes that reach one another: strongly connected components of more than one node, after Tarjan."""
    found, order, low, stack = [], {}, {}, []

    def visit(node):
        order[node] = low[node] = len(order)
        stack.append(node)
        for other in graph[node]:
            if other not in order:
                visit(other)
            if other in stack:
                low[node] = min(low[node], low[other])
        if low[node] == order[node]:
            start = stack.index(node)
            group = stack[start:]
            del stack[start:]
            found.extend([sorted(group)] if len(group) > 1 else [])

    for node in graph:
        if node not in order:
            visit(node)
    return found


def import_graph():
    """Module -> modules it imports, lazily or for types alone too; that it imports its own folders is left out."""
    known = modules()
    graph = {name: set() for name in known}
    for name, path in known.items():
        for parts in imports(path):
            target = ".".join(parts if ".".join(parts) in known else parts[:-1])
            if target in known and target != name:
                graph[name].add(target)
    return graph


def test_no_modules_import_each_other():
    assert circles(import_graph()) == []


def test_a_circle_would_be_found():
    assert circles({"a": {"b"}, "b": {"c"}, "c": {"b", "d"}, "d": set()}) == [["b", "c"]]
    graph = import_graph()
    assert "sim.world" in graph["trees.guard.guard"]
    assert "trees.tasks" in graph["trees.run.task"], "a folder is a module"
    assert "sim.bullet.world" in graph["trees.run.worlds"], "lazy imports count too"
    graph["sim.world"].add("trees.guard.guard")
    assert any({"sim.world", "trees.guard.guard"} <= set(group) for group in circles(graph))


@pytest.mark.parametrize("path", FILES, ids=str)
def test_nobody_imports_what_another_module_keeps_to_itself(path):
    for module in imports(path):
        private = [part for part in module if part.startswith("_") and not part.startswith("__")]
        assert not private, f"{path} imports {'.'.join(module)}"


def test_the_scan_sees_what_it_should(tmp_path, monkeypatch):
    assert ["sim", "world", "World"] in list(imports(Path("trees/guard/guard.py")))
    assert ["sim", "bullet", "world", "BulletWorld"] in list(imports(Path("trees/run/worlds.py"))), (
        "lazy imports count too"
    )
    assert len(FILES) > 40
