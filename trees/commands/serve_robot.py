"""`caretree serve-robot`: a simulated world as the robot behind a ROS 1 master, for rehearsals and tests."""

from __future__ import annotations

import argparse
import signal

from ...sim.command_line import INTERRUPTED, seed
from ...sim.errors import CaretreeError
from ..run.task import load_task
from ..run.worlds import make_world, prepare_stage, read_world_arguments


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command to the command line; `main` runs it."""
    parser = subparsers.add_parser(
        "serve-robot",
        help="have a simulated world be the robot behind a ROS 1 master",
        description="Serve a simulated world on the topics and actions of a site, with /clock, as its robot does; then "
        "`caretree run TASK --world ros1`.  ROS_MASTER_URI says where the master is.",
    )
    parser.add_argument("--world", default="scripted", metavar="WORLD", help="bullet, scripted (default), or your own")
    parser.add_argument("--task", default="wave", metavar="TASK", help="furnishes the world (default: wave)")
    parser.add_argument("--stage", metavar="NAME", help="begin where this stage of the task does")
    parser.add_argument("--seed", type=seed, default=0, metavar="N", help="of all that varies (default 0)")
    parser.add_argument("--world-arg", action="append", default=[], metavar="NAME=VALUE", help="of the world")
    parser.add_argument("--site", default="baxter", metavar="FILE", help="site file (default: baxter)")
    parser.add_argument(
        "--pace",
        default="wall",
        choices=("wall", "tree"),
        help="who lets time pass: the wall clock (default), or the tree as it waits, however long that takes",
    )
    parser.add_argument("--speed", type=float, default=1.0, metavar="X", help="of time beside the wall clock's (1)")
    parser.add_argument("--rate", type=float, default=100.0, metavar="HZ", help="of the joint states (100)")
    parser.add_argument("--camera-rate", type=float, default=5.0, metavar="HZ", help="of the images (5)")
    parser.set_defaults(main=main)


def main(options: argparse.Namespace) -> int:
    """Serve until somebody presses Ctrl-C.

    Raises:
        CaretreeError: bad input, or ROS or its master is missing.
    """
    from ...sim.ros1.robot_side import RobotSide

    for name in ("speed", "rate", "camera_rate"):
        if not 0.0 < getattr(options, name) < 10_000.0:
            raise CaretreeError(f"--{name.replace('_', '-')} is {getattr(options, name)}, but more than 0 is asked for")
    task = load_task(options.task)
    arguments = read_world_arguments(options.world, options.world_arg)
    world, _ = make_world(options.world, task, seed=options.seed, arguments=arguments)
    try:
        prepare_stage(world, task, options.stage)
        robot = RobotSide(
            world,
            options.site,
            pace=options.pace,
            speed=options.speed,
            rate=options.rate,
            camera_rate=options.camera_rate,
        )
        signal.signal(signal.SIGTERM, lambda *_: robot.end())
        print(f"serving {options.world} as {options.site}, pace of the {options.pace}", flush=True)
        try:
            robot.serve()
        except KeyboardInterrupt:
            return INTERRUPTED
        return 0
    finally:
        world.close()
