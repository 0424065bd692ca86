from contextlib import suppress

import numpy as np
import pytest
from caretree.sim.errors import CaretreeError
from caretree.sim.faults import FAULTS, PHASES, SETTLED, FaultSpec, FaultyWorld, parse_fault
from caretree.sim.scripted.world import ScriptedWorld
from caretree.sim.world import GripperOpening, HandTwist, SensorLost


def faulty(fault, **kwargs):
    inner = ScriptedWorld(**kwargs)
    world = FaultyWorld(inner, [FaultSpec(fault, "node", "start")])
    return inner, world


def begin(world):
    world.on_phase("node", "start")


def move(world):
    world.send(HandTwist(side="left", twist_in_map=np.array((0.1, 0, 0, 0, 0, 0)), duration=0.5))


def test_fault_texts():
    assert parse_fault("grip_slip@pull along: slowly:step") == FaultSpec("grip_slip", "pull along: slowly", "step")
    assert str(parse_fault("occlusion@a:cancel")) == "occlusion@a:cancel"
    for text, said in (
        ("grip_slip", "is not written FAULT@NODE:PHASE"),
        ("grip_slip@a", "is not written"),
        ("slip@a:step", "unknown fault 'slip'; there are grip_slip"),
        ("grip_slip@:step", "is not written"),
        ("grip_slip@a:end", "unknown phase 'end'; there are start, step, cancel"),
    ):
        with pytest.raises(Exception, match=said):
            parse_fault(text)
    assert len(FAULTS) == 9
    assert len(PHASES) == 3


def test_nothing_happens_elsewhere_and_a_fault_begins_once():
    inner, world = faulty("person_moves")
    world.on_phase("other", "start")
    world.on_phase("node", "step")
    assert not world.begun
    begin(world)
    begin(world)
    assert len(world.begun) == 1
    assert np.linalg.norm(inner.person_offset) == pytest.approx(0.1)


def test_without_a_fault_everything_passes():
    inner, world = ScriptedWorld(), FaultyWorld(ScriptedWorld(), [])
    for each in (inner, world):
        move(each)
        each.clock.wait_until(1.0)
    np.testing.assert_array_equal(inner.observe().arm_positions, world.observe().arm_positions)
    np.testing.assert_array_equal(inner.look("head").depth, world.look("head").depth)
    with pytest.raises(AttributeError):
        _ = world.truth


def test_grip_slip_takes_what_the_closed_hand_holds():
    inner, world = faulty("grip_slip")
    inner.between_fingers.update(left=0.01, right=0.01)
    world.send(GripperOpening(side="right", opening=0.0))
    begin(world)
    assert inner.between_fingers == {"left": 0.01, "right": 0.0}


def test_a_lost_command_is_lost_without_a_word_and_so_is_a_stop():
    inner, world = faulty("lost_command")
    move(world)
    inner.clock.wait_until(0.1)
    begin(world)
    sent = len(inner.sent)
    world.stop()
    move(world)
    assert len(inner.sent) == sent
    inner.clock.wait_until(0.2)
    assert np.abs(inner.observe().arm_velocities).max() > 0.0, "the stop was lost"
    inner.clock.wait_until(1.2)
    move(world)
    assert len(inner.sent) == sent + 1


def test_a_stop_gets_through_where_the_clock_is_gone_before_any_fault():
    inner, world = faulty("lost_command")
    stopped = []
    inner.stop = lambda: stopped.append("stop")
    inner.clock.now = lambda: 1 / 0
    world.stop()
    assert stopped == ["stop"]


def test_a_force_spike_is_large_and_short():
    inner, world = faulty("force_spike")
    begin(world)
    assert np.linalg.norm(world.observe().wrench_hand_in_map[0, :3]) > 20.0
    inner.clock.wait_until(0.6)
    assert np.linalg.norm(world.observe().wrench_hand_in_map[0, :3]) < 1.0


def test_a_dead_sensor_repeats_and_a_dead_camera_is_gone():
    inner, world = faulty("dead_sensor")
    begin(world)
    first = world.observe().wrench_hand_in_map
    inner.clock.wait_until(100.0)
    np.testing.assert_array_equal(first, world.observe().wrench_hand_in_map)
    _, world = faulty("dead_camera")
    world.look("head")
    begin(world)
    with pytest.raises(SensorLost, match="head camera gives no image"):
        world.look("head")


def test_a_camera_that_is_out_comes_back_after_20_seconds():
    inner, world = faulty("camera_out")
    begin(world)
    inner.clock.wait_until(19.9)
    with pytest.raises(SensorLost, match="head camera gives no image"):
        world.look("head")
    inner.clock.wait_until(20.1)
    assert world.look("head").stamp == pytest.approx(20.1, abs=0.05)


def test_a_stale_frame_keeps_its_old_stamp():
    inner, world = faulty("stale_frame")
    inner.clock.wait_until(1.0)
    old = world.look("head")
    begin(world)
    inner.clock.wait_until(2.0)
    assert world.look("head") is old
    inner.clock.wait_until(5.0)
    assert world.look("head").stamp == 5.0


def test_an_occluded_frame_is_hidden_not_frozen():
    inner, world = faulty("occlusion")
    begin(world)
    first, second = world.look("head"), world.look("head")
    hidden = first.depth < 0.5
    assert 0.5 < hidden.mean() < 0.9
    assert not np.array_equal(first.depth, second.depth)
    assert inner.look("head").depth.min() > 1.0


def test_physical_faults_need_a_world_that_can_play_them():
    class Plain(ScriptedWorld):
        fault_grip_slip = None

    with pytest.raises(CaretreeError, match=r"Plain cannot play grip_slip, which happens in physics; .* occlusion"):
        FaultyWorld(Plain(), [FaultSpec("grip_slip", "n", "step")])
    assert FaultyWorld(Plain(), [FaultSpec("occlusion", "n", "step")]).faults


def ask(world, inner, fault):
    """Whatever the fault changes."""
    if fault in ("occlusion", "stale_frame"):
        world.look("head")
    elif fault in ("camera_out", "dead_camera"):
        with suppress(SensorLost):
            world.look("head")
    elif fault == "lost_command":
        world.stop()
    elif fault == "person_moves":
        _ = inner.person_offset
    else:
        world.observe()


@pytest.mark.parametrize("fault", FAULTS)
def test_a_run_is_settled_half_a_minute_after_its_fault_was_felt(fault):
    inner, world = faulty(fault)
    inner.between_fingers["left"] = 0.01  # for a grip to slip
    world.look("head")  # for a frame to be stale
    ask(world, inner, fault)
    assert not world.felt
    begin(world)
    inner.clock.wait_until(0.4)
    ask(world, inner, fault)
    felt = 0.0 if fault == "grip_slip" else 0.4
    assert world.felt == {fault: felt}
    inner.clock.wait_until(felt + SETTLED - 0.1)
    ask(world, inner, fault)
    assert not world.settled
    inner.clock.wait_until(felt + SETTLED)
    assert world.settled


def test_what_changes_nothing_is_not_felt():
    for fault in ("grip_slip", "stale_frame", "occlusion", "force_spike"):
        inner, world = faulty(fault)
        begin(world)
        if fault == "stale_frame":
            world.look("head")  # the first one: there is none that could be shown again
        inner.clock.wait_until(5.0)  # over
        ask(world, inner, fault)
        inner.clock.wait_until(100.0)
        assert not world.felt
        assert not world.settled


def test_a_run_is_settled_when_its_last_fault_is():
    inner = ScriptedWorld()
    world = FaultyWorld(inner, [FaultSpec("dead_sensor", "node", "start"), FaultSpec("occlusion", "later", "start")])
    begin(world)
    world.observe()
    inner.clock.wait_until(100.0)
    assert not world.settled
    world.on_phase("later", "start")
    world.look("head")
    assert not world.settled
    inner.clock.wait_until(100.0 + SETTLED)
    assert world.settled
