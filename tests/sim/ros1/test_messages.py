"""Messages that are made here are those of real robots: their sums are the ones that ROS 1 has always had."""

SUMS = {  # as `rosmsg md5` prints them where the packages are installed
    "control_msgs/FollowJointTrajectoryGoal": "69636787b6ecbde4d61d711979bc7ecb",
    "control_msgs/FollowJointTrajectoryActionGoal": "cff5c1d533bf2f82dd0138d57f4304bb",
    "control_msgs/GripperCommand": "680acaff79486f017132a7f198d40f08",
    "control_msgs/GripperCommandActionGoal": "aa581f648a35ed681db2ec0bf7a82bea",
    "control_msgs/SingleJointPositionActionGoal": "4b0d3d091471663e17749c1d0db90f61",
    "baxter_core_msgs/JointCommand": "19bfec8434dd568ab3c633d187c36f2e",
}


def test_the_sums_are_those_of_ros(waving_robot):
    code = f"""
from caretree.sim.ros1.messages import message
for name, known in {SUMS!r}.items():
    assert message(name)._md5sum == known, (name, message(name)._md5sum)
"""
    done = waving_robot.python(code)
    assert done.returncode == 0, done.stderr
