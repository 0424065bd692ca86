"""A rehearsal that is ticked as seldom as it suffices is the same rehearsal."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.world import SIDES, BaseVelocity, HandTwist, JointTrajectory
from caretree.skills.core.skill import Skill
from caretree.skills.scripted.rehearsal import REHEARSAL, RehearsalWorld
from caretree.trees.run.runner import Run
from caretree.trees.run.task import load_task
from caretree.trees.run.worlds import TICK_RATE

from ...trees.planted import run_of


def ended(name, rate_hz):
    """How a task ends at a tick rate, and which leaves and nodes did, in order and how."""
    task = load_task(name)
    world, senses = task.scripted(0)
    run = Run(task, world, rate_hz=rate_hz, senses=senses)
    outcome = run.run().outcome
    nodes = [event for event in run.trace.events if event["kind"] == "node" and event["status"] != "RUNNING"]
    return outcome, [(event["node"], event["status"], event.get("reason")) for event in nodes]


@pytest.mark.parametrize("name", ["draw_blanket", "hand_towel", "undress", "wash_arm", "wave", "wipe_forearm"])
def test_tasks_go_the_same_way_at_the_rate_that_suffices(name):
    assert ended(name, REHEARSAL.tick_rate) == ended(name, TICK_RATE)


def test_the_dressing_succeeds_at_the_rate_that_suffices():
    outcome, nodes = ended("dressing", REHEARSAL.tick_rate)
    assert outcome == "success"
    stages = [node.rpartition("/")[2] for node, status, _ in nodes if node.count("/") == 2 and status == "SUCCESS"]
    assert stages == ["take down", "lay", "dress", "until it is worn"]


@pytest.mark.no_cover  # counting lines doubles its time
@pytest.mark.parametrize("seed", range(5))
def test_two_ur5_arms_dress_far_from_their_limits_and_singular_postures(seed):
    task = load_task("dressing", robot="ur5-pair")
    world, senses = task.scripted(seed)
    run = Run(task, world, rate_hz=REHEARSAL.tick_rate, senses=senses)
    arms, kinematics = [], kinematics_of(world.robot)
    run.context.observers.append(lambda name, phase: arms.append(world.observe().arm_positions))
    assert run.run().outcome == "success"
    for n, side in enumerate(SIDES):
        for q in np.unique(np.round(np.array(arms)[:, n], 2), axis=0):
            # from there on sim/mechanics/damped_rates.py lets a hand follow its twist in full
            assert kinematics.limits[side].margin(q) > 0.05  # [rad]
            assert np.linalg.svd(kinematics.jacobian_hand_in_base(side, q), compute_uv=False)[-1] > 0.06


class Drives(Skill):
    """Sends one velocity, and looks on the next tick how far it went."""

    way = 0.0

    def steps(self):
        start = self.world.observe().pose_base_in_map[0]
        self.world.send(BaseVelocity(velocity=np.array((0.0, -0.1, 0.0)), duration=0.2))
        yield
        self.way = self.world.observe().pose_base_in_map[0] - start


@pytest.mark.parametrize(("rate_hz", "lasts"), [(TICK_RATE, 1 / 15), (5.0, 0.2), (3.0, 1 / 3)])
def test_a_velocity_holds_until_the_next_tick_however_late(rate_hz, lasts):
    run = run_of(lambda context: Drives("drives", context), RehearsalWorld(), rate_hz=rate_hz)
    assert run.run().outcome == "success"
    turned = 0.1 * np.sin(RehearsalWorld().observe().pose_base_in_map[2])
    assert run.root.way == pytest.approx(turned * lasts, abs=1e-9)


def test_the_senses_sample_once_an_instant_and_anew_after_a_command():
    world = RehearsalWorld()
    first = world.observe()
    assert world.observe() is first
    world.clock.wait_until(0.1)
    later = world.observe()
    assert (later.wrench_hand_in_map != first.wrench_hand_in_map).all(), "their noise is drawn anew"
    world.send(BaseVelocity(velocity=np.array((0.1, 0.0, 0.0)), duration=0.2))
    assert world.observe().twist_base[0] == 0.1, "a command shows at once"
    world.stop()
    assert world.observe() is not later


def led(rate_hz, steps=None):
    """Where a twist of 0.1 m/s for a second leads the left hand, ticked at a rate; and in how many steps."""
    tuning = REHEARSAL if steps is None else replace(REHEARSAL, twist_steps=steps)
    world = RehearsalWorld(tuning=tuning)
    step, taken = world._step, []
    world._step = lambda dt: (taken.append(dt), step(dt))
    world.send(HandTwist(side="left", twist_in_map=np.array((0.0, -0.1, 0.0, 0.0, 0.0, 0.0)), duration=1.0))
    for tick in range(1, round(2 * rate_hz) + 1):
        world.clock.wait_until(tick / rate_hz)
    return world.observe().pose_hand_in_map[0, :3, 3], len(taken)


def test_a_hand_follows_a_twist_as_well_in_the_few_steps_of_a_rare_tick():
    place, steps = led(REHEARSAL.tick_rate)
    exact, many = led(REHEARSAL.tick_rate, steps=1000)
    assert steps < many / 3
    assert place == pytest.approx(exact, abs=0.005)  # [m]


def test_at_the_usual_rate_a_hand_follows_as_in_the_simulated_room():
    assert led(TICK_RATE)[1] == led(TICK_RATE, steps=1000)[1]


def test_between_two_ticks_a_trajectory_is_left_alone_but_for_how_fast_it_is_at_the_last():
    world = RehearsalWorld()
    step, taken = world._step, []
    world._step = lambda dt: (taken.append(dt), step(dt))
    times, start = np.array((0.0, 1.0, 2.0)), world.observe().arm_positions[0, 0]
    positions = start + np.array((0.0, 0.1, 0.4))[:, None]
    world.send(JointTrajectory(joints=("left_s0",), times=times, positions=positions))
    for now in (0.5, 1.2, 1.9):
        world.clock.wait_until(now)
        seen = world.observe()
        assert seen.arm_positions[0, 0] == pytest.approx(np.interp(now, times, positions[:, 0]))
        assert seen.arm_velocities[0, 0] == pytest.approx(0.1 if now < 1.0 else 0.3, abs=0.05)
    assert len(taken) == 6
    world.clock.wait_until(3.0)
    assert world.observe().arm_positions[0, 0] == pytest.approx(start + 0.4)
    assert not world.observe().arm_velocities.any()
