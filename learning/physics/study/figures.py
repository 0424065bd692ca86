"""Pictures of a study: t-SNE of parameters and embeddings, box plot, learning curves, measured and simulated clips."""

from __future__ import annotations

import json
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import torch  # pyright: ignore[reportMissingImports] - in the extra `learn`

from ....sim.errors import CaretreeError
from ....sim.scene.gown import GOWNS, GownSpec
from ..clips.clip import Clip
from ..clips.filmstrip import write_filmstrip
from ..clips.frames import frames_of
from ..clips.parameters import BASE, NAMES, SHOWN, to_spec, to_unit, to_values, values_to_unit
from ..clips.render_clip import render_clip
from ..methods.examples import Loaded, load_examples
from ..methods.weights import PACKAGED, load_weights
from ..networks.backbone import embed
from ..networks.training import Budget
from .identify import identify
from .metrics import garment_error
from .registry import TITLES, Plan
from .study import Study, predictions

CLASSES = 50  # of the t-SNE, as in the paper's figure
CLIPS = 1200
USUAL = "scores"  # backbone that is not named in the box plot


def scene_gowns() -> dict[str, GownSpec]:
    """The scene's three gowns in the air of the base values (a named gown says nothing of air)."""
    air = float(BASE[NAMES.index("air_drag")])
    return {name: replace(spec, air_drag=spec.air_drag or air) for name, spec in GOWNS.items()}


def scene_clips() -> dict[str, Clip]:
    """A clip of each of the scene's gowns by PyBullet, not by the engine that the methods learn from."""
    return {name: render_clip(spec, engine="bullet") for name, spec in scene_gowns().items()}


def draw(study: Path, data: Path, out: Path, *, also: Sequence[Path] = (), weights: Path = PACKAGED,
         partial: bool = False) -> Iterator[Path]:  # fmt: skip
    """Draw all pictures of a finished study; yields each path as it is written.

    Args:
        study: folder that `evaluate` wrote to.
        data: what it was trained on.
        out: folder for the pictures.
        also: more studies, for the box plot.
        weights: what the scene's gowns are identified with.
        partial: take what is there of unfinished data.

    Raises:
        CaretreeError: a folder holds no study.
    """
    out.mkdir(parents=True, exist_ok=True)
    results = _results(study)
    yield box_plot((study, *also), out / "garment-physics-errors.png")
    yield learning_curves((study, *also), out / "garment-physics-curves.png")
    yield map_of_clips(study, load_examples(data, study, partial=partial), results, out / "garment-physics-map.png")
    yield filmstrips(weights, out / "garment-physics-filmstrips.png")


def _results(study: Path) -> dict:
    path = study / "results.json"
    if not path.is_file():
        raise CaretreeError(
            f"{study}: there is no study here; `caretree learn physics evaluate DATA --out {study}` makes one"
        )
    return json.loads(path.read_text(encoding="utf-8"))


def box_plot(studies: Sequence[Path], path: Path) -> Path:
    """M_eg of every method on each test of each study, on a logarithmic axis."""
    from matplotlib.figure import Figure

    errors: dict[str, dict[tuple[str, str], list[np.ndarray]]] = defaultdict(lambda: defaultdict(list))
    for study in studies:
        kind, backbone = _results(study)["data"]["kind"], _results(study)["backbone"]
        for test, method, _, kept in predictions(study):
            title = test if test == kind else f"{test}, trained on {kind}"
            error = garment_error(to_values(kept["true"]), to_values(kept["unit"]), list(SHOWN))
            errors[title][method, "" if backbone == USUAL else f", {backbone}"].append(error)
    columns = min(3, len(errors))
    rows = -(-len(errors) // columns)
    figure = Figure(figsize=(3.4 * columns + 0.6, 3.8 * rows))
    axes = figure.subplots(rows, columns, sharey=True, squeeze=False).ravel()
    for axis in axes[len(errors) :]:
        axis.axis("off")
    for axis, (test, methods) in zip(axes, errors.items(), strict=False):
        boxes = sorted(methods, key=lambda box: (list(TITLES).index(box[0]), box[1]))
        axis.boxplot([100 * np.concatenate(methods[box]) for box in boxes], showfliers=False)
        names = [TITLES[method].replace(", ", ",\n") + backbone for method, backbone in boxes]
        axis.set_xticks(range(1, len(boxes) + 1), names, rotation=60, fontsize=6, ha="right")
        axis.set_yscale("log")
        axis.set_title(test, fontsize=9)
        axis.grid(axis="y", alpha=0.3)
    for axis in axes[::columns]:
        axis.set_ylabel("$M_{eg}$, shown parameters [%]", fontsize=8)
    figure.tight_layout()
    figure.savefig(path, dpi=90)
    return path


def learning_curves(studies: Sequence[Path], path: Path) -> Path:
    """Loss of both phases of the paper's method while they learn, each seed of each study."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8.4, 3.2))
    phases = {"contrastive": "phase one, contrastive loss", "residual": "phase two, residual loss"}
    for axis, (phase, title) in zip(figure.subplots(1, 2), phases.items(), strict=True):
        for colour, study in enumerate(studies):
            kind, label = _results(study)["data"]["kind"], ""
            for file in sorted(study.glob(f"seed*/{phase}/record.json")):
                record = json.loads(file.read_text(encoding="utf-8"))
                steps = np.linspace(0, record["steps"], len(record["losses"]) + 1)[1:]
                name = "" if label else f"{record['backbone']} on {kind}"  # one line of the legend for all seeds
                label = label or name
                axis.plot(steps, record["losses"], color=f"C{colour}", lw=1, label=name or None)
        axis.set_yscale("log")
        axis.set_xlabel("steps", fontsize=8)
        axis.set_title(title, fontsize=9)
        axis.grid(alpha=0.3)
        if axis.lines:
            axis.legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(path, dpi=90)
    return path


def map_of_clips(study: Path, loaded: Loaded, results: dict, path: Path) -> Path:
    """t-SNE of parameters and of the paper's embedding; the scene's gowns are stars."""
    from matplotlib.figure import Figure
    from sklearn.manifold import TSNE

    from ..networks.contrastive_residual import fit_paper

    plan = Plan(steps=results["steps"], backbone=results["backbone"], folder=study, say=lambda _: None)
    view = Study(data=loaded, tests={}, plan=plan, seeds=(0,)).view()
    train = view(loaded.part("train"))
    method = fit_paper(
        train,
        Budget(steps=results["steps"]),
        seed=results["seeds"][0],
        say=lambda _: None,
        folder=study / f"seed{results['seeds'][0]}",
        backbone=results["backbone"],
    )
    some = train.part(np.flatnonzero(train.class_id < CLASSES)[:CLIPS])
    depth = np.array([clip.depth for clip in scene_clips().values()])
    stars = np.array([to_unit(spec) for spec in scene_gowns().values()])
    own = view(replace(some, frames=frames_of(depth)))
    seen = embed(method.embedding, torch.cat([some.frames, own.frames])).numpy()
    figure = Figure(figsize=(8.4, 4.0))
    for axis, points, title in zip(figure.subplots(1, 2), (np.vstack([some.unit, stars]), seen),
                                   ("parameters", "embedding of the paper's method"), strict=True):  # fmt: skip
        flat = TSNE(random_state=0, init="pca", perplexity=20.0).fit_transform(points)
        colour = some.class_id % 10 if (some.class_id >= 0).all() else some.unit[:, 0]
        axis.scatter(*flat[: len(some)].T, c=colour, cmap="tab10" if (some.class_id >= 0).all() else "viridis", s=5)
        axis.scatter(*flat[len(some) :].T, marker="*", s=110, c="black", edgecolors="white")
        for k, (name, where) in enumerate(zip(GOWNS, flat[len(some) :], strict=True)):  # stars may lie close together
            axis.annotate(name, where, (8, 9 * (1 - k)), textcoords="offset points", fontsize=7, va="center")
        axis.set_title(title, fontsize=9)
        axis.axis("off")
    figure.tight_layout()
    figure.savefig(path, dpi=90)
    return path


def filmstrips(weights: Path, path: Path) -> Path:
    """Clips of the scene's gowns, each above the clip simulated with what was identified from it."""
    method, _ = load_weights(weights)
    rows = []
    for name, clip in scene_clips().items():
        found = identify(clip, method, name)
        again = render_clip(to_spec(values_to_unit(found.values), GOWNS[name]))
        rows += [(f"{name}, seen", clip.depth), (f"{name}, simulated with what was found", again.depth)]
    return write_filmstrip(path, rows)
