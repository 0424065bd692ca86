"""A robot behind a real master keeps the contract, and a tree does there what it does in its own process."""

import json
import sys
import time

import numpy as np
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.robot.baxter import BAXTER

BREAKS = """
import sys
from caretree.sim.ros1.ros import node, ros
from caretree.sim.ros1.world import Ros1World
from caretree.sim.testing import Breaks, check_world


def press(world):
    rospy, there = node("button"), ros()
    button = rospy.Publisher("/robot/set_super_stop", there.std_msgs.Empty, queue_size=1, latch=True)
    button.publish()
    while not world.observe().emergency_stop:
        world.clock.wait_until(world.clock.now() + 0.05)


print(check_world(Ros1World, breaks=Breaks(emergency_stop=press), wall=lambda: 0.0))
rospy, there = node("button"), ros()
reset = rospy.Publisher("/robot/set_super_reset", there.std_msgs.Empty, queue_size=1, latch=True)
enable = rospy.Publisher("/robot/set_super_enable", there.std_msgs.Bool, queue_size=1, latch=True)
world = Ros1World()
while world.observe().emergency_stop:
    reset.publish()
    enable.publish(True)  # before the button is released it does nothing
    world.clock.wait_until(world.clock.now() + 0.05)
print("enabled again")
world.close()
"""

RAISED = """
import json
import sys
import numpy as np
from caretree.sim.robot import model
from caretree.sim.ros1.world import Ros1World
from caretree.sim.world import HandTwist, JointTrajectory
from caretree.skills.scripted.rehearsal import rehearsal

world = Ros1World() if sys.argv[1] == "ros1" else rehearsal(0)[0]
here = world.observe().arm_positions[0]
path = np.stack((here, world.robot.ready[0]))
world.send(JointTrajectory(joints=model.arm_joints("left"), times=np.array((0.0, 8.0)), positions=path))
world.clock.wait_until(world.clock.now() + 9.0)
upward = np.array((0.0, 0.0, 0.15, 0.0, 0.0, 0.0))
for _ in range(100):
    world.send(HandTwist(side="left", twist_in_map=upward, duration=0.1))
    world.clock.wait_until(world.clock.now() + 0.1)
print(json.dumps(world.observe().arm_positions[0].tolist()))
world.close()
"""


def leaves(record):
    """Which nodes ended in which order, and how."""
    events = [json.loads(line) for line in (record / "trace.jsonl").read_text().splitlines()]
    return [(each["node"], each["status"]) for each in events if each.get("status") in ("SUCCESS", "FAILURE")]


def test_it_keeps_every_law(baxter):
    done = baxter.python(BREAKS)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines() == ["['senses', 'clock']", "enabled again"]


def test_a_tree_does_there_what_it_does_in_its_own_process(waving_robot, tmp_path):
    for world in ("scripted", "ros1"):
        done = waving_robot.caretree("run", "wave", "--seed", "100", "--world", world, "--out", str(tmp_path / world))
        assert done.returncode == 0, done.stdout + done.stderr
    assert leaves(tmp_path / "ros1") == leaves(tmp_path / "scripted")


def test_a_robot_that_is_not_whole_is_named(waving_robot, tmp_path):
    from caretree.sim.ros1.site import SITES

    site = tmp_path / "site.yaml"
    site.write_text((SITES / "baxter.yaml").read_text().replace("/robot/state", "/robot/condition"))
    given = ("--world-arg", f"site={site}", "--world-arg", "patience=1")
    done = waving_robot.caretree("run", "wave", "--world", "ros1", *given, "--out", str(tmp_path / "out"))
    assert done.returncode == 2
    assert done.stderr == "caretree: the robot is not whole: nothing on /robot/condition; `caretree robot doctor`\n"


def test_a_hand_that_is_driven_against_a_limit_ends_where_it_does_in_its_own_process(baxter):
    ended = {}
    for world in ("scripted", "ros1"):
        done = baxter.python(RAISED, world)
        assert done.returncode == 0, done.stderr
        ended[world] = np.array(json.loads(done.stdout))
        assert abs(kinematics_of(BAXTER).limits["left"].margin(ended[world])) < 1e-3
    np.testing.assert_allclose(ended["ros1"], ended["scripted"], atol=0.02)


SILENT_MASTER = """
import os
import signal
import sys
import sys
import time
from caretree.sim.ros1.world import Ros1World

world = Ros1World()
os.kill(int(sys.argv[1]), signal.SIGSTOP)
began = time.monotonic()
world.close()
print(time.monotonic() - began)
"""


def test_a_process_ends_although_its_master_does_not_answer(robot_of_its_own):
    began = time.monotonic()
    done = robot_of_its_own.python(SILENT_MASTER, str(robot_of_its_own.master.pid))
    assert done.returncode == 0, done.stderr
    assert float(done.stdout) < 4.0, "closing asks once [s]"
    assert time.monotonic() - began < 60.0, "and so does the end of the process; it took for ever"


LATE_SENSES = """
import sys
import time
from caretree.sim.ros1.senses import Senses
from caretree.sim.ros1.world import Ros1World

heard, count = Senses._heard_wrench, 0


def late(self, message, more):
    global count
    count += 1
    if count % 5 == 0:
        time.sleep(0.3)
    heard(self, message, more)


Senses._heard_wrench = late
world = Ros1World()
oldest = 0.0
for _ in range(30):
    world.clock.wait_until(world.clock.now() + 1 / 15)
    oldest = max(oldest, world.clock.now() - world.observe().time)
print(oldest)
world.close()
"""


def test_at_the_pace_of_the_tree_time_has_passed_when_everything_is_measured(waving_robot):
    """Wrenches come late on a busy machine: time went on without them, to where they counted as stale."""
    done = waving_robot.python(LATE_SENSES)
    assert done.returncode == 0, done.stderr
    assert float(done.stdout) < 0.1, "the state has no stamp, and may count as one tick old [s]"


WAITS = """
from caretree.sim.ros1.ros import ask_master
from caretree.sim.ros1.world import Ros1World

ask_master("deleteParam", "/use_sim_time")
print("waits", flush=True)
world = Ros1World(patience=60.0)
print(world.clock.now() - world.observe().time)
world.close()
"""


ASKS_FOR_MAP = """
import time
from caretree.sim.ros1.ros import ask_master
from caretree.sim.ros1.site import DEFAULT, read_site

grid, asking = read_site(DEFAULT).room.grid, []
while not any(node.startswith("/caretree") for node in asking):
    time.sleep(0.05)
    asking = dict(ask_master("getSystemState")[1]).get(grid, [])
"""


def test_a_tree_that_is_there_before_its_simulated_robot_takes_the_time_of_that(robot_of_its_own):
    robot_of_its_own.robot.kill()
    robot_of_its_own.robot.communicate()
    tree = robot_of_its_own._begin(sys.executable, "-c", WAITS)
    assert tree.stdout is not None
    assert tree.stdout.readline() == "waits\n"
    assert robot_of_its_own.python(ASKS_FOR_MAP).returncode == 0
    robot_of_its_own.serve("--task", "wave")
    age = tree.communicate(timeout=90.0)[0]
    assert float(age) < 10.0, "not the years between a simulation's clock and the wall's [s]"
