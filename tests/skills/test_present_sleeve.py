"""A sleeve that does not open before the hand is carried farther out once, then given up as folded."""

import numpy as np
import pytest
from caretree.perception.estimates import SleeveHeading
from caretree.sim.robot import model
from caretree.sim.robot.kinematics import default_kinematics
from caretree.sim.scripted.world import ScriptedWorld, scripted_room
from caretree.skills.core.context import Context
from caretree.skills.core.reasons import Reason
from caretree.skills.geometry.stances import stance
from caretree.skills.geometry.strap_grip import StrapGrip
from caretree.skills.present_sleeve import PresentSleeve
from caretree.skills.scripted.scripted_person import lying_arm, lying_posture
from caretree.trees.guard.guard import GuardedWorld
from py_trees.common import Status

from .fake_senses import fake_senses

WRIST, FINGERTIP = lying_arm("right")[2:]
ALONG = (FINGERTIP - WRIST) * (1.0, 1.0, 0.0) / np.linalg.norm((FINGERTIP - WRIST)[:2])  # the right hand


def heading(beyond):
    return SleeveHeading(stamp=0.0, confidence=0.9, side="right", cuff_from_armhole_in_map=beyond * ALONG)


def ran(seen, load=1.0):
    """The skill after a run, and how often it looked at the sleeve."""
    room = scripted_room()
    room.waypoints["start"] = tuple(stance("right", "lift"))
    world = ScriptedWorld(seed=1, room=room, kinematics=default_kinematics(), arm_positions=model.READY)
    world.load["right"] = np.array((0.0, 0.0, -load, 0.0, 0.0, 0.0))  # the sleeve that hangs from it [N]
    guard = GuardedWorld(world)
    looks, arm = [], lying_posture("right")

    def answer(frame, **details):
        looks.append(frame.stamp)
        return seen[min(len(looks), len(seen)) - 1]

    context = Context(
        world=guard,
        guard=guard,
        seed=1,
        senses=fake_senses(arm=arm, relocalised_arm=arm, sleeve_heading=answer),
    )
    grip = StrapGrip(arm="right", hand="right", across_in_hand=np.array((0.0, 1.0, 0.0)))
    skill = PresentSleeve("present", context, grip=grip, max_load=4.0, min_cuff_distance=0.05)
    for _ in range(3000):
        context.lease.advance()
        skill.tick_once()
        world.clock.wait_until(world.clock.now() + 1 / 15)
        if skill.status != Status.RUNNING:
            break
    assert skill.status == (Status.FAILURE if skill.failure else Status.SUCCESS)
    return skill, len(looks)


@pytest.mark.parametrize(
    ("seen", "reason", "asked"),
    [
        ([heading(0.09)], None, 1),
        ([heading(-0.02), heading(0.08)], None, 2),
        ([heading(-0.02), heading(0.03)], Reason.SLEEVE_FOLDED, 2),
    ],
)
def test_it_is_brought_twice_at_most(seen, reason, asked):
    skill, looks = ran(seen)
    assert (skill.failure and skill.failure.reason) == reason
    assert looks == asked


def test_a_gown_that_is_caught_is_not_torn_off():
    skill, _ = ran([heading(0.09)], load=7.0)  # [N]
    assert skill.failure.reason == Reason.SLEEVE_CAUGHT
