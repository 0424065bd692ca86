"""What the guard does as the load on a hand grows."""

import numpy as np
import pytest
from caretree.sim.world import BaseVelocity, JointTrajectory
from caretree.skills.core.reasons import Reason, SkillFailure

from .guarded import make, pull, speed, twist


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


def test_a_retreat_is_not_believed_against_a_load_far_above_the_limit():
    world, guard = make(near=False)
    pull(world, 60.0)
    with pytest.raises(SkillFailure, match="60\\.0 N on the left hand"):
        guard.send(twist(x=0.05), retreat=True)
    assert speed(guard.send(twist(x=-0.05), retreat=True)) == pytest.approx(0.05)
