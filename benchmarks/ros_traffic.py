"""A task on the PyBullet robot behind a ROS 1 master: judged, with its latencies and the messages that got lost.

The robot's side (`caretree serve-robot --world bullet --record`), the tree and the master are three processes.  Both
ends count what they publish and what they are given, and when.

    make ros && python benchmarks/ros_traffic.py OUT [--task dressing] [--stage lay] [--seed 104] [--pace tree]
                                                  [--end-after NODE]

| row | from | to |
|---|---|---|
| sample on its way | a joint state is published | it is in the tree's process |
| sample to use | a joint state is published | an observation of it is used by the tree or its guard, each time |
| age by the robot's clock | the stamp of an observation | `/clock` when it is used |
| command to effect | the tree sends a motion to joints at rest | the first joint state that shows them moving |
"""

from __future__ import annotations

import argparse
import atexit
import collections
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
from caretree.sim.evaluate.verdict import evaluate
from caretree.sim.ros1.ros import DEBIAN, ask_master, ros
from caretree.sim.ros1.world import Ros1World
from caretree.sim.world import Command, HandTwist, JointTrajectory, Observation, WorldError

PORT = 11620
STARTING = 300.0  # [s] for the room
AT_REST, MOVING = 0.002, 0.01  # [rad/s]
FORGOTTEN = 2.0  # [s] after which a motion that is not seen was too small to be seen
JOINTS, CLOCK = "/robot/joint_states", "/clock"


class Traffic:
    """What passes one process, written to a file when it ends."""

    def __init__(self, file: str) -> None:
        self.sent: collections.Counter[str] = collections.Counter()  # to somebody
        self.got: collections.Counter[str] = collections.Counter()
        self.numbers: dict[str, list[int]] = collections.defaultdict(list)  # of messages with a header, as they came
        self.published: dict[int, float] = {}  # stamp of a joint state [ns] -> when [s]
        self.ticks: list[int] = []  # that `/clock` told, or heard [ns]
        self.times: dict[str, list[float]] = collections.defaultdict(list)
        self.arrived: dict[int, float] = {}
        atexit.register(lambda: Path(file).write_text(json.dumps(vars(self) | {"on_joints": None})))
        self.on_joints: Any = None
        self._patch()

    def _patch(self) -> None:
        """Have rospy tell of every message."""
        rospy, traffic = ros().rospy, self

        class Publisher(rospy.Publisher):
            def publish(self, *values: Any, **named: Any) -> None:
                traffic.sent[self.resolved_name] += self.get_num_connections() > 0
                traffic._note(self.resolved_name, values[0] if values else None, traffic.published)
                super().publish(*values, **named)

        class Subscriber(rospy.Subscriber):
            def __init__(self, name: str, kind: Any, callback: Any = None, callback_args: Any = None, **more: Any):
                def heard(message: Any, *given: Any) -> None:
                    traffic.got[name] += 1
                    if hasattr(message, "header"):
                        traffic.numbers[name].append(message.header.seq)
                    traffic._note(name, message, traffic.arrived)
                    callback(message, *given)

                super().__init__(name, kind, heard, callback_args, **more)

        rospy.Publisher, rospy.Subscriber = Publisher, Subscriber

    def _note(self, topic: str, message: Any, stamps: dict[int, float]) -> None:
        if topic == JOINTS:
            stamps.setdefault(message.header.stamp.to_nsec(), time.monotonic())
            if self.on_joints is not None:
                self.on_joints(message)
        elif topic == CLOCK and (not self.ticks or message.clock.to_nsec() > self.ticks[-1]):
            self.ticks.append(message.clock.to_nsec())


class Watched(Ros1World):
    """The tree's end, with an account of its traffic; `report` is the file for it."""

    def __init__(self, report: str) -> None:
        self._traffic = Traffic(report)
        self._awaited: list[tuple[set[str], float, float]] = []  # joints, and when they were sent somewhere [s], [s]
        self._moving: dict[str, float] = {}
        super().__init__(patience=60.0)
        self._traffic.on_joints = self._joints

    def observe(self) -> Observation:
        """Latest proprioception, whose use is noted."""
        seen = super().observe()
        joints = self._senses.joints
        assert joints is not None
        self._traffic.times[f"used {round(joints.stamp * 1e9)}"].append(time.monotonic())
        self._traffic.times["age"].append(self.clock.now() - seen.time)
        return seen

    def send(self, command: Command) -> Command:
        """Send it; a motion that begins at rest is waited for."""
        names: set[str] = set()
        if isinstance(command, JointTrajectory) and np.ptp(command.positions, axis=0).max() > MOVING:
            names = set(command.joints)
        elif isinstance(command, HandTwist) and np.abs(command.twist_in_map).max() > MOVING:
            names = set(self.site.arms[command.side].joints)
        if any(self._moving.get(name, 1.0) > AT_REST for name in names) or any(
            names & each[0] for each in self._awaited
        ):
            names = set()
        if names:
            self._awaited.append((names, time.monotonic(), self.clock.now()))
        return super().send(command)

    def _joints(self, message: Any) -> None:
        self._moving = dict(zip(message.name, np.abs(message.velocity), strict=True))
        for each in list(self._awaited):
            names, wall, clock = each
            stamp = message.header.stamp.to_sec() - self._origin
            if stamp <= clock:
                continue
            if any(self._moving.get(name, 0.0) > MOVING for name in names):
                self._traffic.times["effect, wall"].append(time.monotonic() - wall)
                self._traffic.times["effect, clock"].append(stamp - clock)
                self._awaited.remove(each)
            elif stamp - clock > FORGOTTEN:
                self._awaited.remove(each)


def told(name: str, values: Any) -> str:
    """A row of the table [ms]."""
    if not len(values):
        return f"| {name} | none |"
    middle, high, most = 1e3 * np.percentile(values, (50, 95, 100))
    return f"| {name} | {middle:.1f} | {high:.1f} | {most:.1f} | {len(values)} |"


def lost(robot: dict[str, Any], tree: dict[str, Any]) -> list[str]:
    """One row for each topic on which both have counted: how many were sent while somebody listened, and lost."""
    rows = []
    for topic, numbers in sorted(tree["numbers"].items()):
        asked = max(numbers) - min(numbers) + 1
        rows.append(f"| {topic} | {asked} | {asked - len(set(numbers))} |")
    heard = set(tree["ticks"])
    first, last = min(heard), max(heard)
    asked = [each for each in robot["ticks"] if first <= each <= last]
    rows.append(f"| {CLOCK} | {len(asked)} | {len(set(asked) - heard)} |")
    for topic, count in sorted(tree["sent"].items()):
        if topic in robot["got"]:
            rows.append(f"| {topic} | {count} | {count - robot['got'][topic]} |")
    return rows


def report(out: Path) -> None:
    """Print what the two ends have counted, and the verdict."""
    robot, tree = (json.loads((out / f"{name}.json").read_text()) for name in ("at_robot", "at_tree"))
    published = {int(stamp): when for stamp, when in robot["published"].items()}
    way = [when - published[int(stamp)] for stamp, when in tree["arrived"].items() if int(stamp) in published]
    used = []
    for name, whens in tree["times"].items():
        if name.startswith("used "):
            stamp = int(name[5:])
            used += [when - published[stamp] for when in whens if stamp in published]
    print("| [ms] | median | 95 % | most | of |\n|---|---|---|---|---|")
    print(told("sample on its way", way))
    print(told("sample to use", used))
    print(told("age by the robot's clock", tree["times"].get("age", [])))
    print(told("command to effect, wall clock", tree["times"].get("effect, wall", [])))
    print(told("command to effect, robot's clock", tree["times"].get("effect, clock", [])))
    print("\n| topic | messages | lost |\n|---|---|---|", *lost(robot, tree), sep="\n")
    run = json.loads((out / "tree" / "run.json").read_text())
    print(f"\nthe tree: {run['outcome']}, {run['reason']}; {run['sim_time_s']:.0f} s in {run['wall_time_s']:.0f} s")
    if (out / "robot").exists():
        print(f"the evaluator: {evaluate(out / 'robot')}")


def succeeded(record: Path, node: str) -> bool:
    """Whether a node has succeeded, as the record of a run that goes on tells."""
    trace = record / "trace.jsonl"
    lines = trace.read_text().split("\n")[:-1] if trace.exists() else []  # the last one may be half written
    events = [json.loads(line) for line in lines]
    return any(each.get("status") == "SUCCESS" and each["node"].endswith(node) for each in events)


def main() -> None:
    """Run it, and print the account."""
    parser = argparse.ArgumentParser()
    parser.add_argument("out", type=Path)
    parser.add_argument("--task", default="dressing")
    parser.add_argument("--stage")
    parser.add_argument("--seed", default="104")
    parser.add_argument("--world", default="bullet")
    parser.add_argument("--pace", default="tree")
    parser.add_argument("--end-after", metavar="NODE", help="tell the tree to end once a node of this name succeeded")
    given = parser.parse_args()
    given.out.mkdir(parents=True)
    same = ["--seed", given.seed, *(["--stage", given.stage] if given.stage else [])]
    serve = ["serve-robot", "--world", given.world, "--task", given.task, "--pace", given.pace, *same]
    serve += ["--record", str(given.out / "robot")] if given.world == "bullet" else []
    run = [sys.executable, "-P", "-m", "caretree.trees.cli", "run", given.task, *same, "--world", f"{__file__}:Watched"]
    run += ["--world-arg", f"report={given.out / 'at_tree.json'}", "--out", str(given.out / "tree")]
    run += ["--senses", "scripted"] if given.world == "scripted" and given.task != "wave" else []
    master = subprocess.Popen(["rosmaster", "--core", "-p", str(PORT)], stdout=subprocess.DEVNULL, stderr=-2)
    robot = None
    try:
        ends = time.monotonic() + STARTING
        while True:
            try:
                ask_master("getPid")
                break
            except WorldError:
                assert time.monotonic() < ends, "the master does not come up"
                time.sleep(0.2)
        ours = [sys.executable, __file__, "robot", str(given.out / "at_robot.json"), *serve]
        robot = subprocess.Popen(ours, stdout=subprocess.PIPE, text=True)
        assert robot.stdout is not None
        assert "serving" in robot.stdout.readline()
        tree = subprocess.Popen(run)
        if given.end_after:
            while tree.poll() is None and not succeeded(given.out / "tree", given.end_after):
                time.sleep(0.5)
            tree.send_signal(signal.SIGTERM)
        tree.wait()
    finally:
        if robot is not None:
            robot.send_signal(signal.SIGTERM)
            robot.wait(60.0)
        master.kill()
        master.wait()
    report(given.out)


if __name__ == "__main__":
    if DEBIAN not in sys.path and not Path(DEBIAN, "rospy").is_dir():
        sys.exit("ROS 1 is not here: make ros")
    os.environ |= {"ROS_MASTER_URI": f"http://127.0.0.1:{PORT}", "ROS_IP": "127.0.0.1"}
    if sys.argv[1:2] == ["robot"]:
        from caretree.trees.cli import main as command

        Traffic(sys.argv[2])
        sys.exit(command(sys.argv[3:]))
    main()
