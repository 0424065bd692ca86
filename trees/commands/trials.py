"""`caretree trials TASK -n N`: many seeds, one success table."""

from __future__ import annotations

import argparse
from pathlib import Path

from ...sim.command_line import INTERRUPTED, SEEDS, at_least_one
from ...sim.errors import CaretreeError
from ..campaign.key import campaign_key
from ..campaign.rows_file import write_parquet
from ..campaign.trials import TABLE, Plan, run_trials
from ..campaign.trials_table import collect
from ..run.stop_signals import StopSignals
from ..run.task import load_task

TRIALS_MAX = 100_000  # a run takes a second at least
PASSED_ON = (  # to every `caretree run`
    *("world", "world-kind", "gown", "person", "look", "engine", "model", "perception", "pregrasp", "tuning", "video"),
)


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command to the command line; `main` runs it."""
    parser = subparsers.add_parser(
        "trials",
        help="run many seeds and count successes, by stage and overall",
        description="Run TASK once for each seed, each in a process of its own.  Finished trials are kept: the same "
        "command goes on where it was interrupted.",
    )
    parser.add_argument("task", metavar="TASK")
    parser.add_argument("-n", type=int, metavar="N", help="number of trials, seeds 0 to N-1 (10)")
    parser.add_argument("--seeds", metavar="A-B", help="seeds A to B instead, or a list like 3,7,9")
    parser.add_argument(
        "--stage", metavar="NAME", help="this stage alone, or a span such as dress-spread, from a world prepared for it"
    )
    parser.add_argument(
        "--jobs", type=at_least_one, metavar="J", help="runs at the same time (1; on a cluster as many as it has cores)"
    )
    parser.add_argument("--address", metavar="ray://...", help="run them on a Ray cluster; `local` starts one here")
    parser.add_argument("--parquet", action="store_true", help="write trials.parquet too; needs pyarrow")
    parser.add_argument("--out", type=Path, metavar="DIR", help="folder of the campaign (runs/trials-TASK)")
    for name in PASSED_ON:
        parser.add_argument(f"--{name}", metavar=name.upper(), help="handed to every `caretree run`")
    parser.add_argument(
        "--inject",
        action="append",
        default=[],
        metavar="FAULT@NODE:PHASE",
        help="a fault in every run; may be repeated",
    )
    parser.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="a parameter of the task, or SKILL.NUMBER=VALUE, in every run; may be repeated",
    )
    parser.add_argument(
        "--world-arg",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="of the world, in every run; may be repeated",
    )
    parser.set_defaults(main=main)


def parse_seeds(count: int | None, seeds: str | None) -> tuple[int, ...]:
    """Seeds of `-n N` and `--seeds A-B`.

    Raises:
        CaretreeError: neither form fits, or both are given and differ.
    """
    if seeds is None:
        number = 10 if count is None else count
        if number < 1:
            raise CaretreeError(f"-n is {number}, but at least 1 trial is asked for")
        if number > TRIALS_MAX:
            raise CaretreeError(f"-n is {number}, but at most {TRIALS_MAX} trials are run at a time")
        return tuple(range(number))
    try:
        if "-" in seeds:
            first, last = (int(part) for part in seeds.split("-"))
            if last - first >= TRIALS_MAX:
                raise CaretreeError(f"--seeds is {seeds!r}, but at most {TRIALS_MAX} trials are run at a time")
            found = tuple(range(first, last + 1))
        else:
            found = tuple(int(part) for part in seeds.split(","))
    except ValueError as error:
        raise CaretreeError(f"--seeds is {seeds!r}, but A-B like 0-9 or a list like 3,7,9 is asked for") from error
    if any(not 0 <= each < SEEDS for each in found):
        raise CaretreeError(f"--seeds is {seeds!r}, but a seed is a whole number from 0 to {SEEDS - 1}")
    if not found:
        raise CaretreeError(f"--seeds is {seeds!r}, but A must not be above B")
    if count is not None and count != len(found):
        raise CaretreeError(f"-n is {count}, but --seeds {seeds} names {len(found)} seeds")
    return found


def main(args: argparse.Namespace) -> int:
    """Run the campaign and print its table; 0 when every trial came to an end, however it ended, else 1.

    Raises:
        CaretreeError: bad input, or the disk is full.
    """
    directory = args.out or Path("runs") / f"trials-{Path(args.task).stem}"
    given = {name: getattr(args, name.replace("-", "_")) for name in PASSED_ON}
    arguments = [part for name, value in given.items() if value for part in (f"--{name}", value)]
    arguments += [part for fault in args.inject for part in ("--inject", fault)]
    arguments += [part for text in args.set for part in ("--set", text)]
    arguments += [part for text in args.world_arg for part in ("--world-arg", text)]
    plan = Plan(
        task=args.task,
        key=campaign_key(load_task(args.task), arguments, world=args.world),
        seeds=parse_seeds(args.n, args.seeds),
        directory=directory,
        stage=args.stage,
        arguments=tuple(arguments),
        jobs=args.jobs,
        address=args.address,
    )
    try:
        with StopSignals():
            trials = run_trials(plan, lambda line: print(line, flush=True))
    except KeyboardInterrupt:
        print(f"interrupted: finished trials are kept in {directory}; the same command goes on", flush=True)
        return INTERRUPTED
    print(f"\n{(directory / TABLE).read_text(encoding='utf-8')}\n{directory / TABLE}")
    if args.parquet:
        print(write_parquet(directory, collect(directory, plan.key)))
    if len(trials) < len(plan.seeds):
        print(f"{len(plan.seeds) - len(trials)} trials were stopped or killed: the same command runs them again")
        return 1
    return 0
