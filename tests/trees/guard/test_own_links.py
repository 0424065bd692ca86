"""Commands that would bring the robot's links into each other; nobody else is there."""

import numpy as np
import pytest
from caretree.sim.mechanics.capsules import RobotCapsules
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.robot import model
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.scripted.world import ScriptedWorld, scripted_room
from caretree.sim.segments import capsule_gaps
from caretree.sim.world import SIDES, HandTwist, JointTrajectory
from caretree.skills.core.reasons import Reason, SkillFailure
from caretree.trees.guard.guard import GuardedWorld


def alone():
    """A guarded robot with ready arms, far from the bed."""
    room = scripted_room()
    room.waypoints["start"] = (2.5, -2.5, 0.0)
    world = ScriptedWorld(seed=1, room=room, kinematics=kinematics_of(BAXTER), arm_positions=model.READY)
    return world, GuardedWorld(world)


def gaps(world):
    """Between every link and every other one that it could touch, fingers left out; by names [m]."""
    seen, links = world.observe(), RobotCapsules(kinematics_of(BAXTER))
    ends = links.ends(seen.pose_base_in_map, seen.arm_positions, seen.head_pan, seen.gripper_opening)
    between, _ = capsule_gaps(ends, links.radii, ends, links.radii)
    pairs = {frozenset(pair) for pair in BAXTER.own_pairs}
    of = [capsule.link for capsule in links.capsules]
    return {
        (one, other): between[m, n]
        for m, one in enumerate(links.names)
        for n, other in enumerate(links.names)
        if frozenset((of[m], of[n])) in pairs
    }


def drive(world, guard, velocities, times=150):
    """Send each hand its velocity again and again; the least gap of all on the way [m]."""
    least = np.inf
    for _ in range(times):
        for side, velocity in velocities.items():
            guard.send(HandTwist(side=side, twist_in_map=np.append(velocity, np.zeros(3))))
        world.clock.wait_until(world.clock.now() + 1 / 15)
        least = min(least, *gaps(world).values())
    return least


def between_hands(world):
    """From the left hand to the right one (3,) [m]."""
    left, right = (world.observe().pose_hand_in_map[n, :3, 3] for n in range(2))
    return right - left


def test_hands_that_are_driven_into_each_other_stop_before_they_touch():
    world, guard = alone()
    towards = between_hands(world) / np.linalg.norm(between_hands(world))
    least = drive(world, guard, {"left": 0.1 * towards, "right": -0.1 * towards})
    assert 0.0 < least < 0.02, "they come as near as they may"


def test_one_hand_is_kept_off_the_other_that_rests():
    world, guard = alone()
    towards = between_hands(world) / np.linalg.norm(between_hands(world))
    assert 0.0 < drive(world, guard, {"left": 0.1 * towards}) < 0.02


@pytest.mark.parametrize("side", SIDES)
def test_a_hand_is_kept_off_the_trunk_of_its_robot(side):
    world, guard = alone()
    n = SIDES.index(side)
    back = world.observe().pose_base_in_map[:2] - world.observe().pose_hand_in_map[n, :2, 3]
    assert drive(world, guard, {side: np.append(0.1 * back / np.linalg.norm(back), 0.0)}) > 0.0


def moved_to(world, targets):
    """Angles (2, n) with which the hands are at the `targets`, side -> (3,) in the map; other hands rest [rad]."""
    kinematics, seen = kinematics_of(BAXTER), world.observe()
    arms = np.array(seen.arm_positions)
    for side, target in targets.items():
        n = SIDES.index(side)
        for _ in range(300):
            now = kinematics.pose_hand_in_map(side, arms[n], seen.pose_base_in_map)[:3, 3]
            jacobian = kinematics.jacobian_hand_in_map(side, arms[n], seen.pose_base_in_map)[:3]
            arms[n] += 0.1 * jacobian.T @ np.linalg.solve(jacobian @ jacobian.T + 1e-3 * np.eye(3), target - now)
    return arms


def both_to(world, arms):
    """The trajectory of both arms to angles (2, n)."""
    names = tuple(name for side in SIDES for name in BAXTER.joints_of(side))
    way = np.stack((np.ravel(world.observe().arm_positions), np.ravel(arms)))
    return JointTrajectory(joints=names, positions=way, times=np.array((0.0, 5.0)))


def test_arms_that_are_in_each_other_come_apart_but_no_nearer():
    world, guard = alone()
    middle = world.observe().pose_hand_in_map[:, :3, 3].mean(axis=0)
    aside = 0.3 * between_hands(world) / np.linalg.norm(between_hands(world))
    crossed = {"left": middle + 0.1 * aside, "right": middle - 0.1 * aside}
    world.send(both_to(world, moved_to(world, crossed)))  # a world that is not guarded allows it
    world.clock.wait_until(world.clock.now() + 8.0)
    inside = min(gaps(world).values())
    assert inside < -0.01
    assert drive(world, guard, {"left": 0.3 * aside, "right": -0.3 * aside}, times=15) >= inside - 2e-3
    drive(world, guard, {"left": -0.3 * aside, "right": 0.3 * aside}, times=60)
    assert min(gaps(world).values()) > inside + 0.01


def test_a_trajectory_into_the_other_arm_is_refused():
    world, guard = alone()
    there = world.observe().pose_hand_in_map[1, :3, 3]
    with pytest.raises(SkillFailure, match=r"the left .* would touch the right") as caught:
        guard.send(both_to(world, moved_to(world, {"left": there})))
    assert caught.value.reason == Reason.MOTION_BLOCKED
    guard.send(both_to(world, world.observe().arm_positions))
