import numpy as np
import pytest
from caretree.sim.mechanics.collision import CollisionChecker
from caretree.sim.mechanics.kinematics import Kinematics
from caretree.sim.robot import model
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.world import SIDES

BED = np.array((((-0.45, -1.0, 0.35), (0.45, 1.0, 0.60)),))
BASE = np.array((1.0, 0.0, np.pi))


@pytest.fixture(scope="module")
def kinematics():
    return Kinematics(BAXTER)


def test_ready_and_stretched_postures_are_free(kinematics):
    checker = CollisionChecker(kinematics, BED)
    assert checker.free(BASE, model.READY)
    assert checker.free(BASE, np.zeros((2, 7)))


def test_hands_clapped_together_collide(kinematics):
    from caretree.skills.motion.ik import hand_pose, solve_ik

    arms = np.stack(
        [
            solve_ik(
                kinematics, side, hand_pose((0.6, 0.0, 1.2), (1, 0, 0)), np.zeros(3), model.READY[n], free="approach"
            )
            for n, side in enumerate(SIDES)
        ]
    )
    pairs = CollisionChecker(kinematics).collisions(np.zeros(3), arms)
    assert ("left_gripper", "right_gripper") in pairs


def test_a_hand_in_the_bed_is_named_and_free_without_the_bed(kinematics):
    from caretree.skills.motion.ik import hand_pose, solve_ik

    arms = model.READY.copy()
    arms[0] = solve_ik(kinematics, "left", hand_pose((0.3, -0.3, 0.45), (0, 0, -1)), BASE, arms[0], free="approach")
    assert CollisionChecker(kinematics).free(BASE, arms)
    assert ("left_gripper", "box 0") in CollisionChecker(kinematics, BED).collisions(BASE, arms)


def test_an_arm_folded_into_the_chest_collides(kinematics):
    from caretree.skills.motion.ik import hand_pose, solve_ik

    arms = model.READY.copy()
    arms[1] = solve_ik(kinematics, "right", hand_pose((0.1, -0.05, 1.05), (-1, 0, 0)), np.zeros(3), arms[1], free="any")
    checker = CollisionChecker(kinematics)
    assert not checker.free(np.zeros(3), arms)
    assert any("torso" in pair for pair in checker.collisions(np.zeros(3), arms))


def test_what_a_motion_leaves_may_stay_as_near_and_come_no_nearer(kinematics):
    hand = kinematics.pose_hand_in_map("left", model.READY[0], BASE)[:3, 3]

    def before(gap):
        """A board below the left hand, that much farther off than when the motion began."""
        face = hand + (0.0, 0.0, 0.04 - gap)
        return CollisionChecker(kinematics, np.array(((face - (0.2, 0.2, 0.1), face + (0.2, 0.2, 0.0)),)))

    begins = before(0.0).contacts(BASE, model.READY)
    assert begins
    assert not before(0.0).free(BASE, model.READY)
    assert before(0.0).free(BASE, model.READY, leaving=begins)
    assert before(0.002).free(BASE, model.READY, leaving=begins)
    assert not before(-0.002).free(BASE, model.READY, leaving=begins)


@pytest.mark.parametrize("margin", [0.0, 0.1])
def test_what_is_far_apart_is_what_coal_finds_free(kinematics, margin):
    import pinocchio as pin

    checker, generator, told = CollisionChecker(kinematics, BED, margin=margin), np.random.default_rng(0), 0
    for _ in range(300):
        limits = [kinematics.limits[side] for side in SIDES]
        arms = np.array([generator.uniform(limit.lower, limit.upper) for limit in limits])
        base = generator.uniform((-2.0, -2.0, -np.pi), (2.0, 2.0, np.pi))
        q = kinematics.configuration(base, arms)
        touches = pin.computeCollisions(kinematics.model, kinematics.data, checker._geometry, checker._data, q, False)
        assert touches == bool(checker.collisions(base, arms))
        told += checker._far.all(checker._places, margin)
    assert told > 50


def test_a_motion_is_judged_as_its_postures_are(kinematics):
    checker = CollisionChecker(kinematics, BED)
    clapped = model.READY.copy()
    clapped[:, 0] = (-1.6, 1.6)
    way = np.stack([(1 - share) * model.READY + share * clapped for share in np.linspace(0.0, 1.0, 20)])
    base = np.zeros(3)
    assert list(checker.free_along(base, way)) == [checker.free(base, arms) for arms in way]
    hits = list(checker.collisions_along(base, way))
    assert hits == [checker.collisions(base, arms) for arms in way]
    assert any(hits)
    assert not all(hits)
