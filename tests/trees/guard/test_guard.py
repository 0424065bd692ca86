"""The guard against every way of commanding: what passes, what is slowed, what is refused."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.sim.faults import FaultyWorld
from caretree.sim.scripted.linear_arm import HOME_IN_BASE, LinearArms
from caretree.sim.scripted.world import ScriptedWorld, scripted_room
from caretree.sim.world import (
    BaseVelocity,
    EmergencyStop,
    Frame,
    GripperOpening,
    HandTwist,
    JointTrajectory,
    SensorLost,
)
from caretree.skills.core.reasons import Reason, SkillFailure
from caretree.trees.guard.guard import GuardedWorld
from caretree.trees.guard.limits import DEFAULT

NEAR = DEFAULT.hand_speed * DEFAULT.hand_speed_commanded


class World(ScriptedWorld):
    """The left hand's home is where the person is told to be."""

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.kinematics = LinearArms()


def make(near=True, world=None):
    world = world or World()
    guard = GuardedWorld(world)
    hand = world.observe().pose_hand_in_map[0, :3, 3]
    guard.update_person(hand + np.array((0.2, 0, 0) if near else (3.0, 0, 0)), radius=0.05)
    return world, guard


def twist(x=0.0, y=0.0, z=0.0, side="left", duration=0.2):
    return HandTwist(side=side, twist_in_map=np.array((x, y, z, 0, 0, 0)), duration=duration)


def speed(command):
    return float(np.linalg.norm(command.twist_in_map[:3]))


def pull(world, newton, side="left"):
    """Cloth between closed fingers pulls the hand towards -x."""
    world._opening[("left", "right").index(side)] = world._opening_goal[("left", "right").index(side)] = 0.0
    world.load[side] = np.array((-newton, 0, 0, 0, 0, 0), float)


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


def test_without_kinematics_the_arms_reach_bounds_the_hand():
    world = World()
    bare = FaultyWorld(world, [])
    bare.kinematics = None
    guard = GuardedWorld(bare)
    hand = world.observe().pose_hand_in_map[0, :3, 3]
    move = JointTrajectory(joints=("left_s0",), times=np.array((0.0, 1.0)), positions=np.array(((0.0,), (0.1,))))
    guard.update_person(hand + np.array((0.2, 0, 0)))
    sent = guard.send(move)
    assert sent.times[-1] > 0.5 * 0.1 / NEAR, "never faster than the true hand may be"
    guard.update_person(hand + np.array((3.0, 0, 0)))
    assert guard.send(move).times[-1] == 1.0


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


@pytest.mark.parametrize(("load", "factor"), [(0, 1.0), (7.9, 1.0), (13.0, 0.5), (17.0, 0.1)])
def test_pulling_slows_as_the_cloth_load_grows(load, factor):
    world, guard = make(near=False)
    pull(world, load)
    assert speed(guard.send(twist(x=0.1))) == pytest.approx(0.1 * factor, abs=0.002)
    assert speed(guard.send(twist(x=-0.1))) == pytest.approx(0.1), "giving way is never slowed"


def test_open_fingers_feel_contact_and_not_cloth():
    world, guard = make(near=False)
    world.load["left"] = np.array((-25.0, 0, 0, 0, 0, 0))
    assert speed(guard.send(twist(x=0.1))) == pytest.approx(0.1), (
        "an arm that is pushed aside as fingers close round it"
    )
    world.load["left"] = np.array((-50.0, 0, 0, 0, 0, 0))
    with pytest.raises(SkillFailure, match="limit 30 N"):
        guard.send(twist(x=0.1))


def test_at_the_stop_load_only_relief_passes():
    world, guard = make(near=False)
    pull(world, 19.0)
    with pytest.raises(SkillFailure) as refused:
        guard.send(twist(x=0.05))
    assert refused.value.reason == Reason.FORCE_LIMIT
    assert speed(guard.send(twist(x=-0.05))) == pytest.approx(0.05)
    assert speed(guard.send(twist(x=0.05), retreat=True)) == pytest.approx(0.05)
    away = JointTrajectory(joints=("left_s0",), times=np.array((0.0, 2.0)), positions=np.array(((0.0,), (0.1,))))
    world.load["left"] = np.array((0, -19.0, 0, 0, 0, 0))  # base looks along +y: the arm's first joint moves along +y
    with pytest.raises(SkillFailure):
        guard.send(away)
    world.load["left"] = np.array((0, 19.0, 0, 0, 0, 0))
    assert guard.send(away).times[-1] >= 2.0
    with pytest.raises(SkillFailure):
        guard.send(BaseVelocity(velocity=np.array((-0.1, 0.0, 0.0))))


def test_an_excess_stops_the_motion_once_and_is_held_against_the_running_skill():
    world, guard = make(near=False)
    guard.send(twist(y=0.1, duration=10.0))
    world.clock.wait_until(0.5)
    pull(world, 18.5)
    assert guard.check() is None, "an excess of load ends the skill, not the run"
    world.clock.wait_until(1.0)
    assert guard.still()
    assert guard.take_fault().reason == Reason.FORCE_LIMIT
    assert guard.take_fault() is None
    guard.check()
    assert guard.take_fault() is None, "one excess counts once"
    pull(world, 16.0)
    guard.check()
    pull(world, 18.5)
    guard.check()
    assert guard.take_fault() is None, "not armed again before the load has fallen"
    pull(world, 5.0)
    guard.check()
    pull(world, 18.5)
    guard.check()
    assert guard.take_fault().reason == Reason.FORCE_LIMIT


def test_a_hand_that_holds_an_arm_is_slow_and_lifts_for_five_seconds():
    _, guard = make(near=False)
    guard.declare_grip("left", "arm")
    assert speed(guard.send(twist(z=0.1))) == pytest.approx(DEFAULT.lift_speed)
    path = np.array(((0, 0), (0, 0.16)))
    lift = JointTrajectory(joints=("left_e0", "left_s1"), times=np.array((0.0, 1.0)), positions=path)
    assert guard.send(lift).times[-1] == pytest.approx(DEFAULT.lift_duration), "8 cm are a lift"
    nudge = JointTrajectory(joints=("left_s1",), times=np.array((0.0, 1.0)), positions=np.array(((0.0,), (0.08,))))
    assert guard.send(nudge).times[-1] == pytest.approx(1.0), "4 cm are a correction"


def test_an_arm_in_the_hand_has_its_own_load_limit():
    world, guard = make(near=False)
    guard.declare_grip("left", "arm")
    world.load["left"] = np.array((0, 0, -20.0, 0, 0, 0))
    assert speed(guard.send(twist(z=0.04))) == pytest.approx(0.04)
    guard.check()
    assert guard.take_fault() is None
    world.load["left"] = np.array((0, 0, -31.0, 0, 0, 0))
    assert speed(guard.send(twist(z=0.04))) == 0.0, "it goes no farther"
    assert guard.take_fault() is None, "a held arm's load jumps"
    world.clock.wait_until(0.5)
    guard.check()
    assert guard.take_fault().reason == Reason.FORCE_LIMIT


def test_a_held_arm_that_pulls_very_hard_stops_everything_at_once():
    world, guard = make(near=False)
    guard.declare_grip("left", "arm")
    world.load["left"] = np.array((0, 0, -46.0, 0, 0, 0))
    guard.check()
    assert guard.take_fault().reason == Reason.FORCE_LIMIT


def test_the_grip_on_an_arm_and_near_the_person_is_soft():
    _, guard = make(near=False)
    assert guard.send(GripperOpening(side="left", opening=0.0, force_limit=60.0)).force_limit == 60.0
    guard.declare_grip("left", "arm")
    assert guard.send(GripperOpening(side="left", opening=0.0, force_limit=60.0)).force_limit == 30.0
    _, guard = make(near=True)
    assert guard.send(GripperOpening(side="left", opening=0.0, force_limit=60.0)).force_limit == 30.0


def test_opening_the_fingers_lets_go():
    world, guard = make(near=False)
    guard.send(GripperOpening(side="left", opening=0.02))
    world.clock.wait_until(2.0)
    guard.declare_grip("left", "arm")
    guard.send(GripperOpening(side="left", opening=0.0))
    assert guard.grip("left") == "arm"
    guard.send(GripperOpening(side="left", opening=0.08))
    assert guard.grip("left") == "nothing"


def test_measured_speed_above_the_limit_fails_the_skill():
    world, guard = make(near=True)
    world.send(twist(y=0.4, duration=10.0))  # past the guard, as a runaway controller would
    fault = None
    for tick in range(1, 15):
        world.clock.wait_until(tick / 15)
        guard.check()
        hand = world.observe().pose_hand_in_map[0, :3, 3]
        guard.update_person(hand + np.array((0.2, 0, 0)))
        fault = fault or guard.take_fault()
    assert fault.reason == Reason.SPEED_LIMIT
    world.clock.wait_until(2.0)
    assert guard.still()


def test_dead_senses_stop_the_run():
    class Frozen(World):
        def observe(self):

            seen = super().observe()
            return replace(seen, wrench_hand_in_map=np.zeros((2, 6))) if self.clock.now() > 1.0 else seen

    class Late(World):
        def observe(self):

            seen = super().observe()
            return replace(seen, time=min(seen.time, 1.0))

    for kind, said in ((Frozen, "wrench has not varied"), (Late, "no new joint state")):
        world, guard = make(world=kind())
        verdicts = []
        for tick in range(45):
            world.clock.wait_until(tick / 15)
            verdicts.append(guard.check())
        first = next(n for n, verdict in enumerate(verdicts) if verdict is not None)
        assert 1.0 < first / 15 < 2.5
        assert verdicts[first].reason == Reason.SENSOR_STALE
        assert said in verdicts[first].detail


def test_one_dead_hand_is_enough():
    class Half(World):
        def observe(self):
            seen = super().observe()
            seen.wrench_hand_in_map[1] = (1.0, 2.0, 3.0, 0.0, 0.0, 0.0)
            return seen

    world, guard = make(world=Half())
    for tick in range(45):
        world.clock.wait_until(tick / 15)
        verdict = guard.check()
    assert "right wrench" in verdict.detail


def test_stale_and_frozen_images_fail_whoever_looks():
    class Cameras(World):
        def look(self, camera):
            frame = super().look(camera)
            if camera == "head":
                return Frame(
                    camera=camera,
                    stamp=0.0,
                    rgb=frame.rgb,
                    depth=frame.depth,
                    intrinsics=frame.intrinsics,
                    pose_camera_in_map=frame.pose_camera_in_map,
                )
            return Frame(
                camera=camera,
                stamp=frame.stamp,
                rgb=frame.rgb,
                depth=np.ones((4, 4), np.float32),
                intrinsics=frame.intrinsics,
                pose_camera_in_map=frame.pose_camera_in_map,
            )

    world, guard = make(world=Cameras())
    guard.look("head")
    world.clock.wait_until(1.5)
    with pytest.raises(SensorLost, match=r"image is 1\.5 s old"):
        guard.look("head")
    for tick in range(5):
        world.clock.wait_until(2.0 + tick / 15)
        guard.look("left_hand")
    world.clock.wait_until(2.5)
    with pytest.raises(SensorLost, match="has not varied in 5 frames"):
        guard.look("left_hand")


def test_the_guard_passes_on_the_contract_and_nothing_else():
    _, guard = make()
    public = {name for name in dir(guard) if not name.startswith("_")}
    assert public == {
        "limits",
        "clock",
        "room",
        "robot",
        "update_person",
        "declare_grip",
        "grip",
        "zone",
        "held_arms",
        "take_fault",
        "still",
        "was_stopped",  # told by the runner
        "check",
        "seen",  # what was observed last, for who watches
        "observe",
        "look",
        "send",
        "stop",
        "close",
    }


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


def test_wrong_places_of_the_person_are_refused():
    _, guard = make()
    with pytest.raises(Exception, match=r"finite points of shape \(n, 3\)"):
        guard.update_person(np.zeros((3, 2)))
    with pytest.raises(Exception, match=r"finite points"):
        guard.update_person(np.full((2, 3), np.nan))
    with pytest.raises(Exception, match="radius"):
        guard.update_person(np.zeros((2, 3)), radius=-1.0)


class Died(World):
    """From 1 s on nothing new comes from the robot, nothing reaches it, and its fingers were open."""

    def observe(self):
        if self.clock.now() <= 1.0 or not hasattr(self, "last"):
            self.last = super().observe()
        return self.last


def test_what_a_dead_robot_left_behind_is_lost_for_everybody():
    world, guard = make(world=Died())
    world.clock.wait_until(1.0)
    assert guard.still()
    world.clock.wait_until(1.0 + DEFAULT.stale_after + 0.1)
    for use in (guard.observe, guard.still, lambda: guard.send(twist(z=0.05))):
        with pytest.raises(SensorLost, match="no new joint state"):
            use()
    assert not world.sent


def test_a_wrench_that_is_no_number_is_no_small_load():
    class Broken(World):
        def observe(self):
            seen = super().observe()
            seen.wrench_hand_in_map[0, 0] = np.nan
            return seen

    _, guard = make(world=Broken())
    with pytest.raises(SensorLost, match="wrench_hand_in_map"):
        guard.send(twist(z=0.05))


def test_the_emergency_stop_has_its_own_reason_and_nothing_is_sent():
    class Pressed(World):
        def observe(self):
            return replace(super().observe(), emergency_stop=self.clock.now() > 1.0)

    world, guard = make(world=Pressed())
    assert guard.check() is None
    world.clock.wait_until(1.1)
    assert guard.check().reason == Reason.EMERGENCY_STOP
    with pytest.raises(EmergencyStop):
        guard.send(twist(z=0.05))
    assert not world.sent
    guard.stop()


def test_a_robot_that_answers_nothing_else_while_the_emergency_stop_is_pressed():
    class Refuses(World):
        def observe(self):
            raise EmergencyStop("pressed")

    assert GuardedWorld(Refuses()).check().reason == Reason.EMERGENCY_STOP
