"""The guard as a world: the contract, senses that die, the emergency stop."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.sim.world import EmergencyStop, Frame, SensorLost
from caretree.skills.core.reasons import Reason
from caretree.trees.guard.guard import GuardedWorld
from caretree.trees.guard.limits import DEFAULT

from .guarded import World, make, twist


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
