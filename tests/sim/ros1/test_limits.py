"""What is too much is clipped, and what comes back is what is done."""

import numpy as np
import pytest
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.ros1.limits import Clipping
from caretree.sim.ros1.site import read_site
from caretree.sim.world import BaseVelocity, GripperOpening, JointTrajectory


@pytest.fixture(scope="module")
def clipping():
    return Clipping(kinematics_of(BAXTER), read_site())


def path(goal, seconds, joint="left_w2"):
    return JointTrajectory(joints=(joint,), times=np.array((0.0, seconds)), positions=np.array(((0.0,), (goal,))))


def test_a_quick_trajectory_takes_longer_and_keeps_its_path(clipping):
    slow, _ = clipping.trajectory(path(0.5, 2.0))
    assert slow.times[-1] == 2.0
    quick, slopes = clipping.trajectory(path(0.5, 0.02))
    speed = kinematics_of(BAXTER).limits["left"].velocity[-1]
    assert np.isclose(quick.times[-1], 1.5 * 0.5 / speed)  # a path that rests at both ends is 1.5 times as fast midway
    assert quick.positions[-1, 0] == 0.5
    assert not slopes.any()


def test_a_joint_stays_within_its_limits(clipping):
    far, _ = clipping.trajectory(path(9.0, 20.0))
    assert far.positions[-1, 0] == kinematics_of(BAXTER).limits["left"].upper[-1]
    turned, _ = clipping.trajectory(path(9.0, 20.0, "head_pan"))
    assert turned.positions[-1, 0] == kinematics_of(BAXTER).head_range[1]


def test_fingers_and_base_are_clipped(clipping):
    wide = clipping.gripper(GripperOpening(side="left", opening=0.5, force_limit=1.0))
    assert (wide.opening, wide.force_limit) == (0.085, 5.0)
    drive = clipping.base(BaseVelocity(velocity=np.array((3.0, 4.0, -9.0))))
    assert np.allclose(drive.velocity, (0.3, 0.4, -0.6))
