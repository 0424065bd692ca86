"""`caretree learn physics data|clip|show|sensitivity`."""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from ...sim.command_line import CommandParser, picture_file, seed
from ...sim.errors import CaretreeError
from ..shards import add_cluster_options

if TYPE_CHECKING:
    import numpy as np

SIZES = {
    "paper": (100, 60),
    "uniform": (1, 6000),
    "heldout_gown": (1, 300),
    "disturbed": (1, 300),
    "mixed": (1, 24000),
    "cuts": (1, 4000),
}


def parser() -> argparse.ArgumentParser:
    """The command line."""
    top = CommandParser(prog="caretree learn physics")
    sub = top.add_subparsers(dest="command", required=True)
    data = sub.add_parser("data", help="make a dataset of clips, or what is missing of it")
    data.add_argument("folder", metavar="DIR", help="where it lies; made when it is not there")
    data.add_argument("--kind", choices=tuple(SIZES), default="paper")
    data.add_argument("--classes", type=int, metavar="N", help="of kind paper (default 100)")
    data.add_argument(
        "--per-class",
        type=int,
        metavar="N",
        help="clips of each class, or in all (default: paper 60, uniform 6000, mixed 24000, cuts 4000, others 300)",
    )
    data.add_argument("--seed", type=seed, default=0, metavar="N")
    add_cluster_options(data)

    clip = sub.add_parser("clip", help="render the clip of one falling gown and write it")
    clip.add_argument("file", metavar="FILE", help="the .npz to write")
    clip.add_argument("--gown", default="medium", metavar="NAME", help="name of a gown, or a gown file")
    clip.add_argument("--engine", choices=("fast", "bullet"), default="bullet")
    clip.add_argument("--disturbed", action="store_true", help="with noise, holes and a misplaced camera")
    clip.add_argument("--seed", type=seed, default=0, metavar="N")
    clip.add_argument("--filmstrip", type=picture_file, metavar="FILE", help="also a picture of its frames")

    show = sub.add_parser("show", help="draw filmstrips of clips")
    show.add_argument("path", nargs="+", metavar="PATH", help="clips, or folders of datasets")
    show.add_argument("--clips", type=int, default=3, metavar="N", help="of each dataset (default 3)")
    show.add_argument("--out", type=picture_file, required=True, metavar="FILE", help="the picture to write")

    sensitivity = sub.add_parser("sensitivity", help="what a clip shows of each parameter")
    sensitivity.add_argument("--points", type=int, default=20, metavar="N", help="gowns looked at (default 20)")
    sensitivity.add_argument("--seed", type=seed, default=0, metavar="N")
    sensitivity.add_argument("--engines", action="store_true", help="instead, how the two engines differ, and the cost")
    sensitivity.add_argument("--candidates", action="store_true", help="instead, what else could be a parameter")
    sensitivity.add_argument("--out", metavar="FILE", help="also as a file, JSON")
    return top


def _rows(paths: list[str], clips: int) -> list[tuple[str, np.ndarray]]:
    """(title, depth) of clips and of the first `clips` of each dataset."""
    from .clips.clip import Clip, unpacked
    from .clips.dataset import read_index, read_shard
    from .clips.parameters import NAMES, to_values

    if clips < 1:
        raise CaretreeError(f"--clips is {clips}, at least 1 is asked for")
    rows: list[tuple[str, np.ndarray]] = []
    for path in map(Path, paths):
        if not path.is_dir():
            rows.append((path.name, Clip.load(path).depth))
            continue
        shard = read_shard(path / read_index(path)["shards"][0]["file"])
        for raw, unit in list(zip(shard["depth"], shard["unit"], strict=True))[:clips]:
            title = ", ".join(f"{name} {value:.3g}" for name, value in zip(NAMES, to_values(unit), strict=True))
            rows.append((f"{path.name}: {title}", unpacked(raw)))
    return rows


def main(argv: list[str]) -> int:
    """Run one command.

    Raises:
        CaretreeError: the input cannot be used.
    """
    options = parser().parse_args(argv)
    if options.command == "data":
        from .clips.dataset import DatasetSpec
        from .clips.generate import generate, say_to_stderr

        classes, per_class = SIZES[options.kind]
        spec = DatasetSpec(
            kind=options.kind,
            classes=classes if options.classes is None else options.classes,
            per_class=per_class if options.per_class is None else options.per_class,
            seed=options.seed,
        )
        print(generate(options.folder, spec, options.jobs, options.address, say_to_stderr))
    elif options.command == "clip":
        from ...sim.scene.scene import named_gown
        from .clips.parameters import BASE, NAMES
        from .clips.render_clip import render_clip

        gown = named_gown(options.gown)
        if gown.air_drag <= 0:  # a named gown says nothing of the air it falls in: the usual
            gown = replace(gown, air_drag=float(BASE[NAMES.index("air_drag")]))
        clip = render_clip(gown, seed=options.seed, engine=options.engine, disturbed=options.disturbed)
        print(clip.save(options.file))
        if options.filmstrip:
            from .clips.filmstrip import write_filmstrip

            print(write_filmstrip(options.filmstrip, [(gown.name, clip.depth)]))
    elif options.command == "show":
        from .clips.filmstrip import write_filmstrip

        print(write_filmstrip(options.out, _rows(options.path, options.clips)))
    elif options.engines:
        from .study.engine_comparison import report as compared

        print(compared())
    elif options.candidates:
        from .study.parameter_choice import candidates
        from .study.parameter_choice import report as table

        print(table(candidates()))
    else:
        from .study.sensitivity import report, study

        if options.points < 1:
            raise CaretreeError(f"--points is {options.points}, at least 1 is asked for")
        result = study(options.points, options.seed)
        print(report(result))
        if options.out:
            result.write(options.out)
    return 0
