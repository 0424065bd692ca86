"""A person who moves is noticed at once, by the hand that holds their arm or by the camera; a robot's doing is not."""

from collections import deque
from dataclasses import replace

import numpy as np
import pytest
from caretree.perception.classical import ClassicalSenses
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.estimates import Shift
from caretree.sim.bullet.world import BulletWorld
from caretree.sim.world import HandTwist
from caretree.skills.belief.person_motion import PERSON_MOTION, Felt, unexplained_jump, while_person_rests
from caretree.skills.belief.person_tracking import see_person, watch_arm, watch_of
from caretree.skills.core.context import Context
from caretree.skills.core.reasons import Reason
from caretree.skills.geometry.stances import stance
from caretree.skills.scripted.scripted_person import lying_posture
from caretree.trees.guard.guard import GuardedWorld

from ..moving import Mover, carry_out, idle, robot

AWAY = (1.6, -0.4, np.pi)  # beside the bed, hands off the person
FREE = PerceptionFailure(Problem.NOTHING_SEEN, "arm")


def share(value):
    """How much of an arm has shifted."""
    return Shift(stamp=0.0, confidence=0.9, share=value)


def rest(skill, seconds=1.0):
    """Stand beside a person whose right arm is known, as long as they rest."""
    watch_arm(skill, "right")
    yield from while_person_rests(skill, skill.wait(seconds))


def stood(at=AWAY, each_tick=lambda world, context: None, seconds=1.0, **answers):
    """The skill after `rest`, its world and its context."""
    answers = {"arm": lambda frame, side: lying_posture(side), **answers}
    world, context = robot(at, **answers)
    skill = carry_out(
        world, context, lambda skill: rest(skill, seconds), each_tick=lambda skill: each_tick(world, context)
    )
    return skill, world, context


def test_a_person_who_rests_is_left_in_peace():
    skill, _, _ = stood(arm_shift=share(0.25))
    assert skill.failure is None


def test_an_arm_that_leaves_its_place_ends_the_motion_and_is_believed_no_more():
    asked = []

    def shift(frame, *, before, arm_in_map, grips_in_map):
        asked.append((before.stamp, frame.stamp, grips_in_map))
        return share(0.5 if frame.stamp > 0.5 else 0.0)

    skill, world, _ = stood(arm_shift=shift)
    assert skill.failure.reason == Reason.PERSON_MOVED
    assert "right arm" in skill.failure.detail
    assert world.clock.now() < 0.5 + PERSON_MOTION.period + 2 / 15
    assert watch_of(skill).arms == {}
    ages = np.array([now - before for before, now, _ in asked])
    assert ages[2:] == pytest.approx(np.full(len(ages) - 2, 0.27), abs=0.05)
    assert np.diff([now for _, now, _ in asked]).min() > 0.1, "a look costs computing"
    assert all(grips is None for _, _, grips in asked), "nobody holds it"


def test_what_has_moved_is_looked_for_all_over_again():
    searched = []

    def anew(frame, *, side, moved=False):
        searched.append((side, moved))
        return lying_posture(side)

    world, context = robot(
        AWAY, arm=lambda frame, side: lying_posture(side), arm_shift=share(0.5), relocalised_arm=anew
    )
    skill = carry_out(world, context, rest)
    assert searched == []
    watch_arm(skill, "right")
    assert searched == [("right", True)]
    world.clock.wait_until(world.clock.now() + 1.0)
    watch_arm(skill, "right")
    assert searched == [("right", True)], "once it has been found it is tracked as ever"


@pytest.mark.parametrize("holds", [False, True])
def test_an_arm_between_the_fingers_is_the_robots_doing_and_one_that_it_holds_goes_with_the_hand(holds):
    grips = []

    def shift(frame, *, before, arm_in_map, grips_in_map):
        grips.append(grips_in_map)
        return share(0.0)

    def at_hand(frame, side):
        elbow = world.observe().pose_hand_in_map[0, :3, 3]
        lies = lying_posture(side)
        return replace(lies, points_in_map=lies.points_in_map + elbow - lies.points_in_map[1])

    world, context = robot(AWAY, arm=at_hand, arm_shift=shift)
    if holds:
        context.guard.declare_grip("left", "arm")
    assert carry_out(world, context, rest).failure is None
    place = world.observe().pose_hand_in_map[0, :3, 3]
    assert bool(grips) == holds
    for then, now in grips:
        assert then == pytest.approx(place)
        assert now == pytest.approx(place)


def test_a_push_on_the_hand_that_holds_an_arm_is_felt():
    def pushed(force, at):
        def push(world, context):
            context.guard.declare_grip("left", "arm")
            world.load["left"][:3] = (0.0, 0.0, -15.0) if world.clock.now() < at else force

        return push

    skill, world, _ = stood(each_tick=pushed((25.0, 0.0, -15.0), at=0.5), arm_shift=FREE)
    assert skill.failure.reason == Reason.PERSON_MOVED
    assert "left hand by 25 N" in skill.failure.detail
    assert world.clock.now() < 0.5 + 2.1 / 15
    assert stood(each_tick=pushed((12.0, 0.0, -15.0), at=0.5), arm_shift=FREE)[0].failure is None


def test_a_jump_counts_as_far_as_the_hand_did_not_move_against_it():
    def felt(*rows):
        return deque(
            Felt(t, np.array((pull, 0.0, -12.0)), np.array((way, 0.0, 0.0)), np.array((other, 0.0, 5.0)))
            for t, pull, way, other in ((*row, 0.0)[:4] for row in rows)
        )

    pushed = felt((0.0, 2.0, 0.0), (0.07, 14.0, 0.0), (0.13, 30.0, 1e-3))
    assert unexplained_jump(pushed, 20e3) == pytest.approx(28.0)
    shaken = felt((0.0, 15.0, 0.0), (0.07, 0.0, 1e-3), (0.13, -15.0, 2e-3))
    assert unexplained_jump(shaken, 20e3) == pytest.approx(0.0)
    assert unexplained_jump(felt((0.0, 15.0, 0.0), (0.07, 0.0, 0.5e-3)), 20e3) == pytest.approx(5.0)
    assert unexplained_jump(felt((0.0, 3.0, 0.0)), 20e3) == 0.0
    met = felt((0.0, 2.0, 0.0), (0.07, 30.0, 0.0, -27.0))
    assert unexplained_jump(met, 20e3) == pytest.approx(1.0), "the other hand has come down on the arm"
    swung = felt((0.0, 2.0, 0.0), (0.07, 30.0, 0.0, 27.0))
    assert unexplained_jump(swung, 20e3) == pytest.approx(28.0), "an arm that swings takes both hands along"


def test_nothing_is_commanded_once_the_person_has_moved():
    sent = []

    def motion(skill):
        watch_arm(skill, "right")

        def go():
            while skill.now() < 2.0:
                sent.append(skill.now())
                skill.world.send(HandTwist(side="left", twist_in_map=np.zeros(6)))
                yield

        yield from while_person_rests(skill, go())

    moves = lambda frame, **_: share(0.5 if frame.stamp > 0.5 else 0.0)  # noqa: E731
    world, context = robot(AWAY, arm=lambda frame, side: lying_posture(side), arm_shift=moves)
    skill = carry_out(world, context, motion)
    assert skill.failure.reason == Reason.PERSON_MOVED
    assert max(sent) < skill.now()


def test_what_was_felt_and_seen_long_ago_is_forgotten():
    asked = []

    def shift(frame, *, before, arm_in_map, grips_in_map):
        asked.append(frame.stamp - before.stamp)
        return share(0.0)

    world, context = robot(AWAY, arm=lambda frame, side: lying_posture(side), arm_shift=shift)
    carry_out(world, context, lambda skill: rest(skill, 0.2))
    world.clock.wait_until(world.clock.now() + 5.0)
    carry_out(world, context, lambda skill: rest(skill, 0.2))
    assert max(asked) < PERSON_MOTION.memory


@pytest.mark.parametrize("moves", [True, False])
def test_on_physics_a_stir_is_seen_within_three_tenths_of_a_second(moves):
    world = BulletWorld(seed=104)
    world._robot = world._stand(tuple(stance("right", "lift")))
    guard = GuardedWorld(world)
    context = Context(world=guard, guard=guard, senses=ClassicalSenses(world.room, 104))
    world.clock.wait_until(0.5)
    see_person(idle(context))
    skill = Mover(context, lambda skill: while_person_rests(skill, skill.wait(1.5)))
    while True:
        skill.tick_once()
        if skill.failure is not None or world.clock.now() > 2.0:
            break
        due = world.clock.now() + 1 / 15
        if moves and world.clock.now() < 1.0 <= due:
            world.clock.wait_until(1.0)
            world.fault_move_person()
        world.clock.wait_until(due)
    assert not context.errors, context.errors[0]
    assert (skill.failure is not None) == moves
    if moves:
        assert skill.failure.reason == Reason.PERSON_MOVED
        assert world.clock.now() - 1.0 < 0.3
    world.close()
