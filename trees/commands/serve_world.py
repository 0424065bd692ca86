"""`caretree serve-world WORLD`: a tree in another process, perhaps on another Python, moves its robot."""

from __future__ import annotations

import argparse

from ...sim.command_line import INTERRUPTED, PORTS, seed
from ...sim.errors import CaretreeError
from ...sim.extras import need
from ...sim.remote.server import WorldServer
from ...sim.remote.world import PORT
from ..run.stop_signals import StopSignals
from ..run.task import Task, load_task
from ..run.worlds import make_world, prepare_stage, read_world_arguments

HERE = f"127.0.0.1:{PORT}"


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command to the command line; `main` runs it."""
    parser = subparsers.add_parser(
        "serve-world",
        help="offer a world to a tree in another process",
        description="Offer a world to `caretree run TASK --world remote --world-arg address=HOST:PORT`, to one tree at "
        "a time.  Its robot is stopped when the tree falls silent or is gone.  Whoever reaches the address can move "
        "it: nobody is asked who they are.",
    )
    parser.add_argument("world", metavar="WORLD", help="as for `caretree run --world`")
    parser.add_argument("--task", default="wave", metavar="TASK", help="furnishes the world (default: wave)")
    parser.add_argument("--stage", metavar="NAME", help="begin where this stage of the task does")
    parser.add_argument("--seed", type=seed, default=0, metavar="N", help="of all that varies (default 0)")
    parser.add_argument("--world-arg", action="append", default=[], metavar="NAME=VALUE", help="of the world")
    parser.add_argument("--bind", default=HERE, metavar="HOST:PORT", help=f"who may reach it (default: {HERE})")
    parser.add_argument("--once", action="store_true", help="end when the first tree has gone")
    parser.set_defaults(main=main)


def main(options: argparse.Namespace) -> int:
    """Serve until somebody presses Ctrl-C, or once.

    Raises:
        CaretreeError: bad input, or the port is taken.
    """
    host, _, port = options.bind.rpartition(":")
    if not (host and port.isascii() and port.isdigit() and int(port) < PORTS):
        raise CaretreeError(f"--bind is {options.bind!r}, but HOST:PORT is asked for")
    need("msgpack", "a world in another process")
    task = load_task(options.task)
    arguments = read_world_arguments(options.world, options.world_arg)
    with StopSignals(suspends=False):  # none of them may end this process with the robot moving
        return _serve(options, host, int(port), task, arguments)


def _serve(options: argparse.Namespace, host: str, port: int, task: Task, arguments: dict[str, object]) -> int:
    world, _ = make_world(options.world, task, seed=options.seed, arguments=arguments)
    try:
        prepare_stage(world, task, options.stage)
        try:
            server = WorldServer(world, host, port)
        except OSError as error:
            raise CaretreeError(f"{options.bind} cannot be served: {error.strerror or error}") from error
        try:
            print(f"serving {options.world} at {server.address}", flush=True)
            while True:
                print(f"gone: {server.serve_one()}", flush=True)
                if options.once:
                    return 0
        except KeyboardInterrupt:
            return INTERRUPTED
        finally:
            server.close()
    finally:
        world.close()
