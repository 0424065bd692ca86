import numpy as np
import pytest
from caretree.sim.world import BaseVelocity
from caretree.skills.control.base import drive_to, stand_for, waypoint
from caretree.skills.core.reasons import Reason
from caretree.skills.motion.errors import PathBlocked

from ..moving import carry_out, idle, robot


def test_it_drives_round_the_bed_to_a_waypoint():
    world, context = robot(base=(2.0, 0.0, np.pi))
    seen = []
    skill = carry_out(
        world,
        context,
        lambda skill: drive_to(skill, "bed_left"),
        each_tick=lambda skill: seen.append(world.observe().pose_base_in_map[:2]),
    )
    assert skill.failure is None
    np.testing.assert_allclose(world.observe().pose_base_in_map[:2], (-1.2, 0.0), atol=0.03)
    assert abs(np.sin(world.observe().pose_base_in_map[2])) < 0.05
    assert not any(abs(x) < 0.45 and abs(y) < 1.0 for x, y in seen), "not through the bed"


def test_a_straight_way_is_straight():
    world, context = robot(base=(2.5, -2.5, 0.0))
    seen = []
    carry_out(
        world,
        context,
        lambda skill: drive_to(skill, np.array((2.5, -1.5, 0.0)), straight=True, speed=0.2),
        each_tick=lambda skill: seen.append(world.observe().pose_base_in_map[:2]),
    )
    assert np.ptp(np.array(seen)[:, 0]) < 1e-6
    assert np.abs(np.diff(seen, axis=0)).max() * 15 < 0.21


def test_a_straight_way_can_go_by_places_without_a_stop():
    world, context = robot(base=(2.5, -2.5, 0.0))
    seen = []
    carry_out(
        world,
        context,
        lambda skill: drive_to(
            skill, np.array((2.5, -1.5, 0.0)), straight=True, via=[np.array((2.2, -2.0))], speed=0.2
        ),
        each_tick=lambda skill: seen.append(world.observe().pose_base_in_map[:2]),
    )
    assert np.linalg.norm(np.array(seen) - (2.2, -2.0), axis=1).min() < 0.08, "a corner is rounded by a few cm [m]"
    corner = np.argmin(np.linalg.norm(np.array(seen) - (2.2, -2.0), axis=1))
    assert np.linalg.norm(seen[corner + 3] - seen[corner - 3]) > 0.03, "without a stop"
    np.testing.assert_allclose(seen[-1], (2.5, -1.5), atol=0.03)


def test_an_unknown_waypoint_is_told_with_the_known_ones():
    _, context = robot()
    with pytest.raises(PathBlocked, match=r"kitchen.*bed_right"):
        waypoint(idle(context), "kitchen")


def test_a_base_that_does_not_obey_is_told_soon():
    world, context = robot(deaf_to=BaseVelocity)
    skill = carry_out(world, context, lambda skill: drive_to(skill, "rail"))
    assert skill.failure.reason == Reason.COMMAND_LOST
    assert world.clock.now() < 3.0


@pytest.mark.parametrize(("side", "aside"), [("left", 0.22), ("right", -0.22)])
def test_it_stands_where_a_hand_works_with_ease(side, aside):
    world, context = robot(base=(2.5, -2.5, np.pi / 2))
    point = np.array((2.6, -0.5, 1.0))
    skill = carry_out(world, context, lambda skill: stand_for(skill, side, point))
    assert skill.failure is None
    x, y, yaw = world.observe().pose_base_in_map
    assert yaw == pytest.approx(np.pi / 2, abs=0.03)
    np.testing.assert_allclose((point[1] - y, x - point[0]), (0.95, aside), atol=0.04)
    before = len(world.sent)
    carry_out(world, context, lambda skill: stand_for(skill, side, point))
    assert len(world.sent) == before, "it is there already"


@pytest.mark.parametrize("grip", ["nothing", "cloth"])
def test_stopped_beside_the_person_a_base_with_empty_hands_goes_back_and_round(grip):
    world, context = robot(base=(1.2, -0.9, np.pi))
    hand = world.observe().pose_hand_in_map[0, :3, 3]
    arm = np.array((hand + (-0.5, 0.45, 0.0), hand + (0.05, 0.45, 0.0)))
    context.guard.update_person(arm, part="right arm", radius=0.04)
    context.guard.declare_grip("left", grip)
    seen = []
    skill = carry_out(
        world,
        context,
        lambda skill: drive_to(skill, np.array((1.2, 0.3, np.pi))),
        each_tick=lambda skill: seen.append(world.observe().pose_base_in_map[:2]),
    )
    if grip == "nothing":
        assert skill.failure is None
        assert np.max(seen, axis=0)[0] > 1.5, "wide enough for the hands"
    else:
        assert skill.failure.reason == Reason.COMMAND_LOST
        assert np.max(seen, axis=0)[0] < 1.22, "whatever it holds stays where it is"
