"""What is wrong with a robot is told, each in one line; a whole robot is called whole."""

import os
import re
import subprocess
import sys

from caretree.sim.ros1.site import SITES

WRONG = {
    "/robot/state": "/robot/condition",
    "frame: left_force_sensor": "frame: left_palm",
    "joint: right_gripper": "joint: right_thumb",
    "rate: 0.1": "rate: 900",
    "/cmd_vel": "/base/velocity",
    "/amcl_pose": "/robot/joint_states_2",
}


def site_in(folder, changes):
    """The site of the package, on a machine that may be busy, with some changes."""
    text = re.sub(r"rate: \d+", "rate: 0.1", (SITES / "baxter.yaml").read_text()).replace("fresh: 0.3", "fresh: 30")
    for right, wrong in changes.items():
        assert right in text
        text = text.replace(right, wrong, 1)
    file = folder / "site.yaml"
    file.write_text(text)
    return str(file)


def test_a_whole_robot_is_called_whole(living_robot, tmp_path):
    done = living_robot.caretree("robot", "doctor", "--site", site_in(tmp_path, {}))
    assert done.returncode == 0, done.stdout
    assert "ok   map: 80 x 80 cells, 4 waypoints\nthe robot is whole\n" in done.stdout


def test_what_is_wrong_is_told(living_robot, tmp_path):
    done = living_robot.caretree("robot", "doctor", "--site", site_in(tmp_path, WRONG))
    assert done.returncode == 1
    for said in (
        "BAD  /robot/condition: nobody gives it; baxter_core_msgs/AssemblyState is asked for",
        "BAD  /robot/limb/left/wrench: is in frame 'left_force_sensor', but 'left_palm' is asked for",
        "BAD  /robot/end_effector/right_gripper/joint_states: lacks joint right_thumb",
        "but 900 is asked for",
        "BAD  /base/velocity: nobody takes it; geometry_msgs/Twist would be sent",
        "BAD  /robot/joint_states_2: nobody gives it",
    ):
        assert said in done.stdout


def test_no_master_is_told_at_once(ros_here):
    code = "from caretree.trees.cli import main; import sys; sys.exit(main(['robot', 'doctor']))"
    env = os.environ | {"ROS_MASTER_URI": "http://127.0.0.1:9"}
    done = subprocess.run([sys.executable, "-c", code], env=env, capture_output=True, text=True, timeout=60)
    assert done.returncode == 1
    assert "BAD  master: no ROS master answers at http://127.0.0.1:9: Connection refused" in done.stdout
