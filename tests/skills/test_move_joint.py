"""One joint turns, at its speed, and nothing else of the robot."""

import numpy as np
import pytest
from caretree.sim.world import JointTrajectory
from caretree.skills.core.ports import PortError
from caretree.skills.core.reasons import Reason
from caretree.skills.move_joint import MoveJoint

from .bench import LeafBench, beside_bed

AWAY = (2.5, -1.5, np.pi)  # from the bed [m, m, rad]
ELBOW = 3  # the fourth joint of an arm, called e1


def bench(angle, *, deaf_to=(), **options):
    """The left elbow is to turn."""
    return LeafBench(
        lambda context: MoveJoint("turn", context, side="left", joint="e1", angle=angle, **options),
        beside_bed(stand=AWAY, deaf_to=deaf_to),
    )


@pytest.mark.parametrize(("relative", "turned"), [(True, -0.4), (False, -0.57)])
def test_a_joint_turns_by_an_angle_or_to_one_and_says_where_it_was(relative, turned):
    run = bench(-0.4 if relative else 1.2, relative=relative, speed=0.2)  # [rad], [rad/s]; it begins at 1.77 rad
    assert run.ended() is None
    moved = np.array([seen.arm_positions for seen in run.seen]) - run.start.arm_positions
    assert moved[-1, 0, ELBOW] == pytest.approx(turned, abs=0.05)
    assert run.skill.before == pytest.approx(1.77, abs=1e-3)
    moved[:, 0, ELBOW] = 0.0
    assert np.abs(moved).max() == pytest.approx(0.0, abs=1e-6), "no other joint moves"
    assert run.seen[-1].time - run.start.time == pytest.approx(abs(turned) / 0.2, abs=0.3)  # [s]


def test_one_that_does_not_turn_is_told():
    assert bench(0.4, deaf_to=(JointTrajectory,)).ended() == Reason.COMMAND_LOST


def test_a_joint_that_the_robot_does_not_have_is_refused_before_anything_moves():
    with pytest.raises(PortError, match="joint is 'knee', but the robot baxter has s0, s1, e0, e1, w0, w1, w2"):
        LeafBench(lambda context: MoveJoint("turn", context, side="left", joint="knee", angle=0.1), beside_bed())


def test_degrees_are_refused_before_anything_moves():
    with pytest.raises(PortError, match=r"angle is 45 rad, .* is it in degrees"):
        bench(45.0)
