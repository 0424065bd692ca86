"""A robot behind a real master keeps the contract, and a tree does there what it does in its own process."""

import json

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
