"""`caretree serve-robot`: a simulated world as the robot behind a ROS 1 master, for rehearsals and tests."""

from __future__ import annotations

import argparse
import signal
import sys

from ...sim.abilities import SupportsRecording
from ...sim.command_line import INTERRUPTED, seed
from ...sim.errors import CaretreeError
from ...sim.record.record import RunResult
from ...sim.record.recorder import Recorder
from ...sim.world import World
from ..run.task import load_task
from ..run.worlds import make_world, prepare_stage, read_world_arguments

ENDED = "The robot was told to end; how its tree ended stands in the tree's own record."


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
    parser.add_argument("--record", metavar="DIR", help="folder for the truth, which `caretree evaluate` judges")
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

    def made() -> World:
        world, _ = make_world(options.world, task, seed=options.seed, arguments=arguments)
        try:
            prepare_stage(world, task, options.stage)
        except CaretreeError:
            world.close()
            raise
        return world

    robot = RobotSide(
        made,
        options.site,
        pace=options.pace,
        speed=options.speed,
        rate=options.rate,
        camera_rate=options.camera_rate,
        begins_with=task.initial_state(options.stage),
    )
    try:
        recorder = _recorder(options, robot.world) if options.record else None
        signal.signal(signal.SIGTERM, lambda *_: robot.end())
        print(f"serving {options.world} as {options.site}, pace of the {options.pace}", flush=True)
        try:
            robot.serve()
        except KeyboardInterrupt:
            return INTERRUPTED
        finally:
            if recorder is not None:
                recorder.finish(RunResult(outcome="safe_stop", reason=ENDED, sim_time_s=robot.world.clock.now()))
        return 0
    finally:
        robot.world.close()


def _recorder(options: argparse.Namespace, world: World) -> Recorder:
    """Of the truth of this world.

    Raises:
        CaretreeError: it has none, or the folder cannot be written.
    """
    if not isinstance(world, SupportsRecording):
        raise CaretreeError(f"--record needs a world with a ground truth, such as bullet: {options.world} has none")
    recorder = Recorder(
        options.record,
        task=options.task,
        seed=options.seed,
        world=options.world,
        parameters={"stage": options.stage} if options.stage else {},
        films=False,
    )
    world.attach_recorder(recorder, lambda error: print(f"the record is lost: {error}", file=sys.stderr, flush=True))
    return recorder
