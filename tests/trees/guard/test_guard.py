"""The guard as a world: the contract, senses that die, the emergency stop."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.sim.known_robots import robot_named
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.scripted.world import ScriptedWorld
from caretree.sim.world import BaseVelocity, EmergencyStop, Frame, JointTrajectory, SensorLost
from caretree.skills.core.reasons import Reason, SkillFailure
from caretree.trees.guard.guard import GuardedWorld
from caretree.trees.guard.limits import DEFAULT

from .guarded import World, make, speed, twist


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


def test_a_trajectory_that_begins_elsewhere_is_refused():
    """A posture that was taught, sent as one whose first point is the goal: nobody has judged the way there."""
    world, guard = make(near=False)
    joint, here = guard.robot.joints_of("left")[0], world.observe().arm_positions[0, 0]

    def beginning(away):
        positions = np.array(((here + away,), (here + 0.2,)))
        return JointTrajectory(joints=(joint,), times=np.array((0.0, 4.0)), positions=positions)

    guard.send(beginning(0.9 * DEFAULT.plan_start))
    guard.stop()
    with pytest.raises(SkillFailure, match=f"begins 0.20 rad from where {joint} is") as refused:
        guard.send(beginning(0.2))
    assert refused.value.reason == Reason.MOTION_BLOCKED


def test_velocities_are_not_held_for_long():
    _, guard = make(near=False)
    for command in (twist(x=0.01, duration=25.0), BaseVelocity(velocity=np.array((0.01, 0, 0)), duration=25.0)):
        assert guard.send(command).duration == DEFAULT.velocity_for
    assert guard.send(twist(x=0.01, duration=0.3)).duration == 0.3


def test_joints_and_hands_that_contradict_each_other_are_lost_senses():
    class Elsewhere(World):
        aside = np.zeros(3)

        def observe(self):
            seen = super().observe()
            poses = seen.pose_hand_in_map.copy()
            poses[1, :3, 3] += self.aside
            return replace(seen, pose_hand_in_map=poses)

    world, guard = make(near=False, world=Elsewhere())
    guard.observe()
    world.aside = np.array((0.0, 0.3, 0.0))
    world.clock.wait_until(1.0)
    with pytest.raises(SensorLost, match="right hand is said to be 0\\.30 m from where its joints put it"):
        guard.observe()


@pytest.mark.extra
def test_a_joint_beyond_its_limits_is_lost_senses():
    robot = robot_named()

    class Turned(ScriptedWorld):
        turn = 0.0

        def observe(self):
            seen = super().observe()
            return replace(seen, arm_positions=seen.arm_positions + self.turn)

    world = Turned(robot=robot, kinematics=kinematics_of(robot), arm_positions=robot.ready)
    guard = GuardedWorld(world)
    guard.observe()
    world.turn = 40.0
    world.clock.wait_until(1.0)
    with pytest.raises(SensorLost, match="rad, but it turns from"):
        guard.observe()


@pytest.mark.extra
def test_a_world_without_kinematics_gets_those_of_its_robot():
    robot = robot_named()

    class Bare(ScriptedWorld):
        kinematics = None

        def __init__(self):
            super().__init__(robot=robot, kinematics=kinematics_of(robot), arm_positions=robot.ready)
            self._own, self.kinematics = self.kinematics, None

        def observe(self):
            self.kinematics = self._own
            try:
                return super().observe()
            finally:
                self.kinematics = None

    guard = GuardedWorld(Bare())
    palm = guard.observe().pose_hand_in_map[0, :3, 3]
    guard.update_person(palm + np.array((0.0, 0.0, -0.12)), radius=0.05)
    down = guard.send(twist(z=-0.1, duration=0.5))
    assert speed(down) < 0.1, "no link was kept off the person"


@pytest.mark.extra
def test_hands_that_are_not_where_the_robots_model_has_them_are_lost_senses():
    """By its robot's model the guard of an adapter without kinematics keeps links off the person."""

    class Other(World):
        def __init__(self):
            super().__init__()
            self.made_up, self.kinematics = self.kinematics, None

        def observe(self):
            self.kinematics = self.made_up
            try:
                return super().observe()
            finally:
                self.kinematics = None

    with pytest.raises(SensorLost, match="from where its joints put it"):
        GuardedWorld(Other()).observe()
