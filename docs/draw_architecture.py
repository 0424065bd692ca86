"""Draws docs/architecture.svg from the imports in the source: `python docs/draw_architecture.py`.

Boxes are folders (with their number of files), rows are layers; an arrow goes from the folder that imports to the one
that is imported and is as thick as there are imports.  Lazy imports count too.
"""

from __future__ import annotations

import ast
from collections import Counter
from pathlib import Path

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt
from matplotlib.patches import FancyArrowPatch, FancyBboxPatch

ROOT = Path(__file__).resolve().parents[1]
ROWS = (("trees",), ("skills",), ("perception", "learning"), ("sim",))  # from the top
COLOURS = {"trees": "#d9ead3", "skills": "#fff2cc", "perception": "#cfe2f3", "learning": "#d9d2e9", "sim": "#eeeeee"}
WIDTH, ROW, BOX, HEIGHT = 14.0, 2.0, 1.12, 0.52  # inches on the page


def folder_of(path: Path) -> str:
    """`trees/run/runner.py` -> `trees/run`; a file of the layer's own belongs to the layer."""
    parts = path.relative_to(ROOT).parts
    return "/".join(parts[:2]) if len(parts) > 2 else parts[0]


def imports(path: Path) -> set[str]:
    """Folders of this project that a file imports from."""
    package = list(path.relative_to(ROOT).parts[:-1])
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if not isinstance(node, ast.ImportFrom) or not node.level:
            continue
        base = package[: len(package) - node.level + 1]
        for alias in node.names:
            parts = [*base, *(node.module or "").split("."), alias.name]
            parts = [part for part in parts if part]
            for end in range(len(parts), 0, -1):
                if (file := ROOT.joinpath(*parts[:end]).with_suffix(".py")).exists():
                    found.add(folder_of(file))
                    break
                if (ROOT.joinpath(*parts[:end]) / "__init__.py").exists():
                    found.add("/".join(parts[:end][:2]))
                    break
    return found


def main() -> None:
    """Draw and save."""
    files: Counter[str] = Counter()
    arrows: Counter[tuple[str, str]] = Counter()
    for layer in COLOURS:
        for path in sorted((ROOT / layer).rglob("*.py")):
            here = folder_of(path)
            files[here] += path.name != "__init__.py"
            arrows.update((here, there) for there in imports(path) if there != here)
    figure, axes = plt.subplots(figsize=(WIDTH, ROW * len(ROWS)))
    places: dict[str, tuple[float, float]] = {}
    for number, layers in enumerate(ROWS):
        y = ROW * (len(ROWS) - number - 0.5)
        names = [name for layer in layers for name in sorted(files) if name.split("/")[0] == layer]
        step = WIDTH / len(names)
        for place, name in enumerate(names):
            x = step * (place + 0.5)
            places[name] = (x, y + (0.25 if place % 2 else -0.25))
        for layer in layers:
            mine = [place for place, name in enumerate(names) if name.split("/")[0] == layer]
            left, right = step * mine[0] + 0.04, step * (mine[-1] + 1) - 0.04
            box = FancyBboxPatch(
                (left, y - 0.8),
                right - left,
                1.6,
                boxstyle="round,pad=0,rounding_size=0.1",
                facecolor=COLOURS[layer],
                edgecolor="none",
                zorder=0,
            )
            axes.add_patch(box)
            axes.text(left + 0.1, y + 0.6, layer, fontsize=13, weight="bold", va="center")
    for (here, there), count in arrows.items():
        down = here.split("/")[0] != there.split("/")[0]
        axes.add_patch(
            FancyArrowPatch(
                places[here],
                places[there],
                arrowstyle="-|>",
                mutation_scale=7,
                connectionstyle="arc3,rad=0.08",
                shrinkA=16,
                shrinkB=16,
                zorder=1,
                linewidth=0.3 + 0.09 * count,
                color="#444444" if down else "#c27ba0",
                alpha=0.55,
            )
        )
    for name, (x, y) in places.items():
        axes.add_patch(
            FancyBboxPatch(
                (x - BOX / 2, y - HEIGHT / 2),
                BOX,
                HEIGHT,
                boxstyle="round,pad=0,rounding_size=0.06",
                facecolor="white",
                edgecolor="#666666",
                zorder=2,
            )
        )
        label = name.split("/")[-1] if "/" in name else f"({name})"
        axes.text(x, y, f"{label}\n{files[name]} files", ha="center", va="center", fontsize=7.5, zorder=3)
    axes.set_xlim(0, WIDTH)
    axes.set_ylim(0, ROW * len(ROWS))
    axes.axis("off")
    figure.tight_layout(pad=0.2)
    matplotlib.rcParams |= {"svg.hashsalt": "caretree", "svg.fonttype": "none"}  # the same imports, the same small file
    figure.savefig(ROOT / "docs" / "architecture.svg", metadata={"Date": None})


if __name__ == "__main__":
    main()
