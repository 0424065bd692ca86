"""Goals of a simulated robot are taken and end in threads of their own, which do not wait for each other for ever."""

TOGETHER = """
import os
import threading
import time
from caretree.sim.ros1.action import ActionClient, Stamps
from caretree.sim.ros1.messages import message
from caretree.sim.ros1.robot_actions import RobotActions
from caretree.sim.ros1.ros import node
from caretree.sim.ros1.site import DEFAULT, read_site
from caretree.sim.scripted.world import ScriptedWorld

rospy, site, lock, inside, done = node("both"), read_site(DEFAULT), threading.RLock(), threading.Event(), []
name = site.grippers["left"].action
actions = RobotActions(site, ScriptedWorld(), lock, lambda: "")
client = ActionClient(rospy, name, "control_msgs/GripperCommand", Stamps(time.time))
while not client.connected():
    time.sleep(0.01)


def goal():
    return client.goal(command=message("control_msgs/GripperCommand")(position=0.01, max_effort=5.0))


def time_passes():
    with lock:
        inside.set()
        time.sleep(1.0)  # the second goal comes meanwhile
        actions.finish(1e9)
    done.append("the first goal ends")


client.send(first := goal())
client.wait_taken(first)
threading.Thread(target=time_passes, daemon=True).start()
inside.wait()
client.send(goal())
ends = time.monotonic() + 10.0
while not done and time.monotonic() < ends:
    time.sleep(0.01)
print(*done, flush=True)
os._exit(0)  # threads that wait for each other would keep it from ending
"""


def test_a_goal_that_comes_as_another_ends_keeps_time_from_standing_still_for_no_longer_than_that(robot_of_its_own):
    """Each waited for the other, so the robot's time stood still for ever, now and then on a busy machine."""
    robot_of_its_own.robot.kill()
    robot_of_its_own.robot.communicate()
    robot_of_its_own.robot = None  # the actions are to be had by another
    done = robot_of_its_own.python(TOGETHER)
    assert done.stdout == "the first goal ends\n", done.stderr
