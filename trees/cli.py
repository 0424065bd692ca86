"""The command line: `caretree run|check|inject|replay|skills|new|export|report|trials|evaluate|...`.

A user's mistake is answered by one sentence and exit status 2.
"""

from __future__ import annotations

import argparse
import gc
import importlib
import importlib.util
import io
import os
import sys
from collections.abc import Sequence

from ..sim.command_line import CommandParser, answered, at_least_one, port, rate, seed
from ..sim.errors import CaretreeError
from ..sim.portable_blas import portable_blas

SELF_PARSED = {
    "trials": (".commands.trials", "run many seeds and count successes, by stage and overall"),
    "serve-world": (".commands.serve_world", "offer a world to a tree in another process"),
    "serve-robot": (".commands.serve_robot", "have a simulated world be the robot behind a ROS 1 master"),
    "robot": (".commands.robot", "say what a robot behind a ROS 1 master lacks, before anything moves"),
    "export": (".commands.export", "write a task's tree, or what robots did, for other programs"),
    "evaluate": (".commands.evaluate", "say from the record alone whether the run reached its goal"),
}
# said by --help, which must not import what knows them; a test compares
WORLDS = ("bullet", "scripted")
GOWNS, PERSONS = "medium, large, light", "average, small, stiff"
ROBOTS = "baxter, ur5-pair"
ENGINES = "bullet, spring, spring-layers"
LOOKS = "taped, plain, printed, random"
WORLD_KINDS = (
    "easy, easy+falling_arms, easy+camera_extrinsics, easy+localisation, easy+encoders, easy+late_images, "
    "easy+wrench_bias, easy+depth_noise, easy+thinking_time, easy+skin_friction, hard"
)
FAULTS = (
    "grip_slip, occlusion, stale_frame, force_spike, lost_command, person_moves, camera_out, dead_camera, dead_sensor"
)
IN_THE_RECORD = ""  # where --log is written if no file is given
SHELLS = ("bash", "zsh")
# Objects made until Python looks for circles among them, instead of 700: what a command loads is much and forms none
# that end, and looking through it takes a tenth of a short command.
MADE_UNTIL_LOOKED_THROUGH = 50_000
EXTRAS = {"gap": "gap", "learn": "learn", "robot": "ros", "serve-robot": "ros"}  # of commands that need one
DELEGATED = {"gap": "..learning.gap.cli", "learn": ".commands.learn"}


class _Version(argparse.Action):
    """Prints the version; it is looked up only when it is asked for."""

    def __call__(self, parser: argparse.ArgumentParser, *unused: object) -> None:
        from importlib.metadata import PackageNotFoundError, version

        try:
            print(f"caretree {version('caretree')}")
        except PackageNotFoundError:  # run from its sources
            print("caretree, not installed")
        parser.exit()


def _kind_option(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--world-kind",
        default="easy",
        metavar="KIND",
        help=f"how hard the bullet world is made: {WORLD_KINDS} (default: easy)",
    )


def _world_choice(parser: argparse.ArgumentParser, default: str) -> None:
    parser.add_argument(
        "--world",
        default=default,
        metavar="WORLD",
        help=f"{', '.join(WORLDS)}, an installed one, package.module:Class or file.py:Class (default: {default})",
    )
    parser.add_argument(
        "--world-arg",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="what such a class takes; may be repeated",
    )
    _kind_option(parser)


def _robot_option(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--robot",
        metavar="NAME",
        help=f"{ROBOTS}, or package.module:NAME of a RobotModel; bullet and scripted world only (default: baxter)",
    )


def _world_options(parser: argparse.ArgumentParser) -> None:
    _world_choice(parser, "bullet")
    parser.add_argument("--gown", metavar="NAME", help=f"{GOWNS}, or a gown file (default: the seed decides)")
    parser.add_argument("--person", metavar="NAME", help=f"{PERSONS} (default: the seed decides)")
    parser.add_argument("--look", metavar="NAME", help=f"of gown, person and room: {LOOKS} (default: taped)")
    parser.add_argument(
        "--engine", metavar="NAME", help=f"what moves the bullet world's cloth: {ENGINES} (default: bullet)"
    )
    parser.add_argument("--model", metavar="FILE", help="model.yaml with physical effects to add")
    parser.add_argument(
        "--stage", metavar="NAME", help="this stage alone, or a span such as dress-spread, from a world prepared for it"
    )


def _senses_option(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--senses",
        default="own",
        choices=("own", "scripted"),
        help="what sees: the task's own senses, or made up ones, to rehearse on a robot with nothing to see",
    )


def build_parser(command: str = "") -> argparse.ArgumentParser:
    """The parser of all commands; `command` is the one that will be called."""
    parser = CommandParser(prog="caretree", description="Behaviour trees for assistive manipulation.")
    parser.add_argument("--version", action=_Version, nargs=0, help="print the version and exit")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")

    run = commands.add_parser("run", help="run a task", description="Run a task and write its record.")
    run.add_argument("task", metavar="TASK", help="name of a task, or path of a task file")
    run.add_argument("--seed", type=seed, default=0, metavar="N", help="of all that varies (default 0)")
    _world_options(run)
    _robot_option(run)
    run.add_argument(
        "--inject",
        action="append",
        default=[],
        metavar="FAULT@NODE:PHASE",
        help=f"may be repeated; FAULT: {FAULTS}; NODE: a skill, see `check --tree`; PHASE: start, step or cancel",
    )
    run.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="a parameter of the task, see `caretree check TASK`, or SKILL.NUMBER=VALUE: a number of every leaf of "
        "that skill, see `caretree skills SKILL`; may be repeated",
    )
    run.add_argument("--tuning", metavar="FILE", help="YAML file of both: parameter, value; skill, number, value")
    run.add_argument(
        "--from",
        dest="start",
        metavar="RECORD@SECONDS",
        help="begin where another run was then, with empty hands and its seed; with --stage, to try again what it lost",
    )
    _senses_option(run)
    run.add_argument(
        "--perception",
        default="classical",
        choices=("classical", "learned"),
        help="what tells surfaces in a picture: rules on colours, or the network, for any gown and skin (default: "
        "classical)",
    )
    run.add_argument(
        "--pregrasp",
        default="classical",
        choices=("classical", "learned"),
        help="what chooses how the other hand takes a gown that hangs from one: rules on colours, or the trained "
        "policy (default: classical)",
    )
    run.add_argument("--video", default="on", choices=("on", "off"), help="whether the record has one (default: on)")
    run.add_argument("--unchecked", action="store_true", help="run it although `caretree check` would find faults")
    run.add_argument("--view", action="store_true", help="serve a live 3D view to the browser; prints its address")
    run.add_argument("--port", type=port, metavar="N", help="of the view (default: the first free one from 8080 on)")
    run.add_argument(
        "--groot",
        type=port,
        nargs="?",
        const=1667,
        metavar="PORT",
        help="let Groot2 watch, and hold a simulated run at breakpoints (default: port 1667, and the next one)",
    )
    run.add_argument("--out", metavar="DIR", help="folder of the record (default: a new one under runs/)")
    run.add_argument(
        "--log",
        metavar="FILE",
        nargs="?",
        const=IN_THE_RECORD,
        help="MCAP file of what the robot measured, saw and was sent, for Foxglove (default: one in the record)",
    )
    run.add_argument(
        "--log-rate",
        type=rate,
        metavar="HZ",
        help="measure for the log between ticks too, so many times a second; simulated noise is then another one",
    )

    check = commands.add_parser("check", help="prove the wiring and the fail-safes before anything moves")
    check.add_argument("task", metavar="TASK", help="name of a task, or path of a task file")
    _robot_option(check)
    check.add_argument("--tree", action="store_true", help="draw the tree instead: nodes, recoveries and data")

    inject = commands.add_parser("inject", help="fault campaign: every node, phase and fault")
    inject.add_argument("task", metavar="TASK", help="name of a task, or path of a task file")
    inject.add_argument("--seed", type=seed, default=0, metavar="N", help="of every run (default 0)")
    _world_choice(inject, "scripted")
    _robot_option(inject)
    inject.add_argument(
        "--fault",
        action="append",
        default=[],
        metavar="FAULT",
        help=f"only this one; may be repeated; there are {FAULTS}",
    )
    _senses_option(inject)
    inject.add_argument("--stage", metavar="NAME", help="this stage alone, or a span such as dress-spread")
    inject.add_argument("--sample", type=int, metavar="N", help="only N of all, drawn by the seed")
    inject.add_argument(
        "--jobs", type=at_least_one, metavar="J", help="runs at the same time (1; on a cluster as many as it has cores)"
    )
    inject.add_argument("--address", metavar="ray://...", help="run them on a Ray cluster; `local` starts one here")
    inject.add_argument("--out", metavar="DIR", help="folder that keeps finished rows (default: one under runs/)")

    _of_record(commands, "replay", "run a record again and say where it differs")

    skills = commands.add_parser("skills", help="list the skills; of one its ports, reasons and numbers")
    skills.add_argument("name", nargs="?", metavar="NAME", help="of a skill: present_sleeve or PresentSleeve")

    new = commands.add_parser("new", help="begin a task: a task file that runs, with its scripted world and its test")
    new.add_argument("name", metavar="TASK", help="name of the task, a Python name such as fetch_gown")
    new.add_argument("--out", default=".", metavar="DIR", help="folder for its files (default: here)")

    view = _of_record(commands, "view", "look at a record in the browser, with a time slider")
    view.add_argument("--port", type=port, metavar="N", help="default: the first free one from 8080 on")

    _of_record(commands, "report", "draw the page of a record, of a run cut short too")

    completion = commands.add_parser("completion", help="print what makes a shell complete caretree's words")
    completion.add_argument(
        "shell", metavar="SHELL", choices=SHELLS, help='bash or zsh: eval "$(caretree completion bash)"'
    )

    for name, (module, summary) in SELF_PARSED.items():
        if name == command:  # the others' modules stay unread: help must be instant
            importlib.import_module(module, __package__).add_parser(commands)
        else:
            commands.add_parser(name, help=summary)
    commands.add_parser("gap", help="find, name, add and show what a model lacks", add_help=False)
    commands.add_parser("learn", help="datasets, training and evaluation of learned parts", add_help=False)
    return parser


def _of_record(commands: argparse._SubParsersAction[CommandParser], name: str, what: str) -> CommandParser:
    """The parser of a command on one record."""
    parser = commands.add_parser(name, help=what, description=f"{what[0].upper()}{what[1:]}.")
    parser.add_argument("directory", metavar="DIR", help="folder of the record, with run.json in it")
    return parser


def _dispatch(argv: list[str]) -> int:
    if argv and argv[0] in DELEGATED:
        name = importlib.util.resolve_name(DELEGATED[argv[0]], __package__)
        try:
            module = importlib.import_module(name)
        except ModuleNotFoundError as error:
            if error.name is None or not name.startswith(error.name):
                raise  # it is there and lacks something else
            raise CaretreeError(f"`caretree {argv[0]}` is not in this version") from error
        return int(module.main(argv[1:]) or 0)
    options = build_parser(argv[0] if argv else "").parse_args(argv)
    if hasattr(options, "main"):
        return int(options.main(options) or 0)
    return int(importlib.import_module(f".commands.{options.command}", __package__).main(options))


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command and return its exit status."""
    for name in ("stdout", "stderr"):  # None where whoever started the program had closed it
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115 - as long as the program
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")  # a terminal without an accent must not end a run
    portable_blas()
    gc.set_threshold(MADE_UNTIL_LOOKED_THROUGH)
    given = list(sys.argv[1:] if argv is None else argv)
    return answered("caretree", lambda: _dispatch(given), extra=EXTRAS.get(given[0]) if given else None)


if __name__ == "__main__":
    sys.exit(main())
