"""The capsules lie where the links are, and fill them."""

from __future__ import annotations

import numpy as np
import pytest
from caretree.sim.mechanics.capsules import RobotCapsules
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.robot import model
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.world import SIDES

BASE = np.array((0.9, -0.4, np.pi))


@pytest.fixture(scope="module")
def robot():
    return RobotCapsules(kinematics_of(BAXTER))


def test_names_tell_side_and_part_and_are_unique():
    names = [capsule.name for capsule in BAXTER.capsules]
    assert len(names) == len(set(names))
    assert {"left_palm_1", "right_finger_2", "left_forearm", "right_wrist_2", "head"} <= set(names)
    assert all(name.startswith(("left_", "right_", "torso_", "head")) for name in names)


def test_fingers_end_at_the_fingertips_and_stand_as_far_apart_as_the_gripper_is_open(robot):
    opening = np.array((0.03, 0.07))
    ends = robot.ends(BASE, model.READY, gripper_opening=opening)
    for n, side in enumerate(SIDES):
        one, two = (robot.names.index(f"{side}_finger_{k}") for k in (1, 2))
        tips = ends[[one, two], 1]
        radius = robot.radii[one]
        assert np.linalg.norm(tips[0] - tips[1]) == pytest.approx(opening[n] + 2 * radius, abs=1e-6)
        hand = kinematics_of(BAXTER).pose_hand_in_map(side, model.READY[n], BASE)
        assert (tips.mean(axis=0) + radius * hand[:3, 2]) == pytest.approx(hand[:3, 3], abs=1e-6)


def test_the_palm_fills_its_box(robot):
    across, closing, height = model.PALM_SIZE
    for capsule in BAXTER.capsules:
        if "palm" in capsule.name:
            low, high = capsule.ends.min(axis=0) - capsule.radius, capsule.ends.max(axis=0) + capsule.radius
            assert low == pytest.approx((-across / 2, -closing / 2, low[2]))
            assert high == pytest.approx((across / 2, closing / 2, high[2]))
            assert low[2] >= -1e-9
            assert high[2] <= height + 1e-9


def test_capsules_go_along_with_the_base(robot):
    here = robot.ends(np.zeros(3), model.READY)
    there = robot.ends(BASE, model.READY)
    c, s = np.cos(BASE[2]), np.sin(BASE[2])
    turned = here @ np.array(((c, s, 0.0), (-s, c, 0.0), (0.0, 0.0, 1.0))) + (*BASE[:2], 0.0)
    assert there == pytest.approx(turned, abs=1e-9)
    assert robot.rows(there).shape == (len(robot.names), 7)


def test_asking_twice_for_one_posture_gives_two_arrays():
    capsules = RobotCapsules(kinematics_of(BAXTER))
    base, arms = np.array((0.3, -0.2, 0.5)), np.full((2, 7), 0.1)
    first = capsules.ends(base, arms)
    kept = first.copy()
    first += 1.0
    assert (capsules.ends(base, arms) == kept).all()
    assert (capsules.ends(base, arms + 0.1) != kept).any()


def test_along_a_way_they_lie_as_in_each_posture_by_itself(robot):
    turns = np.linspace(-0.5, 0.5, 5)[:, None, None]
    way = robot.ends_along(BASE, model.READY + turns, 0.3, np.array((0.03, 0.07)))
    for ends, turn in zip(way, turns, strict=True):
        np.testing.assert_array_equal(ends, robot.ends(BASE, model.READY + turn, 0.3, np.array((0.03, 0.07))))
