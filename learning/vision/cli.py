"""`caretree learn vision states|data|train|evaluate`; each goes on where it was interrupted."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from ...sim.command_line import CommandParser, seed, whole_number
from ...sim.errors import CaretreeError
from ...sim.scene.gown import HELD_OUT_GOWNS
from ..seeds import span_of_seeds
from ..shards import add_cluster_options


def _rate(text: str) -> float:
    try:
        rate = float(text)
    except ValueError:
        rate = 0.0
    if not 0.0 < rate <= 0.1:
        raise argparse.ArgumentTypeError(f"{text!r} is no rate of learning: more than 0, 0.1 at most")
    return rate


def parser() -> argparse.ArgumentParser:
    """The command line."""
    from .dataset import CAMERAS
    from .states import FRAMES, KINDS

    top = CommandParser(prog="caretree learn vision")
    sub = top.add_subparsers(dest="command", required=True)
    states = sub.add_parser("states", help="states of the room to take pictures of")
    states.add_argument("folder", metavar="DIR", help="made when it is not there")
    states.add_argument(
        "--seeds", type=span_of_seeds, default=span_of_seeds("110-139"), metavar="A-B", help="default 110-139"
    )
    states.add_argument(
        "--run", type=Path, action="append", default=[], metavar="DIR", help="a recorded run; may be repeated"
    )
    states.add_argument(
        "--frames", type=whole_number, default=FRAMES, metavar="N", help=f"of each recorded run (default {FRAMES})"
    )
    states.add_argument(
        "--kinds", nargs="+", choices=KINDS, default=KINDS, metavar="KIND", help=f"to prepare: {', '.join(KINDS)}"
    )
    states.add_argument("--hang", action="store_true", help="also gowns on their hooks as they come to hang, 12 s each")
    states.add_argument("--no-held-out", action="store_true", help="leave out the cuts that only tests see")
    data = sub.add_parser("data", help="labelled pictures of states, to train on")
    data.add_argument("folder", metavar="DIR", help="made when it is not there")
    data.add_argument("--states", required=True, metavar="DIR", help="folder of `states`")
    data.add_argument("--pictures", type=whole_number, default=3000, metavar="N", help="default 3000")
    data.add_argument("--seed", type=seed, default=100, metavar="N", help="default 100")
    data.add_argument("--camera", choices=CAMERAS, help="that takes all of them (default: half the head, half a hand)")
    data.add_argument("--kinds", nargs="+", choices=KINDS, default=[], metavar="KIND", help="of states (default: all)")
    add_cluster_options(data)
    train = sub.add_parser("train", help="train the network and write it as ONNX")
    train.add_argument("data", nargs="+", type=Path, metavar="DATA", help="one folder of `data` or more")
    train.add_argument("--out", required=True, metavar="DIR", help="checkpoint, record and seeing.onnx")
    train.add_argument("--steps", type=whole_number, default=6000, metavar="N", help="of 8 pictures (default 6000)")
    train.add_argument("--seed", type=seed, default=0, metavar="N", help="default 0")
    train.add_argument(
        "--start", type=Path, metavar="PATH", help="begin with the weights of another training, or of a seeing.onnx"
    )
    train.add_argument("--apart", type=Path, metavar="DIR", help="pictures to calibrate on, best of other rooms")
    train.add_argument(
        "--rate", type=_rate, default=2e-3, metavar="X", help="of learning, at the start (default 0.002)"
    )
    train.add_argument("--mean-with", type=Path, metavar="PATH", help="write the mean of these weights and the trained")
    test = sub.add_parser("evaluate", help="table of what is seen, beside the classical perception")
    test.add_argument("states", metavar="STATES", help="folder of `states`")
    test.add_argument("--network", type=Path, metavar="FILE", help="of every camera, instead of those in the package")
    test.add_argument("--before", type=Path, metavar="FILE", help="another one, to be told beside it")
    test.add_argument("--pictures", type=whole_number, default=40, metavar="N", help="of each sort (default 40)")
    test.add_argument("--seed", type=seed, default=150, metavar="N", help="default 150")
    test.add_argument("--out", type=Path, metavar="FILE", help="also write the table, Markdown, and beside it JSON")
    return top


def main(argv: list[str], seers: Callable[[Path | None], Mapping[str, Any]] | None = None) -> int:
    """Run one command.

    Raises:
        CaretreeError: the input cannot be used.
    """
    options = parser().parse_args(argv)
    if options.command == "states":
        from .states import make_states

        gowns = () if options.no_held_out else tuple(HELD_OUT_GOWNS)
        more = {"kinds": options.kinds, "frames": options.frames, "hang": options.hang}
        print(make_states(options.folder, options.seeds, options.run, gowns, _say, **more))
    elif options.command == "data":
        from .dataset import DatasetSpec, make_dataset
        from .states import read_states

        states, digest = read_states(options.states)
        spec = DatasetSpec(
            part="train",
            pictures=options.pictures,
            seed=options.seed,
            camera=options.camera,
            kinds=options.kinds,
        )
        print(make_dataset(options.folder, states, digest, spec, _say, jobs=options.jobs, address=options.address))
    elif options.command == "train":
        _train(options)
    else:
        _evaluate(options, seers)
    return 0


def _train(options: argparse.Namespace) -> None:
    try:
        import torch  # pyright: ignore[reportMissingImports] - in the extra `learn`
    except ImportError as error:
        raise CaretreeError("`caretree learn vision train` needs PyTorch: pip install 'caretree[learn]'") from error
    from .train import train

    torch.set_num_threads(1)  # as the other trainings: bit by bit the same on any number of cores
    out = Path(options.out)
    path = train(
        options.data,
        out,
        steps=options.steps,
        seed=options.seed,
        say=_say,
        start=options.start,
        apart=options.apart,
        learning_rate=options.rate,
        mean_with=options.mean_with,
    )
    print(path)


def _evaluate(options: argparse.Namespace, seers: Callable[[Path | None], Mapping[str, Any]] | None) -> None:
    from .evaluate import evaluate
    from .states import read_states
    from .table import rows, table

    if seers is None:
        raise CaretreeError("who sees is given by `caretree learn vision evaluate`; this was called without")
    states, digest = read_states(options.states)
    who = dict(seers(options.network))
    if options.before:
        first = next(iter(who))
        who = {first: who.pop(first), "before": seers(options.before)[first], **who}
    tallies = evaluate(states, who, pictures=options.pictures, seed=options.seed, say=_say)
    found = rows(tallies)
    about = f"{options.pictures} pictures of each sort, seed {options.seed}, states {digest}"
    text = table(found, about)
    print(text)
    if options.out:
        options.out.write_text(text + "\n", encoding="utf-8")
        options.out.with_suffix(".json").write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")


def _say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)
