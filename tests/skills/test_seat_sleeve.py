"""A seated strap is tucked down beside the shoulder, unless that pulls too hard or the mattress is near."""

import numpy as np
import pytest
from caretree.sim.robot import model
from caretree.sim.robot.kinematics import default_kinematics
from caretree.sim.scripted.world import ScriptedWorld, scripted_room
from caretree.sim.world import SIDES
from caretree.skills.core.context import Context
from caretree.skills.geometry.stances import stance
from caretree.skills.geometry.strap_grip import StrapGrip
from caretree.skills.scripted.scripted_senses import ScriptedSenses
from caretree.skills.seat_sleeve import SeatSleeve
from caretree.trees.guard.guard import GuardedWorld
from py_trees.common import Status


def heights(load, bed_below):
    """Heights (n,) of the hand over time, for a strap that pulls footward, and a bed that far below the hand [m]."""
    n, room = SIDES.index("right"), scripted_room()
    room.waypoints["start"] = tuple(stance("right", "shoulder"))
    world = ScriptedWorld(seed=1, room=room, kinematics=default_kinematics(), arm_positions=model.READY)
    room.bed[1, 2] = world.observe().pose_hand_in_map[n, 2, 3] - bed_below
    world.load["right"] = np.array((0.0, load, 0.0, 0.0, 0.0, 0.0))
    guard = GuardedWorld(world)
    context = Context(world=guard, guard=guard, seed=1)
    context.offer_senses(ScriptedSenses(context.world))
    grip = StrapGrip(arm="right", hand="right", across_in_hand=np.array((0.0, 1.0, 0.0)))
    skill, seen = SeatSleeve("seat sleeve", context, grip=grip), []
    for _ in range(3000):
        context.lease.advance()
        skill.tick_once()
        seen.append(world.observe().pose_hand_in_map[n, 2, 3])
        world.clock.wait_until(world.clock.now() + 1 / 15)
        if skill.status != Status.RUNNING:
            break
    assert skill.status == Status.SUCCESS
    return np.array(seen)


def test_a_strap_that_gives_goes_down():
    height = heights(load=1.0, bed_below=0.6)
    assert height[0] - height.min() == pytest.approx(0.18, abs=0.03)  # [m]: 3 s at 0.06 m/s


def test_it_stops_above_the_mattress():
    height = heights(load=1.0, bed_below=0.09)
    assert height[0] - height.min() == pytest.approx(0.05, abs=0.03)


def test_a_taut_strap_is_not_pulled_down():
    height = heights(load=6.5, bed_below=0.6)
    assert height[0] - height.min() < 0.02
