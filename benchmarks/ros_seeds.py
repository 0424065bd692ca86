"""Whether a task does through a real ROS 1 master what it does in its own process: outcome, and order of the leaves.

For every seed the scripted robot (`caretree serve-robot`) and the tree are two processes beside one master, and time
passes as the tree waits.

    make ros && python benchmarks/ros_seeds.py [TASK [FIRST LAST]]      # wave, seeds 100 to 119
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from caretree.sim.ros1.ros import DEBIAN, ask_master
from caretree.sim.world import WorldError
from caretree.trees.run.task import load_task

PORT = 11610
CARETREE = [sys.executable, "-P", "-m", "caretree.trees.cli"]
PATIENCE = 3600.0  # [s] for one run, on a machine that has much else to do
TOLD = 2000  # characters of what a robot has said last, where its tree did otherwise
STARTING = 60.0  # [s] for the master, and for the robot


def told(record: Path) -> tuple[str, list[tuple[str, str]]]:
    """Outcome of a run, and its nodes in the order in which they ended, each with how; prints why if it failed."""
    events = [json.loads(line) for line in (record / "trace.jsonl").read_text().splitlines()]
    ended = [(each["node"], each["status"]) for each in events if each.get("status") in ("SUCCESS", "FAILURE")]
    run = json.loads((record / "run.json").read_text())
    if run["outcome"] != "success":
        print(f"{record.name}: {run['outcome']}, {run['reason']}", flush=True)
    return run["outcome"], ended


def tree(task: str, seed: int, world: str, folder: Path, *more: str) -> tuple[str, list[tuple[str, str]]]:
    """Run a task; what its record tells."""
    out = folder / world
    command = [*CARETREE, "run", task, "--seed", str(seed), "--world", world, "--out", str(out), *more]
    done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE, check=False)
    if not (out / "run.json").exists():
        return f"no record: {done.stderr.strip()[-200:]}", []
    return told(out)


def through_master(task: str, seed: int, folder: Path) -> tuple[str, list[tuple[str, str]]]:
    """Run it on a robot of its own behind the master."""
    serve = [*CARETREE, "serve-robot", "--task", task, "--seed", str(seed), "--pace", "tree"]
    said = folder / "robot.txt"
    with said.open("w") as file:  # into a pipe that nobody reads it would once write no more, and wait
        robot = subprocess.Popen(serve, stdout=file, stderr=subprocess.STDOUT)
    try:
        ends = time.monotonic() + STARTING
        while "serving" not in said.read_text():
            assert robot.poll() is None, said.read_text()
            assert time.monotonic() < ends, "the robot does not come up"
            time.sleep(0.1)
        senses = ("--senses", "scripted") if load_task(task).script is not None else ()
        return tree(task, seed, "ros1", folder, *senses)
    finally:
        robot.send_signal(signal.SIGTERM)
        try:
            robot.wait(20.0)
        except subprocess.TimeoutExpired:
            robot.kill()
            robot.wait()


def parted(here: list[tuple[str, str]], there: list[tuple[str, str]]) -> str:
    """Where two orders part, in words."""
    for n, (one, other) in enumerate(zip(here, there, strict=False)):
        if one != other:
            return f"they part at {n}: {one}, {other}"
    return "one goes on"


def main(task: str = "wave", first: str = "100", last: str = "119") -> None:
    """Print one line for each seed, and how many were the same."""
    master = subprocess.Popen(["rosmaster", "--core", "-p", str(PORT)], stdout=subprocess.DEVNULL, stderr=-2)
    same = 0
    seeds = range(int(first), int(last) + 1)
    try:
        ends = time.monotonic() + STARTING
        while True:
            try:
                ask_master("getPid")
                break
            except WorldError:
                assert time.monotonic() < ends, "the master does not come up"
                time.sleep(0.2)
        for seed in seeds:
            with tempfile.TemporaryDirectory() as made:
                began = time.monotonic()
                here, there = tree(task, seed, "scripted", Path(made)), through_master(task, seed, Path(made))
                robot = (Path(made) / "robot.txt").read_text()
            alike = here == there
            same += alike
            said = "same" if alike else f"other, {parted(here[1], there[1])}"
            print(
                f"{task} {seed}: {said}; {here[0]} and {there[0]}, {len(here[1])} and {len(there[1])} ends of nodes, "
                f"{time.monotonic() - began:.0f} s",
                *([] if alike else [robot[-TOLD:]]),
                flush=True,
            )
    finally:
        master.kill()
        master.wait()
    print(f"{task}: {same} of {len(seeds)} seeds with the same outcome and the same order of leaves")


if __name__ == "__main__":
    if DEBIAN not in sys.path and not Path(DEBIAN, "rospy").is_dir():
        sys.exit("ROS 1 is not here: make ros")
    os.environ |= {"ROS_MASTER_URI": f"http://127.0.0.1:{PORT}", "ROS_IP": "127.0.0.1"}
    main(*sys.argv[1:])
