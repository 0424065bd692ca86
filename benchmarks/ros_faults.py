"""How long a robot behind a ROS 1 master moves on after each fault, on the wall clock.

A scripted robot (`caretree serve-robot`), a tree that turns one joint slowly, a master and this observer are four
processes.  The observer breaks one of them in the middle of the motion and listens to the joint states.

    make ros && python benchmarks/ros_faults.py
"""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from caretree.sim.ros1.ros import DEBIAN, ask_master, node, ros
from caretree.sim.ros1.site import read_site
from caretree.sim.world import WorldError

PORT = 11600
STILL = 1e-3  # [rad/s]
CARETREE = [sys.executable, "-P", "-m", "caretree.trees.cli"]
TASK = """
from caretree.skills.move_joint import MoveJoint
from caretree.skills.retreat import Retreat
from caretree.trees.nodes.decorators import FailSafe


def build(context):
    slow = MoveJoint("slowly", context, side="left", joint="w1", angle=1.2, speed=0.1)
    return FailSafe("safely", slow, Retreat("let go", context, hand_distance=0.0, ready="never"))
"""
# name, process that is broken and how; None for the red button
FAULTS = {
    "nothing (to its end)": ("", 0),
    "tree killed": ("tree", signal.SIGKILL),
    "tree frozen": ("tree", signal.SIGSTOP),
    "robot killed": ("robot", signal.SIGKILL),
    "robot frozen": ("robot", signal.SIGSTOP),
    "master killed": ("master", signal.SIGKILL),
    "master frozen": ("master", signal.SIGSTOP),
    "emergency stop": (None, 0),
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
    """Break it in the middle of the motion, and print how it went on."""
    ends = time.monotonic() + 90.0
    while True:
        try:
            ask_master("getPid")
            break
        except WorldError:
            assert time.monotonic() < ends, "the master does not come up"
            time.sleep(0.2)
    log = (folder / "said.txt").open("w")
    serve = [*CARETREE, "serve-robot", "--task", "wave"]
    children["robot"] = subprocess.Popen(serve, stdout=log, stderr=log)
    rospy, motion, there = node("observer", f"http://127.0.0.1:{PORT}"), Motion(), ros()
    topic = read_site().joint_states.topic
    rospy.Subscriber(topic, there.sensor_msgs.JointState, motion.heard, tcp_nodelay=True)
    button = rospy.Publisher("/robot/set_super_stop", there.std_msgs.Empty, queue_size=1)
    task = folder / "slow.py"
    task.write_text(TASK)
    out = folder / "record"
    run = [*CARETREE, "run", str(task), "--world", "ros1", "--world-arg", "patience=30", "--out", str(out)]
    children["tree"] = subprocess.Popen(run, stdout=log, stderr=log)
    ends = time.monotonic() + 90.0
    while not motion.moving:
        time.sleep(0.005)
        assert time.monotonic() < ends, (folder / "said.txt").read_text()
    time.sleep(2.0)
    what, how = FAULTS[name]
    broken = time.monotonic()
    if what is None:
        button.publish()
    elif what:
        children[what].send_signal(how)
    before = motion.angle
    time.sleep(0.7)
    still = motion.angle
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
    print(f"| {name} | {moved_on:.2f} s | {np.degrees(abs(still - before)):.1f} deg | {told} |", flush=True)


if __name__ == "__main__":
    if DEBIAN not in sys.path and not Path(DEBIAN, "rospy").is_dir():
        sys.exit("ROS 1 is not here: make ros")
    os.environ |= {"ROS_MASTER_URI": f"http://127.0.0.1:{PORT}", "ROS_IP": "127.0.0.1"}
    if len(sys.argv) > 1:
        with tempfile.TemporaryDirectory() as made:
            os.environ["ROS_HOME"] = made
            main(sys.argv[1], Path(made))
            os._exit(0)  # a node whose master has gone does not end by itself
    for each in FAULTS:
        subprocess.run([sys.executable, __file__, each], check=False, timeout=200)
