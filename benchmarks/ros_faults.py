"""How long a robot behind a ROS 1 master moves on after each fault, on the wall clock.

A scripted robot (`caretree serve-robot`), a tree that turns one joint slowly, a master and this observer are four
processes.  The observer breaks one of them, or what joins them, in the middle of the motion and listens to the joint
states.  For the network to be cut, the tree lives in a network namespace of its own (Linux, root), joined to that of
the robot by one pair of interfaces.

    make ros && python benchmarks/ros_faults.py [--times N] [FAULT ...]
"""

from __future__ import annotations

import argparse
import collections
import contextlib
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from caretree.sim.ros1.ros import DEBIAN, ask_master, node, ros
from caretree.sim.ros1.site import read_site
from caretree.sim.world import WorldError

PORT = 11600
STILL = 1e-3  # [rad/s]
EARLY = 0.1  # [s] without motion before the fault: it did not end because of it
LASTS = 200.0  # [s] that one try may take
AGAIN = 10  # more tries at most of those that are counted: on a busy machine a watchdog may end the motion too early
NAMESPACE, HERE, THERE = "caretree-tree", "10.77.0.1", "10.77.0.2"  # the tree's network, and both of its ends
CARETREE = [sys.executable, "-P", "-m", "caretree.trees.cli"]
TASK = """
from caretree.skills.move_joint import MoveJoint
from caretree.skills.retreat import Retreat
from caretree.trees.nodes.decorators import FailSafe


def build(context):
    slow = MoveJoint("slowly", context, side="left", joint="w1", angle=1.2, speed=0.1)
    return FailSafe("safely", slow, Retreat("let go", context, hand_distance=0.0, ready="never"))
"""
# name -> process that is broken and by which signal, or what else is
FAULTS: dict[str, tuple[str, int]] = {
    "nothing (to its end)": ("", 0),
    "tree killed": ("tree", signal.SIGKILL),
    "tree frozen": ("tree", signal.SIGSTOP),
    "robot killed": ("robot", signal.SIGKILL),
    "robot frozen": ("robot", signal.SIGSTOP),
    "master killed": ("master", signal.SIGKILL),
    "master frozen": ("master", signal.SIGSTOP),
    "emergency stop": ("button", 0),
    "clock stopped": ("robot", signal.SIGUSR1),
    "network cut": ("network", 0),
    "network cut for 2 s": ("network", 2),
}


class Motion:
    """When the robot was last seen to move, and where."""

    def __init__(self) -> None:
        self.moved, self.moving, self.angle = 0.0, False, 0.0

    def heard(self, state) -> None:
        """A joint state has come."""
        if "left_w1" in state.name:
            n = list(state.name).index("left_w1")
            self.moving, self.angle = abs(state.velocity[n]) > STILL, state.position[n]
            self.moved = time.monotonic() if self.moving else self.moved


def robot(arguments: list[str]) -> int:
    """`caretree serve-robot`, whose `/clock` says no more after SIGUSR1 while everything else goes on."""
    from caretree.trees.cli import main as command

    publisher = ros().rospy.Publisher
    publish = publisher.publish

    def stop_clock(*_: object) -> None:
        publisher.publish = lambda self, *values: None if self.name == "/clock" else publish(self, *values)

    signal.signal(signal.SIGUSR1, stop_clock)
    return command(["serve-robot", *arguments])


@contextlib.contextmanager
def network() -> Iterator[None]:
    """A network of its own for the tree."""
    _remove_network()
    inside = ("netns", "exec", NAMESPACE, "ip")
    try:
        _ip("netns", "add", NAMESPACE)
        _ip("link", "add", NAMESPACE[:8], "type", "veth", "peer", "name", "robot", "netns", NAMESPACE)
        _ip("addr", "add", f"{HERE}/24", "dev", NAMESPACE[:8])
        _ip("link", "set", NAMESPACE[:8], "up")
        _ip(*inside, "addr", "add", f"{THERE}/24", "dev", "robot")
        for each in ("lo", "robot"):
            _ip(*inside, "link", "set", each, "up")
        yield
    finally:
        _remove_network()


def _remove_network() -> None:
    for words in (("link", "del", NAMESPACE[:8]), ("netns", "del", NAMESPACE)):
        subprocess.run(["ip", *words], stderr=subprocess.DEVNULL, check=False)


def _ip(*words: str) -> None:
    subprocess.run(["ip", *words], check=True)


def main(name: str, folder: Path) -> None:
    """Try one fault."""
    master = subprocess.Popen(["rosmaster", "--core", "-p", str(PORT)], stdout=subprocess.DEVNULL, stderr=-2)
    children = {"master": master}
    try:
        row(name, folder, children)
    finally:
        for child in children.values():
            child.send_signal(signal.SIGCONT)
            child.kill()
            child.wait()


def row(name: str, folder: Path, children: dict[str, subprocess.Popen]) -> None:
    """Break it in the middle of the motion, and print how it went on; nothing is broken where it has ended before."""
    what, how = FAULTS[name]
    ends = time.monotonic() + 90.0
    while True:
        try:
            ask_master("getPid")
            break
        except WorldError:
            assert time.monotonic() < ends, "the master does not come up"
            time.sleep(0.2)
    log = (folder / "said.txt").open("w")
    serve = [sys.executable, __file__, "--robot", "--task", "wave"]
    children["robot"] = subprocess.Popen(serve, stdout=log, stderr=log)
    rospy, motion, there = node("observer"), Motion(), ros()
    topic = read_site().joint_states.topic
    rospy.Subscriber(topic, there.sensor_msgs.JointState, motion.heard, tcp_nodelay=True)
    button = rospy.Publisher("/robot/set_super_stop", there.std_msgs.Empty, queue_size=1)
    task = folder / "slow.py"
    task.write_text(TASK)
    out = folder / "record"
    run = [*CARETREE, "run", str(task), "--world", "ros1", "--world-arg", "patience=30", "--out", str(out)]
    its = os.environ | {"ROS_IP": THERE} if what == "network" else os.environ
    run = ["ip", "netns", "exec", NAMESPACE, *run] if what == "network" else run
    children["tree"] = subprocess.Popen(run, stdout=log, stderr=log, env=its)
    ends = time.monotonic() + 90.0
    while not motion.moving and children["tree"].poll() is None:
        time.sleep(0.005)
        assert time.monotonic() < ends, (folder / "said.txt").read_text()
    time.sleep(2.0)
    if time.monotonic() - motion.moved > EARLY:
        print(json.dumps({"early": True, "load": os.getloadavg()[0]}), flush=True)
        return
    broken = time.monotonic()
    if what == "button":
        button.publish()
    elif what == "network":
        _ip("link", "set", NAMESPACE[:8], "down")
    elif what:
        children[what].send_signal(how)
    before = motion.angle
    time.sleep(0.7)
    still = motion.angle
    if what == "network" and how:
        time.sleep(max(how - 0.7, 0.0))
        _ip("link", "set", NAMESPACE[:8], "up")
    if what == "tree":
        time.sleep(2.0)
    else:
        with contextlib.suppress(subprocess.TimeoutExpired):
            children["tree"].wait(30.0)
    ended = time.monotonic() - broken
    moved_on = max(motion.moved - broken, 0.0)
    if what == "robot" and how == signal.SIGSTOP:  # it wakes up: does the old motion go on?
        children["robot"].send_signal(signal.SIGCONT)
        woke = time.monotonic()
        time.sleep(3.0)
        moved_on = max(motion.moved - woke, 0.0)
        still = motion.angle
    told = "-"
    if what != "tree":
        told = f"{ended:.1f} s: still running"
        if (out / "run.json").exists():
            record = json.loads((out / "run.json").read_text())
            told = f"{ended:.1f} s: {record['outcome']}, {record['reason']}"
    turned = np.degrees(abs(still - before))
    print(json.dumps({"moved_on": moved_on, "turned": turned, "told": told, "load": os.getloadavg()[0]}), flush=True)


def table(names: list[str], times: int) -> None:
    """Try them all, and print a line for each."""
    print(
        "| what happens | moved on, each time [s] | turned by at most | the tree's end |\n|---|---|---|---|", flush=True
    )
    loads: list[float] = []
    for name in names:
        tries: list[dict] = []
        early = 0
        while len(tries) < times and early <= AGAIN:
            lives = network() if FAULTS[name][0] == "network" else contextlib.nullcontext()
            here = HERE if FAULTS[name][0] == "network" else "127.0.0.1"
            env = os.environ | {"ROS_MASTER_URI": f"http://{here}:{PORT}", "ROS_IP": here}
            with lives:
                tried = subprocess.run(
                    [sys.executable, __file__, "--try", name],
                    env=env,
                    stdout=subprocess.PIPE,
                    timeout=LASTS,
                    check=False,
                )
            told = [json.loads(line) for line in tried.stdout.splitlines()]
            tries += [each for each in told if "early" not in each]
            early += not told or "early" in told[0]
            loads += [each["load"] for each in told]
        moved = ", ".join(f"{each['moved_on']:.2f}" for each in tries)
        ended = collections.Counter(each["told"].partition(": ")[2] or "-" for each in tries)
        ends = max((float(each["told"].split(" s")[0]) for each in tries if each["told"] != "-"), default=0.0)
        said = "; ".join(f"{count} times: {what}" for what, count in ended.items())
        said += f"; {early} more did not come as far as the fault" if early else ""
        turned = max((each["turned"] for each in tries), default=0.0)
        print(f"| {name} | {moved} | {turned:.1f} deg | after {ends:.1f} s at most; {said} |", flush=True)
    print(f"processes at work on {os.cpu_count()} cores meanwhile: {min(loads):.0f} to {max(loads):.0f}")


if __name__ == "__main__":
    if DEBIAN not in sys.path and not Path(DEBIAN, "rospy").is_dir():
        sys.exit("ROS 1 is not here: make ros")
    if sys.argv[1:2] == ["--robot"]:
        sys.exit(robot(sys.argv[2:]))
    if sys.argv[1:2] == ["--try"]:
        with tempfile.TemporaryDirectory() as made:
            os.environ["ROS_HOME"] = made
            main(sys.argv[2], Path(made))
            os._exit(0)  # a node whose master has gone does not end by itself
    parser = argparse.ArgumentParser()
    parser.add_argument("faults", nargs="*", choices=[[], *FAULTS], default=[])
    parser.add_argument("--times", type=int, default=1)
    given = parser.parse_args()
    table(given.faults or list(FAULTS), given.times)
