"""Commands of every kind against a person in the way, with the real robot's links."""

import numpy as np
import pytest
from caretree.sim.mechanics.capsules import RobotCapsules
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.robot import model
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.scripted.world import ScriptedWorld, scripted_room
from caretree.sim.world import BaseVelocity, HandTwist, JointTrajectory
from caretree.skills.core.reasons import Reason, SkillFailure
from caretree.skills.geometry.clearance import CLEARANCE
from caretree.trees.guard.guard import GuardedWorld

HEAD_RADIUS = 0.1


def beside(offset, part="head"):
    """A guarded robot with ready arms, and a ball that is a part of the person, `offset` (3,) from its left hand."""
    room = scripted_room()
    room.waypoints["start"] = (2.5, -2.5, 0.0)
    world = ScriptedWorld(seed=1, room=room, kinematics=kinematics_of(BAXTER), arm_positions=model.READY)
    guard = GuardedWorld(world)
    place = world.observe().pose_hand_in_map[0, :3, 3] + offset
    guard.update_person(np.array(((0.0, 0.0, -5.0),)), part="person", radius=0.0)  # the rest is far away
    guard.update_person(place[None], part=part, radius=HEAD_RADIUS)
    return world, guard, place


def least_gap(world, place):
    """Between any link and the ball [m]."""
    seen = world.observe()
    links = RobotCapsules(kinematics_of(BAXTER))
    ends = links.ends(seen.pose_base_in_map, seen.arm_positions, seen.head_pan, seen.gripper_opening)
    shares = np.linspace(0.0, 1.0, 50)[:, None, None]
    points = ends[:, 0] + shares * (ends[:, 1] - ends[:, 0])
    return float((np.linalg.norm(points - place, axis=2) - links.radii).min()) - HEAD_RADIUS


def push(world, guard, velocity, times=60):
    """Send the same twist again and again; how far the hand has come (3,) [m]."""
    start = world.observe().pose_hand_in_map[0, :3, 3]
    for _ in range(times):
        guard.send(HandTwist(side="left", twist_in_map=np.append(velocity, np.zeros(3))))
        world.clock.wait_until(world.clock.now() + 1 / 15)
    return world.observe().pose_hand_in_map[0, :3, 3] - start


@pytest.mark.parametrize("offset", [(0.25, 0.0, 0.0), (0.22, 0.06, 0.0), (0.0, 0.0, -0.3), (0.05, -0.25, 0.05)])
def test_a_twist_never_brings_a_link_to_the_head(offset):
    world, guard, place = beside(np.array(offset))
    towards = np.array(offset) / np.linalg.norm(offset)
    push(world, guard, 0.1 * towards)
    assert least_gap(world, place) > 0.0
    assert least_gap(world, place) == pytest.approx(CLEARANCE.fingers_head, abs=0.02), "it comes as near as it may"


def test_a_hand_slides_along_the_head_instead_of_standing():
    world, guard, place = beside(np.array((0.2, 0.08, 0.0)))
    gone = push(world, guard, np.array((0.1, 0.0, 0.0)))
    assert least_gap(world, place) > 0.0
    assert gone[1] < -0.01, "aside"
    assert gone[0] > 0.1, "and on"


def test_a_hand_that_has_no_room_to_turn_slides_on_without_turning():
    world, guard, place = beside(np.array((-0.09, -0.07, 0.147)))
    for _ in range(30):
        twist = np.array((0.07, -0.02, -0.08, 0.29, -0.45, 0.37))
        sent = guard.send(HandTwist(side="left", twist_in_map=twist)).twist_in_map
        world.clock.wait_until(world.clock.now() + 1 / 15)
    assert least_gap(world, place) > 0.0
    assert sent[0] > 0.05, "and on"
    assert sent[3:] == pytest.approx(0.0)


def test_away_from_the_head_nothing_is_held_back():
    _, guard, _ = beside(np.array((0.15, 0.0, 0.0)))
    sent = guard.send(HandTwist(side="left", twist_in_map=np.array((-0.1, 0.0, 0.0, 0.0, 0.0, 0.0))))
    assert sent.twist_in_map[:3] == pytest.approx((-0.1, 0.0, 0.0), abs=1e-9)


def test_a_link_that_is_too_near_already_may_leave_but_come_no_nearer():
    world, guard, place = beside(np.array((0.09, 0.0, 0.0)))
    before = least_gap(world, place)
    assert before < 0.0, "inside: the person has moved"
    push(world, guard, np.array((0.1, 0.0, 0.0)), times=10)
    assert least_gap(world, place) >= before - 1e-3
    push(world, guard, np.array((-0.1, 0.0, 0.0)), times=30)
    assert least_gap(world, place) > before + 0.1


def trajectory_to(world, positions):
    joints = BAXTER.joints_of("left")
    start = world.observe().arm_positions[0]
    return JointTrajectory(joints=joints, times=np.array((0.0, 4.0)), positions=np.array((start, positions)))


def test_a_trajectory_through_the_head_is_refused_with_link_and_part():
    world, guard, _ = beside(np.array((0.0, 0.15, 0.0)))
    swung = model.READY[0] + np.array((0.6, 0, 0, 0, 0, 0, 0))
    with pytest.raises(SkillFailure, match=r"the left .* would come too near to the person's head") as refused:
        guard.send(trajectory_to(world, swung))
    assert refused.value.reason == Reason.MOTION_BLOCKED
    away = model.READY[0] - np.array((0.3, 0, 0, 0, 0, 0, 0))
    assert guard.send(trajectory_to(world, away)).positions[-1] == pytest.approx(away)


def test_the_base_carries_no_link_into_the_head():
    world, guard, place = beside(np.array((0.3, 0.0, 0.0)))
    for _ in range(60):
        guard.send(BaseVelocity(velocity=np.array((0.1, 0.0, 0.0))))
        world.clock.wait_until(world.clock.now() + 1 / 15)
    assert 0.0 < least_gap(world, place) < 0.06
    sent = guard.send(BaseVelocity(velocity=np.array((-0.1, 0.0, 0.0))))
    assert sent.velocity[0] == pytest.approx(-0.1)


def test_the_elbow_counts_as_the_hand_does():
    world, guard, _ = beside(np.zeros(3))
    seen = world.observe()
    links = RobotCapsules(kinematics_of(BAXTER))
    ends = links.ends(seen.pose_base_in_map, seen.arm_positions)
    elbow = ends[links.names.index("left_elbow")].mean(axis=0) + (0.0, 0.25, 0.0)
    guard.update_person(elbow[None], part="head", radius=HEAD_RADIUS)
    for _ in range(60):
        guard.send(HandTwist(side="left", twist_in_map=np.array((0.0, 0.1, 0.0, 0.0, 0.0, 0.0))))
        world.clock.wait_until(world.clock.now() + 1 / 15)
    assert least_gap(world, elbow) > 0.0
