"""What the guard slows down near the person, against every way of commanding."""

import numpy as np
import pytest
from caretree.sim.scripted.linear_arm import HOME_IN_BASE
from caretree.sim.scripted.world import scripted_room
from caretree.sim.world import BaseVelocity, GripperOpening, HandTwist, JointTrajectory
from caretree.trees.guard.guard import GuardedWorld
from caretree.trees.guard.limits import DEFAULT

from .guarded import World, make, speed, twist

NEAR = DEFAULT.hand_speed * DEFAULT.hand_speed_commanded


def test_a_twist_is_slowed_near_the_person_only():
    _, guard = make(near=True)
    assert speed(guard.send(twist(y=0.5))) == pytest.approx(NEAR)
    assert speed(guard.send(twist(y=0.1))) == pytest.approx(0.1)
    _, guard = make(near=False)
    assert speed(guard.send(twist(y=0.5))) == pytest.approx(0.5)


def test_a_twist_that_will_come_near_is_slowed_before_it_does():
    world, guard = make(near=False)
    hand = world.observe().pose_hand_in_map[0, :3, 3]
    guard.update_person(hand + np.array((0.6, 0, 0)), radius=0.05)
    assert speed(guard.send(twist(x=0.5, duration=1.0))) == pytest.approx(NEAR)
    assert speed(guard.send(twist(x=-0.5, duration=1.0))) == pytest.approx(0.5)


def test_before_anything_is_seen_the_bed_is_the_person():
    room = scripted_room()
    world = World(room=room)
    world._base = np.array((-1.2, 0.0, 0.0))  # the hands reach over the bed
    guard = GuardedWorld(world)
    assert speed(guard.send(twist(z=0.5))) == pytest.approx(NEAR)
    guard.update_person(np.array((0.0, 3.0, 0.7)))
    assert speed(guard.send(twist(z=0.5))) == pytest.approx(0.5), "perception knows better than the map"


def test_a_trajectory_is_stretched_until_its_hand_is_slow_near_the_person():
    _, guard = make(near=True)
    quick = JointTrajectory(joints=("left_s1",), times=np.array((0.0, 1.0)), positions=np.array(((0.0,), (0.8,))))
    sent = guard.send(quick)  # 0.4 m in 1 s
    assert sent.times[-1] == pytest.approx(0.4 / NEAR, rel=1e-6)
    np.testing.assert_array_equal(sent.positions, quick.positions)
    _, guard = make(near=False)
    assert guard.send(quick).times[-1] == 1.0


def test_only_the_near_part_of_a_trajectory_counts():
    world, guard = make(near=False)
    hand = world.observe().pose_hand_in_map[0, :3, 3]
    guard.update_person(hand + np.array((0, 1.0, 0)), radius=0.05)
    # along -x in the map at high speed, then slowly towards the person
    joints = ("left_s0", "left_s1")
    yaw = world.observe().pose_base_in_map[2]
    towards = np.array((np.cos(-yaw) * 0 - np.sin(-yaw) * 1, np.sin(-yaw) * 0 + np.cos(-yaw) * 1))  # map y in the base
    path = np.array(((0, 0), -towards * 1.0, -towards * 1.0 + 0.05 * towards))
    sent = guard.send(JointTrajectory(joints=joints, times=np.array((0.0, 0.6, 1.2)), positions=path))
    assert sent.times[-1] == pytest.approx(1.2), "fast only where nobody is"


def test_a_trajectory_that_passes_the_person_between_its_ends_is_seen():
    world, guard = make(near=False)
    hand = world.observe().pose_hand_in_map[0, :3, 3]
    yaw = world.observe().pose_base_in_map[2]
    ahead = np.array((np.cos(yaw), np.sin(yaw), 0.0))
    guard.update_person(hand + 1.0 * ahead, radius=0.05)
    past = JointTrajectory(joints=("left_s0",), times=np.array((0.0, 4.0)), positions=np.array(((0.0,), (4.0,))))
    sent = guard.send(past)
    assert sent.times[-1] == pytest.approx(2.0 / NEAR, rel=1e-6)


def test_the_base_carries_the_hands():
    _, guard = make(near=True)
    sent = guard.send(BaseVelocity(velocity=np.array((0.0, 0.4, 0.0))))
    assert np.linalg.norm(sent.velocity) == pytest.approx(NEAR)
    turning = guard.send(BaseVelocity(velocity=np.array((0.0, 0.0, 1.0))))
    arm = np.linalg.norm(HOME_IN_BASE["left"][:2])
    assert turning.velocity[2] * arm == pytest.approx(NEAR)
    _, guard = make(near=False)
    assert np.linalg.norm(guard.send(BaseVelocity(velocity=np.array((0.0, 0.4, 0.0)))).velocity) == pytest.approx(0.4)


def test_base_and_hand_together_keep_the_limit():
    _, guard = make(near=True)
    base = guard.send(BaseVelocity(velocity=np.array((0.0, 0.1, 0.0)), duration=1.0))
    hand = guard.send(twist(y=0.5))
    assert np.linalg.norm(base.velocity) + speed(hand) <= NEAR + 1e-9
    _, guard = make(near=True)
    hand = guard.send(twist(y=0.1, duration=1.0))
    base = guard.send(BaseVelocity(velocity=np.array((0.0, 0.4, 0.0))))
    assert np.linalg.norm(base.velocity) + speed(hand) <= NEAR + 1e-9


def test_a_hand_that_holds_an_arm_is_slow_and_lifts_for_five_seconds():
    _, guard = make(near=False)
    guard.declare_grip("left", "arm")
    assert speed(guard.send(twist(z=0.1))) == pytest.approx(DEFAULT.lift_speed)
    path = np.array(((0, 0), (0, 0.16)))
    lift = JointTrajectory(joints=("left_e0", "left_s1"), times=np.array((0.0, 1.0)), positions=path)
    assert guard.send(lift).times[-1] == pytest.approx(DEFAULT.lift_duration), "8 cm are a lift"
    nudge = JointTrajectory(joints=("left_s1",), times=np.array((0.0, 1.0)), positions=np.array(((0.0,), (0.08,))))
    assert guard.send(nudge).times[-1] == pytest.approx(1.0), "4 cm are a correction"


def test_the_grip_on_an_arm_and_near_the_person_is_soft():
    _, guard = make(near=False)
    assert guard.send(GripperOpening(side="left", opening=0.0, force_limit=60.0)).force_limit == 60.0
    guard.declare_grip("left", "arm")
    assert guard.send(GripperOpening(side="left", opening=0.0, force_limit=60.0)).force_limit == 30.0
    _, guard = make(near=True)
    assert guard.send(GripperOpening(side="left", opening=0.0, force_limit=60.0)).force_limit == 30.0


@pytest.mark.parametrize("seed", range(6))
def test_no_mixture_of_commands_moves_a_hand_too_fast_near_the_person(seed):
    """Random twists, trajectories and base velocities at all times, watched at every step of the world."""
    rng = np.random.default_rng(seed)
    worst = []

    class Watched(World):
        def _step(self, dt):
            before = self._hands()
            super()._step(dt)
            speed = np.linalg.norm(self._hands() - before, axis=1) / dt
            worst.extend(speed[zone.distance(before) < DEFAULT.near_person])

        def _hands(self):
            return np.stack(
                [
                    self.kinematics.pose_hand_in_map(side, self._q[n], self._base)[:3, 3]
                    for n, side in enumerate(("left", "right"))
                ]
            )

    world = Watched(stopping_time=0.0)
    guard = GuardedWorld(world)
    arm = world.observe().pose_hand_in_map[0, :3, 3] + np.array(((-0.6, -0.9, 0), (-0.3, -0.7, 0), (-0.1, -0.8, 0.1)))
    zone = guard.zone
    guard.update_person(arm)
    for _ in range(250):
        side = ("left", "right")[rng.integers(2)]
        kind = rng.integers(3)
        if kind == 0:
            towards = arm[rng.integers(3)] - world.observe().pose_hand_in_map[("left", "right").index(side), :3, 3]
            velocity = rng.uniform(0, 0.6) * (towards / np.linalg.norm(towards) + 0.5 * rng.standard_normal(3))
            guard.send(
                HandTwist(side=side, twist_in_map=np.append(velocity, np.zeros(3)), duration=float(rng.uniform(0.1, 1)))
            )
        elif kind == 1:
            here = world.observe().arm_positions[("left", "right").index(side), :3]
            there = here + rng.uniform(-0.8, 0.8, 3)
            guard.send(
                JointTrajectory(
                    joints=tuple(f"{side}_{joint}" for joint in ("s0", "s1", "e0")),
                    times=np.array((0.0, rng.uniform(0.3, 2.0))),
                    positions=np.array((here, there)),
                )
            )
        else:
            guard.send(BaseVelocity(velocity=rng.uniform(-0.4, 0.4, 3), duration=float(rng.uniform(0.1, 0.5))))
        world.clock.wait_until(world.clock.now() + rng.uniform(0.02, 0.3))
    assert len(worst) > 20, "the hands did come near"
    assert max(worst) <= DEFAULT.hand_speed
