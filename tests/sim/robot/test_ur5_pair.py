"""Two UR5 arms: their hands are where Baxter's are, and left and right are mirror images."""

import numpy as np
import pytest
from caretree.sim.mechanics.capsules import RobotCapsules
from caretree.sim.mechanics.collision import CollisionChecker
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.robot.ur5_pair import UR5_PAIR
from caretree.sim.world import SIDES
from caretree.skills.motion.ik import solve_ik

HERE = np.zeros(3)


@pytest.mark.parametrize("posture", ["ready", "held_up"])
def test_hands_are_where_baxters_are(posture):
    for n, side in enumerate(SIDES):
        theirs = kinematics_of(BAXTER).pose_hand_in_base(side, getattr(BAXTER, posture)[n])
        ours = kinematics_of(UR5_PAIR).pose_hand_in_base(side, getattr(UR5_PAIR, posture)[n])
        np.testing.assert_allclose(ours, theirs, atol=0.01)


@pytest.mark.parametrize("ahead", [0.22, 0.29, 0.35])  # [m] three times in a bullet run (seed 104)
def test_a_hand_holds_a_sleeve_out_before_an_arm_that_is_up(ahead):
    pose = kinematics_of(UR5_PAIR).pose_hand_in_base("right", UR5_PAIR.ready[1])
    pose[:3, 3] = (ahead, -0.58, 1.11)
    q = solve_ik(kinematics_of(UR5_PAIR), "right", pose, HERE, UR5_PAIR.ready[1], seeds=6)
    assert CollisionChecker(kinematics_of(UR5_PAIR)).free(HERE, np.stack((UR5_PAIR.ready[0], q)))


def test_left_and_right_are_mirror_images():
    ends = RobotCapsules(kinematics_of(UR5_PAIR)).ends(HERE, UR5_PAIR.ready)
    names = [capsule.name for capsule in UR5_PAIR.capsules]
    for name in ("upper_arm", "forearm", "wrist_2"):
        left, right = (ends[names.index(f"{side}_{name}")] for side in SIDES)
        np.testing.assert_allclose(left * (1.0, -1.0, 1.0), right, atol=0.01)


def test_nothing_touches_where_the_arms_are_ready_and_crossed_arms_do():
    checker = CollisionChecker(kinematics_of(UR5_PAIR))
    assert checker.free(HERE, UR5_PAIR.ready)
    assert checker.free(HERE, UR5_PAIR.held_up)
    across = UR5_PAIR.ready.copy()
    found = set()
    for turn in np.linspace(0.0, 1.5, 16):  # [rad] of both arms towards each other
        across[:, 0] = UR5_PAIR.ready[:, 0] + (-turn, turn)
        found |= {part.split("_")[0] for pair in checker.collisions(HERE, across) for part in pair}
    assert {"left", "right"} <= found


def test_it_weighs_what_two_arms_and_a_base_weigh():
    model = kinematics_of(UR5_PAIR).model
    assert sum(inertia.mass for inertia in model.inertias) == pytest.approx(135.0 + 2 * 21.8 + 23.0, abs=3.0)
