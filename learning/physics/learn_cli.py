"""`caretree learn physics train|evaluate|identify|pictures`."""

from __future__ import annotations

import argparse
import json
import sys
import time
from pathlib import Path

from ...sim.command_line import CommandParser, whole_number
from ...sim.errors import CaretreeError

STEPS = 1500
METHODS = (
    "gp_inversion",
    "paper",
    "supervised",
    "contrastive_regression",
    "residual_only",
    "manual",
    "random",
    "class_centre",
)


def _seeds(text: str) -> tuple[int, ...]:
    try:
        return tuple(int(part) for part in text.split(","))
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is no list of seeds; for example 0,1,2") from None


def parser() -> argparse.ArgumentParser:
    """The command line."""
    top = CommandParser(prog="caretree learn physics")
    sub = top.add_subparsers(dest="command", required=True)
    for name, text in (("train", "train and predict every test"), ("evaluate", "train what is missing; table")):
        p = sub.add_parser(name, help=text)
        p.add_argument("data", metavar="DATA", help="data set with parts train, val and test")
        p.add_argument("--out", required=True, metavar="DIR", help="weights, predictions and results; resumable")
        p.add_argument("--test", action="append", default=[], metavar="DATA", help="another test set; may be repeated")
        p.add_argument("--cuts", metavar="DATA", help="clips of other cuts, learned from and tested too")
        p.add_argument("--method", action="append", default=[], choices=METHODS, help="only this one; may be repeated")
        p.add_argument("--seeds", type=_seeds, default=(0, 1, 2), metavar="0,1,2")
        p.add_argument(
            "--steps", type=whole_number, default=STEPS, metavar="N", help=f"of each phase (default {STEPS})"
        )
        p.add_argument("--backbone", default="scores", choices=("scores", "small", "densenet121"))
        p.add_argument(
            "--simulate",
            type=whole_number,
            default=100,
            metavar="N",
            help="clips of each test that GP inversion corrects by simulation (default 100, half a second each)",
        )
        p.add_argument(
            "--calibrate",
            type=whole_number,
            default=100,
            metavar="N",
            help="clips of each sort that set the intervals' widths (default 100)",
        )
        p.add_argument("--partial", action="store_true", help="take what is there of unfinished data sets")
    p = sub.add_parser("identify", help="parameters with intervals from one clip; writes a gown file")
    p.add_argument("clip", metavar="CLIP", help="an .npz, as `caretree learn physics clip` writes it")
    p.add_argument("--out", metavar="FILE", help="gown file for `caretree run dressing --gown FILE`")
    p.add_argument("--cut", default="medium", metavar="NAME", help="the gown's cut, which is known (default medium)")
    p.add_argument("--weights", metavar="FILE", help="instead of those in the package")
    p.add_argument("--fast", action="store_true", help="do not correct the answer by simulation")
    p = sub.add_parser("pictures", help="t-SNE, box plots and filmstrips of a study")
    p.add_argument("study", metavar="DIR", help="folder that `evaluate` wrote to")
    p.add_argument("data", metavar="DATA", help="the data set it was trained on")
    p.add_argument("--out", required=True, metavar="DIR", help="folder for the pictures")
    p.add_argument("--also", action="append", default=[], metavar="DIR", help="another study, for the box plot")
    p.add_argument("--weights", metavar="FILE", help="to identify the scene's gowns, instead of those in the package")
    p.add_argument("--partial", action="store_true", help="take what is there of an unfinished data set")
    return top


def main(argv: list[str]) -> int:
    """Run one command; 0 when all went well.

    Raises:
        CaretreeError: the input cannot be used.
    """
    options = parser().parse_args(argv)
    if options.command == "identify":
        return _identify(options)
    try:
        import torch  # pyright: ignore[reportMissingImports] - in the extra `learn`
    except ImportError as error:
        raise CaretreeError(
            f"`caretree learn physics {options.command}` needs PyTorch: pip install 'caretree[learn]'"
        ) from error
    torch.set_num_threads(1)  # clips are small: more threads only wait for each other
    if options.command == "pictures":
        from .methods.weights import PACKAGED
        from .study.figures import draw

        for path in draw(
            Path(options.study),
            Path(options.data),
            Path(options.out),
            partial=options.partial,
            also=[Path(one) for one in options.also],
            weights=Path(options.weights or PACKAGED),
        ):
            print(path)
        return 0
    return _study(options)


def _say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


def _study(options: argparse.Namespace) -> int:
    from .methods.examples import load_examples
    from .study.evaluate import table, write_results
    from .study.registry import Plan
    from .study.study import Study

    out = Path(options.out)
    data = load_examples(Path(options.data), out, partial=options.partial)
    tests = {}
    for folder in options.test:
        loaded = load_examples(Path(folder), out, partial=options.partial)
        tests[loaded.kind] = loaded
    plan = Plan(steps=options.steps, backbone=options.backbone, folder=out, say=_say)
    cuts = load_examples(Path(options.cuts), out, partial=options.partial) if options.cuts else None
    study = Study(
        data=data,
        tests=tests,
        plan=plan,
        seeds=options.seeds,
        simulate=options.simulate,
        calibrate=options.calibrate,
        cuts=cuts,
    )
    study.run(_say, tuple(options.method))
    path = write_results(study)
    if options.command == "evaluate":
        print(table(json.loads(path.read_text(encoding="utf-8"))))
    print(path)
    return 0


def _identify(options: argparse.Namespace) -> int:
    from .clips.clip import Clip
    from .methods.weights import PACKAGED, load_weights
    from .study.identify import identify, write

    if options.out and (Path(options.out).is_dir() or not Path(options.out).parent.is_dir()):
        raise CaretreeError(
            f"{options.out}: a gown file cannot be written there, it must be a file in a folder that exists"
        )
    clip = Clip.load(options.clip)
    method, _ = load_weights(options.weights or PACKAGED)
    start = time.perf_counter()
    found = identify(clip, method, options.cut, simulate=not options.fast)
    print(found.table())
    _say(
        f"{time.perf_counter() - start:.1f} s; a {'camera' if found.rough else 'rendered'} clip, "
        f"explained {_fit(found.misfit)}"
    )
    if options.out:
        print(write(found, options.out))
    return 0


def _fit(misfit: float) -> str:
    if misfit <= 2:
        return "as well as a simulated one"
    return f"{misfit:.1f} times worse than a simulated one, and the intervals are wider for it"
