"""`caretree gap`: find, name, add, show, run, export, fetch, import, record and bench."""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING

from ...sim.command_line import CommandParser, answered, at_least_one, seed
from .errors import GapError

if TYPE_CHECKING:
    from .findings import Verdict


def parser() -> argparse.ArgumentParser:
    """The command line."""
    top = CommandParser(
        prog="caretree gap",
        description="Find where simulation and measurement disagree, name the "
        "missing effect, add it to the model and show that the gap shrinks.",
    )
    sub = top.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for command, text in (
        ("run", "the whole workflow: report.html, verdict.json, model.yaml"),
        ("find", "first step: where model and measurement disagree beyond noise"),
    ):
        p = sub.add_parser(command, help=text)
        p.add_argument("set", help="folder with measurement.yaml")
        p.add_argument("--out", required=True, help="folder for the results")
        p.add_argument("--alpha", type=float, default=0.05, help="level of the tests (default 0.05)")
        p.add_argument(
            "--system", default="", help="a simulator of one's own: path.py:Class, or an installed one's name"
        )
    for command, text in (
        ("name", "second step: which effect is missing"),
        ("add", "third step: write model.yaml"),
        ("show", "fourth step: held-out gap before and after, report"),
    ):
        sub.add_parser(command, help=text).add_argument("out", help="folder the step before wrote to")
    p = sub.add_parser("export", help="the named effects in a robot file: friction, damping, armature and mass")
    p.add_argument("out", help="folder with model.yaml")
    p.add_argument("--robot", help="URDF or MJCF to start from (default: what model.yaml names)")
    p.add_argument("--to", required=True, help="file to write")
    p = sub.add_parser("fetch", help="turn a published data set into a measurement set")
    p.add_argument("name", help="data set, or `list`")
    p.add_argument("--out", help="folder for the measurement set")
    p.add_argument("--data", help="folder that already holds the data sets (else they are downloaded)")
    p = sub.add_parser("import", help="turn logs of a robot's joints into a measurement set")
    p.add_argument("logs", nargs="+", help="MCAP files or ROS 1 bags; a single one is cut in two")
    p.add_argument("--joints", required=True, help="names or patterns, comma-separated: 'left_*', shoulder to wrist")
    p.add_argument("--robot", help="URDF, or a name in example-robot-data (default: what the log brings)")
    p.add_argument("--topic", help="of the joint states, where there are several")
    p.add_argument("--out", required=True, help="folder for the measurement set")
    p = sub.add_parser("record", help="record a measurement set from the dressing world's gown")
    p.add_argument("--gown", default="light", help="name of a gown, or path of a gown file (default light)")
    p.add_argument("--model", help="model.yaml whose effects act while recording")
    p.add_argument("--out", required=True, help="folder for the measurement set")
    p.add_argument("--seed", type=seed, default=0, help="of the markers' noise (default 0)")
    p.add_argument("--duration", type=float, default=1.2, help="of each recording in seconds (default 1.2)")
    p.add_argument("--noise", type=float, default=0.001, help="of the markers in metres (default 0.001)")
    p = sub.add_parser("bench", help="the blind benchmark, scored")
    p.add_argument("--system", default="axis,arm,fall", help="comma-separated (default axis,arm,fall)")
    p.add_argument("--seeds", default="0:200", help="first:last (default 0:200)")
    p.add_argument(
        "--half",
        choices=("tune", "report", "both"),
        default="report",
        help="even seeds were used to choose thresholds, odd ones are reported (default report)",
    )
    p.add_argument(
        "--out", default="runs/gap-bench", help="folder for sets, truth and results; finished seeds are kept"
    )
    p.add_argument(
        "--ablations", action="store_true", help="also score one-shot least squares, STLSQ and the all-terms fit"
    )
    p.add_argument(
        "--observer", action="store_true", help="also say what an observer who knows the noise would name from drops"
    )
    p.add_argument(
        "--follow-up",
        action="store_true",
        help="of drops: make the recordings each verdict asks for, run again, and score both rounds",
    )
    p.add_argument("--jobs", type=at_least_one, default=1, help="processes")
    return top


def main(argv: list[str] | None = None) -> int:
    """Run one command.  Returns 0, or 2 where the user's input cannot be used (one sentence on stderr)."""
    return answered(
        "caretree gap",
        lambda: _dispatch(parser().parse_args(argv)),
        interrupted="interrupted; what is finished is kept",
        extra="gap",
    )


def _say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


def _dispatch(args: argparse.Namespace) -> int:
    if args.command == "fetch":
        from .catalogue import fetch

        return fetch(args.name, args.out, args.data, print)
    if args.command == "import":
        from .importers.joint_log import import_logs

        logs = [Path(log) for log in args.logs]
        print(import_logs(logs, Path(args.out), args.joints.split(","), args.robot, args.topic))
        return 0
    if args.command == "record":
        from .record import record

        for file in record(args.gown, args.model, Path(args.out), args.seed, args.duration, args.noise):
            print(file)
        return 0
    if args.command == "export":
        from .export import export

        for what in export(Path(args.out), args.robot, Path(args.to)):
            _say(f"{what}: not in this format, it stands in model.yaml alone")
        print(args.to)
        return 0
    if args.command == "bench":
        from .bench.run import run

        return run(
            args.system.split(","),
            args.seeds,
            args.half,
            Path(args.out),
            args.ablations,
            args.jobs,
            print,
            args.observer,
            args.follow_up,
        )
    _step(args)
    return 0


def _step(args: argparse.Namespace) -> None:
    """One of the steps, or all of them."""
    from . import steps

    if args.command in ("find", "run") and not 0.0 < args.alpha < 0.5:
        raise GapError(f"--alpha is {args.alpha:g}, it must lie between 0 and 0.5")
    out = Path(args.out)
    if args.command == "find":
        study = steps.find(Path(args.set), out, args.alpha, _say, args.system)
        p = study.find()[0]
        print(f"{'adequate' if p >= args.alpha else 'not adequate'}: p = {p:.3g} ({out / 'find.json'})")
    elif args.command == "name":
        steps.name(out, _say)
        print(f"{out / 'name.json'}")
    elif args.command == "add":
        steps.add(out, _say)
        print(f"{out / 'model.yaml'}")
    else:
        started = time.monotonic()
        if args.command == "run":
            study = steps.find(Path(args.set), out, args.alpha, _say, args.system)
            steps.name(out, _say, study)
            steps.add(out, _say, study)
            verdict = steps.show(out, _say, study, started)
        else:
            verdict = steps.show(out, _say)
        _print_verdict(verdict, out)


def _print_verdict(verdict: Verdict, out: Path) -> None:
    named = ", ".join(f"{f.name} on {f.target}" for f in verdict.effects) or "none"
    changed = ", ".join(f"{f.name} on {f.target}" for f in verdict.recalibration)
    named += f"; recalibrated {changed}" if changed else ""
    print(
        f"{verdict.verdict}: effects {named}; held-out gap {verdict.gap.before:.4g} -> {verdict.gap.after:.4g} "
        f"{verdict.gap.unit} (floor {verdict.gap.floor:.4g}); {out / 'report.html'}"
    )


if __name__ == "__main__":
    sys.exit(main())
