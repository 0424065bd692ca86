"""How a gown that was taken askew, or is held taut, is laid down and let go of."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.estimates import SleeveHeading
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.robot import model
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.scripted.world import ScriptedWorld, scripted_room
from caretree.sim.world import SIDES
from caretree.skills.belief.lying_sleeves import laid_here, lying_sleeves
from caretree.skills.control.hands import hand_now
from caretree.skills.core.context import Context
from caretree.skills.geometry.stances import outwards
from caretree.skills.lay_gown import LayGown
from caretree.skills.scripted.scripted_person import laid_strap
from caretree.trees.guard.guard import GuardedWorld
from py_trees.common import Status

from .fake_senses import fake_senses

WIDTH = 0.84  # between the hands [m]
STRAIGHT_AT = 0.42  # x at which the near armhole shows in a gown that lies straight [m]
START = (0.77, 1.80, -np.pi / 2)  # of the base, where the hem begins to touch the legs [m, m, rad]
NARROWING = 0.03  # of the hands at once [m]
HIDDEN = PerceptionFailure(Problem.NOTHING_SEEN, "cuff")


def armhole(x):
    seen = laid_strap("right")
    return replace(seen, armhole_points_in_map=seen.armhole_points_in_map * (0.0, 1.0, 1.0) + (x, 0.0, 0.0))


def heading(up, inwards=0.0):
    """A near sleeve whose cuff shows by `up` above its armhole, and so much `inwards` of it [m]."""
    cuff = np.array((0.0, 0.0, up)) - inwards * outwards("right")
    return SleeveHeading(stamp=0.0, confidence=0.9, side="right", cuff_from_armhole_in_map=cuff)


def let_go_at(seen, taut_until=1.0, width=WIDTH, way_down=None, across=None, stands=HIDDEN, skills=None, lying=()):
    """The places x of both hands when the first one opens [m]; each is drawn inwards while they are farther apart."""
    room = scripted_room()
    room.waypoints["start"] = START
    world = ScriptedWorld(seed=1, room=room, kinematics=kinematics_of(BAXTER), arm_positions=model.READY)
    guard = GuardedWorld(world)
    context = Context(world=guard, guard=guard, seed=1, senses=fake_senses(sleeve_opening=seen, sleeve_heading=stands))
    skill = LayGown("lay", context, width=width)
    lying_sleeves(context).update(lying)
    if skills is not None:
        skills.append(skill)
    places = []
    for _ in range(9000):
        context.lease.advance()
        skill.tick_once()
        world.clock.wait_until(world.clock.now() + 1 / 15)
        x = {side: float(hand_now(skill, side)[0, 3]) for side in SIDES}
        if way_down is not None:
            way_down.append([hand_now(skill, side)[1:3, 3] for side in SIDES])
        if across is not None:
            across.append(x["left"] - x["right"])
        pull = 1.0 if x["left"] - x["right"] > taut_until + 0.005 else 0.1
        places.append((x["left"], x["right"]))
        for side, sign in zip(SIDES, (1.0, -1.0), strict=True):
            world.load[side] = np.array((-sign * pull, 0.0, -1.0, 0.0, 0.0, 0.0))
        if "withdraws" in skill.feedback_message or skill.status != Status.RUNNING:
            break
    assert skill.failure is None, skill.failure
    return places[-1]


@pytest.mark.parametrize(("askew", "shift"), [(0.0, 0.0), (0.1, 0.0), (-0.02, 0.0), (-0.04, 0.04), (-0.2, 0.12)])
def test_a_gown_that_is_longer_on_the_far_side_is_drawn_across(askew, shift):
    near, far = let_go_at(armhole(STRAIGHT_AT + askew))
    assert (near + far) / 2 == pytest.approx(shift, abs=0.01)
    assert near - far == pytest.approx(WIDTH, abs=0.01)


def test_the_ends_of_the_neckline_are_drawn_low_along_the_bed_and_down_before_they_are_let_go_of():
    way_down = []
    let_go_at(armhole(STRAIGHT_AT), way_down=way_down)
    y, z = np.array(way_down)[:, SIDES.index("left")].T
    assert z[-1] < 0.75
    low = int(np.argmax(z < 0.84))
    assert y[low] - y[-1] == pytest.approx(0.10, abs=0.02)
    assert np.all(z[low:] < 0.84)


def test_one_whose_armhole_is_hidden_is_laid_as_it_is():
    near, far = let_go_at(PerceptionFailure(Problem.NOTHING_SEEN, "armhole"))
    assert (near + far) / 2 == pytest.approx(0.0, abs=0.01)


@pytest.mark.parametrize(("askew", "steps"), [(-0.05, 2), (0.0, 0)])
def test_a_taut_neckline_is_slackened_where_the_gown_was_askew(askew, steps):
    near, far = let_go_at(armhole(STRAIGHT_AT + askew), taut_until=WIDTH - 1.5 * NARROWING)
    assert near - far == pytest.approx(WIDTH - steps * NARROWING, abs=0.01)


def test_a_short_neckline_is_held_as_near_as_the_hand_beside_the_base_gets():
    near, far = let_go_at(armhole(STRAIGHT_AT), width=0.66)
    assert near == pytest.approx(0.35, abs=0.01)
    assert near - far == pytest.approx(0.66, abs=0.01)


def test_the_far_end_hangs_lower_until_the_gown_is_almost_down():
    way_down = []
    let_go_at(armhole(STRAIGHT_AT), way_down=way_down)
    near, far = np.moveaxis(np.array(way_down)[..., 1], 1, 0)
    lower = near - far
    assert np.max(lower[near > 1.2]) == pytest.approx(0.45, abs=0.02)
    assert np.all(np.abs(lower[near < 0.74]) < 0.02)
    assert np.min(lower) > -0.02


def test_the_neckline_is_never_held_farther_apart_than_it_is_long():
    way_down, across = [], []
    let_go_at(armhole(STRAIGHT_AT), way_down=way_down, across=across)
    apart = np.hypot(np.array(across), np.diff(np.array(way_down)[:, :, 1], axis=1)[:, 0])
    low = np.array(way_down)[:, :, 1].min(axis=1) < 0.9  # [m]: the far end hangs lower by then
    assert np.max(apart[low]) < WIDTH + 0.02
    assert np.min(np.array(across)[low]) < 0.75, "nearer across the bed meanwhile"


@pytest.mark.parametrize("stands", [HIDDEN, heading(0.05), heading(0.05, 0.04)])
def test_a_gown_whose_near_sleeve_stands_or_hides_is_laid_once(stands):
    way_down = []
    let_go_at(armhole(STRAIGHT_AT), way_down=way_down, stands=stands)
    assert lowerings(way_down) == 1


def test_one_whose_near_sleeve_is_tucked_in_is_drawn_over_the_bed_with_its_near_end_lower_and_behind_and_laid_again():
    way_down = []
    let_go_at(armhole(STRAIGHT_AT), way_down=way_down, stands=[heading(-0.02), heading(0.06)])
    assert lowerings(way_down) == 2
    near, far = np.moveaxis(np.array(way_down), 1, 0)
    deepest = int(np.argmax(far[:, 1] - near[:, 1]))
    assert far[deepest, 1] - near[deepest, 1] == pytest.approx(0.45, abs=0.02)
    assert near[deepest, 0] - far[deepest, 0] == pytest.approx(0.30, abs=0.02)


@pytest.mark.parametrize(
    ("stands", "lying"),
    [
        (HIDDEN, set()),
        ([heading(-0.02), heading(0.06)], set()),
        ([heading(-0.02), HIDDEN], {"right"}),
        (heading(-0.02), {"right"}),
        (heading(0.05, 0.09), {"right"}),  # folded over (131)
        ([heading(0.05, 0.09), heading(0.06)], set()),
    ],
)
def test_it_is_remembered_whether_the_near_sleeve_stands(stands, lying):
    skills = []
    let_go_at(armhole(STRAIGHT_AT), stands=stands, skills=skills)
    assert lying_sleeves(skills[0].context) == lying
    assert laid_here(skills[0].context)


def test_how_a_gown_lay_before_is_forgotten():
    skills = []
    let_go_at(armhole(STRAIGHT_AT), stands=HIDDEN, skills=skills, lying={"left", "right"})
    assert lying_sleeves(skills[0].context) == set()


def test_one_that_is_tucked_in_again_is_let_go_of():
    way_down = []
    let_go_at(armhole(STRAIGHT_AT), way_down=way_down, stands=heading(-0.02))
    assert lowerings(way_down) == 2


def lowerings(way_down):
    """How often both hands came down to the bed."""
    down = np.array(way_down)[..., 1].max(axis=1) < 0.75
    return int(down[0]) + int(np.count_nonzero(down[1:] & ~down[:-1]))
