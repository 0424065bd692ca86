"""The second arm's sleeve: left alone on its own side of the bed, carried back from the other one."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.estimates import Estimate
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.robot import model
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.scripted.world import ScriptedWorld, scripted_room
from caretree.sim.world import SIDES
from caretree.skills.belief.sleeve_search import SleeveMemory
from caretree.skills.carry_sleeve import CarrySleeve
from caretree.skills.control.hands import hand_now
from caretree.skills.core.context import Context
from caretree.skills.core.reasons import Reason
from caretree.skills.geometry.person_zone import WHOLE
from caretree.skills.geometry.stances import stance
from caretree.skills.scripted.scripted_person import laid_strap, lying_posture
from caretree.trees.guard.guard import GuardedWorld
from py_trees.common import Status

from .fake_senses import fake_senses

NOBODY = np.array(((0.0, -0.4, 0.66), (0.0, 0.6, 0.66))), 0.02  # out of the way
THIGH = np.array(((-0.085, 0.0, 0.72), (-0.085, 0.8, 0.72))), 0.08


def ran(sleeve, load=(0.0, 0.0, -1.0), *, own_side=False, person=NOBODY, taken=None):
    """Skill, world and memory after a run from beside the right shoulder, where the first arm was left, or the left.

    The pose (4, 4) of the hand that takes the sleeve is appended to `taken`.
    """
    room, hand = scripted_room(), "left" if own_side else "right"
    start = (
        stance("left", "shoulder") - (0.25, 0.0, 0.0) if own_side else stance("right", "shoulder") + (0.25, 0.0, 0.0)
    )
    room.waypoints["start"] = tuple(start)
    room.bed[1, 2] = 0.64  # low enough for hands that are ready to pass over the person
    world = ScriptedWorld(seed=1, room=room, kinematics=kinematics_of(BAXTER), arm_positions=model.READY)
    guard = GuardedWorld(world)
    guard.update_person(person[0], part=WHOLE, radius=person[1])
    context = Context(
        world=guard,
        guard=guard,
        seed=1,
        senses=fake_senses(sleeve_opening=sleeve, gripped_cloth=Estimate(stamp=0.0, confidence=0.9)),
    )
    skill = CarrySleeve("across", context, side="left", own_side=own_side)
    for _ in range(6000):
        context.lease.advance()
        skill.tick_once()
        world.clock.wait_until(world.clock.now() + 1 / 15)
        if "carries" in skill.feedback_message and not world.observe().gripper_opening[SIDES.index(hand)] > 0.01:
            if taken is not None and not np.any(world.load[hand]):
                taken.append(hand_now(skill, hand))
            world.load[hand] = np.append(load, np.zeros(3))
        if skill.status != Status.RUNNING:
            break
    return skill, world, context.memory.of(SleeveMemory, SleeveMemory)


def at(x, y, z=0.68):
    return replace(laid_strap("left"), position_in_map=np.array((x, y, z)))


@pytest.mark.parametrize("sleeve", [at(-0.3, 0.2), PerceptionFailure(Problem.OUT_OF_REACH, "armhole")])
def test_a_sleeve_on_its_side_or_out_of_sight_is_left_alone(sleeve):
    skill, world, memory = ran(sleeve)
    assert skill.status == Status.SUCCESS, skill.failure
    assert np.allclose(world.observe().pose_base_in_map, stance("right", "shoulder") + (0.25, 0.0, 0.0), atol=0.01)
    assert not memory.last


def test_a_stray_sleeve_is_laid_beyond_the_arm_it_belongs_to():
    skill, world, memory = ran(at(0.28, 0.44))
    assert skill.status == Status.SUCCESS, skill.failure
    middle = world.room.bed[:, :2].mean(axis=0)
    assert np.allclose(memory.last["left"][:2], middle + (-0.33, 0.16), atol=0.03)
    assert memory.last["left"][2] < world.room.bed[1, 2] + 0.25
    assert world.observe().gripper_opening.min() > 0.03, "neither hand holds anything"


def test_it_goes_no_farther_than_the_other_sleeve_lets_it():
    skill, _, memory = ran(at(0.28, 0.44), load=(5.0, 0.0, -2.0))
    assert skill.status == Status.SUCCESS, skill.failure
    assert memory.last["left"][0] > 0.0


@pytest.fixture
def shown(monkeypatch):
    """Tells how much of the arm shows."""

    def tell(share):
        monkeypatch.setattr("caretree.skills.carry_sleeve.watch_arm", lambda skill, side: lying_posture(side))
        monkeypatch.setattr("caretree.skills.carry_sleeve.bare_share", lambda frame, posture: share)

    return tell


ON_THE_TRUNK, HEADWARD_OF_THE_HAND, OVER_THE_ARM = at(-0.13, 0.13), at(-0.3, -0.3), at(-0.3, 0.05)


@pytest.mark.parametrize(("sleeve", "share"), [(ON_THE_TRUNK, 1.0), (HEADWARD_OF_THE_HAND, 1.0), (OVER_THE_ARM, 0.5)])
def test_from_its_own_side_a_sleeve_that_its_arm_cannot_take_is_carried_out(sleeve, share, shown):
    shown(share)
    skill, world, memory = ran(sleeve, own_side=True)
    assert skill.status == Status.SUCCESS, skill.failure
    middle = world.room.bed[:, :2].mean(axis=0)
    assert np.allclose(memory.last["left"][:2], middle + (-0.26, 0.30), atol=0.03)


def test_from_its_own_side_one_beside_an_arm_that_shows_is_left_alone(shown):
    shown(1.0)
    skill, _, memory = ran(at(-0.3, 0.13), own_side=True)
    assert skill.status == Status.SUCCESS, skill.failure
    assert not memory.last


@pytest.mark.parametrize(
    ("person", "sleeve", "lean"), [(NOBODY, ON_THE_TRUNK, 0.0), (THIGH, at(-0.153, 0.28, 0.763), 0.96)]
)
def test_the_hand_leans_as_far_as_the_body_beside_the_strap_asks_for(person, sleeve, lean, shown):
    shown(1.0)
    taken = []
    upright = replace(sleeve, closing_in_map=np.array((-0.73, 0.11, 0.67)))
    skill, _, _ = ran(upright, own_side=True, person=person, taken=taken)
    assert skill.status == Status.SUCCESS, skill.failure
    approach = taken[0][:3, 2]
    assert np.arccos(-approach[2]) == pytest.approx(lean, abs=0.1)
    assert approach[0] >= -0.05, "from its own side of the bed"


HIP = np.array(((-0.1, -0.5, 0.704), (-0.1, 0.3, 0.704))), 0.104


@pytest.mark.parametrize("rim", [0.90, 0.76])
def test_a_strap_right_on_the_body_is_left_to_the_top_of_a_rim_that_stands_up_beside_it(rim, shown):
    shown(1.0)
    taken, strap = [], at(-0.172, 0.12, 0.761)
    along = np.linspace(-0.05, 0.05, 21)
    arch = np.column_stack((np.full(21, -0.12), 0.12 + along, rim - 4.0 * along**2))
    skill, _, _ = ran(replace(strap, armhole_points_in_map=arch), own_side=True, person=HIP, taken=taken)
    if rim < 0.8:
        assert skill.failure.reason == Reason.UNREACHABLE
        return
    assert skill.status == Status.SUCCESS, skill.failure
    assert taken[0][:3, 3] == pytest.approx((-0.12, 0.12, rim), abs=0.03)
    assert abs(taken[0][0, 1]) > 0.7, "its fingers close across the rim"
