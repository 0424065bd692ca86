"""Planning sees the person: postures that come too near are not free, and motions go round."""

from types import SimpleNamespace

import numpy as np
import pytest
from caretree.sim.mechanics.capsules import RobotCapsules
from caretree.sim.mechanics.collision import CollisionChecker
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.robot import model
from caretree.sim.robot.baxter import BAXTER
from caretree.skills.geometry.clearance import CLEARANCE
from caretree.skills.geometry.person_zone import PersonZone
from caretree.skills.motion.clear_of_person import ClearOfPerson
from caretree.skills.motion.errors import MotionBlocked
from caretree.skills.motion.reach import plan_hand_line, plan_reach

BASE = np.zeros(3)
AWAY = model.READY + np.array(((-0.8, 0, 0, 0, 0, 0, 0), (0.8, 0, 0, 0, 0, 0, 0)))  # arms spread


@pytest.fixture
def zone():
    return PersonZone(np.zeros((2, 3)))


def checker(zone, held=None, opening=0.085, arms=AWAY, head_pan=0.0):
    robot = kinematics_of(BAXTER)
    begins = SimpleNamespace(
        pose_base_in_map=BASE, arm_positions=arms, head_pan=head_pan, gripper_opening=np.full(2, opening)
    )
    return ClearOfPerson(CollisionChecker(robot), RobotCapsules(robot), zone, held or {}, begins)


def hand():
    return kinematics_of(BAXTER).pose_hand_in_map("left", model.READY[0], BASE)


def test_a_posture_in_the_head_is_not_free_and_says_what_touches(zone):
    assert checker(zone).free(BASE, model.READY)
    zone.update(hand()[:3, 3][None], part="head", radius=0.09)
    made = checker(zone)
    assert not made.free(BASE, model.READY)
    assert ("left_finger_1", "the person's head") in made.collisions(BASE, model.READY)


def test_open_fingers_stand_on_either_side_of_an_arm_and_closed_ones_in_it(zone):
    pose = hand()
    along = pose[:3, 0]
    arm = pose[:3, 3] + np.array((-0.3, 0.0, 0.3))[:, None] * along + 0.005 * -pose[:3, 2]
    zone.update(arm, part="right arm", radius=0.04)
    assert checker(zone).free(BASE, model.READY)
    assert not checker(zone, opening=0.0).free(BASE, model.READY)
    assert checker(zone, {"left": "right arm"}, opening=0.0).free(BASE, model.READY), "it holds that arm"


def test_a_line_through_the_head_is_blocked_and_another_way_goes_round(zone):
    start = hand()
    goal = start.copy()
    goal[:3, 3] += (0.0, 0.30, 0.05)
    zone.update((start[:3, 3] + (0.02, 0.15, -0.02))[None], part="head", radius=0.05)
    with pytest.raises(MotionBlocked, match="the person's head"):
        plan_hand_line(
            kinematics_of(BAXTER), {"left": goal}, model.READY, BASE, checker=checker(zone, arms=model.READY)
        )
    found = plan_reach(
        kinematics_of(BAXTER), {"left": goal}, model.READY, BASE, checker=checker(zone, arms=model.READY)
    )
    arms, made = model.READY.copy(), checker(zone, arms=model.READY)
    for q in found.positions[:: max(1, len(found.positions) // 40)]:
        arms[0] = q
        assert not [pair for pair in made.collisions(BASE, arms) if "head" in pair[1]]


def test_where_a_motion_begins_too_near_it_may_leave_but_come_no_nearer(zone):
    place = hand()[:3, 3] + (0.0, 0.0, -0.08)
    zone.update(place[None], part="head", radius=0.09)
    made = checker(zone, arms=model.READY)
    assert not made.collisions(BASE, model.READY), "it stands there already"
    zone.update((place + (0.0, 0.0, 0.03))[None], part="head", radius=0.09)
    assert made.collisions(BASE, model.READY), "nearer than where it began"


def test_a_motion_may_begin_within_the_room_that_ways_keep_for_smoothing(zone):
    place = hand()[:3, 3] + (0.0, 0.0, -0.08)
    zone.update(place[None], part="head", radius=0.09)
    made = checker(zone, arms=model.READY)
    touching = -made._room(BASE, model.READY, 0.0).min()
    zone.update(place[None], part="head", radius=0.09 - touching - 0.4 * CLEARANCE.planned)
    made = checker(zone, arms=model.READY)
    assert 0.0 < made._room(BASE, model.READY, 0.0).min() < CLEARANCE.planned
    assert made.free(BASE, model.READY), "a tracked arm had come 1 mm nearer: six times there was no way (191)"
    zone.update((place + (0.0, 0.0, 0.001))[None], part="head", radius=0.09 - touching - 0.4 * CLEARANCE.planned)
    assert not made.free(BASE, model.READY), "nearer than where it began"


def test_the_robots_own_head_stays_turned_as_it_is_while_arms_move(zone):
    raised = np.array((AWAY[0], (-0.48, -1.68, 1.36, 1.83, -1.49, 2.41, 0.44)))  # the elbow beside the head
    assert checker(zone).free(BASE, raised)
    turned = checker(zone, head_pan=-1.2)  # [rad]
    assert not turned.free(BASE, raised)
    assert turned.collisions(BASE, raised) == [("right_lower_elbow", "head")]
    assert turned.free(BASE, raised, 0.0), "unless another angle is asked about"
