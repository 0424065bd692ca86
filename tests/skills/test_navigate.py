"""The base drives round what is in the way; the arms come into their posture on the way."""

import numpy as np
import pytest
from caretree.sim.robot.model import READY
from caretree.sim.world import BaseVelocity, JointTrajectory
from caretree.skills.core.reasons import Reason
from caretree.skills.navigate import Navigate

from .bench import LeafBench, beside_bed

AWAY, FARTHER = (2.2, -0.6, np.pi), (2.7, -1.6, np.pi)  # from the bed [m, m, rad]
BED = (0.5, 1.0)  # half of its width and length about the middle of the map [m]


def bench(goal="bed_left", start=(1.25, -0.25, np.pi), deaf_to=(), **options):
    """A robot on the right side of the bed, for a drive to `goal`."""
    return LeafBench(
        lambda context: Navigate("navigate", context, goal=goal, **options),
        beside_bed(stand=start, deaf_to=deaf_to),
    )


def bases(run):
    """Base poses (n, 3) after each tick [m, m, rad]."""
    return np.array([seen.pose_base_in_map for seen in run.seen])


def test_it_drives_round_the_bed_to_a_place_of_the_map():
    run = bench()
    assert run.ended() is None
    way = bases(run)
    assert way[-1, :2] == pytest.approx((-1.25, -0.25), abs=0.03)
    assert abs((way[-1, 2] + np.pi) % (2 * np.pi) - np.pi) < 0.05  # [rad]: it faces the bed from the other side
    inside = (np.abs(way[:, 0]) < BED[0] + 0.2) & (np.abs(way[:, 1]) < BED[1] + 0.2)
    assert not inside.any(), "the base stays clear of the bed"


def test_it_drives_to_a_pose_no_faster_than_it_is_told():
    run = bench(goal=np.array((2.7, -1.5, 1.57)), speed=0.2)
    assert run.ended() is None
    way = bases(run)
    assert way[-1] == pytest.approx((2.7, -1.5, 1.57), abs=0.05)
    assert np.linalg.norm(np.diff(way[:, :2], axis=0), axis=1).max() <= 0.2 / 15 + 0.001  # [m] a tick


def test_the_arms_are_in_their_posture_at_the_end_and_stay_without_one():
    bent = READY.copy()
    bent[:, 3] -= 0.4  # [rad]
    run = bench(start=AWAY, goal=np.array(FARTHER), arms=bent)
    assert run.ended() is None
    assert run.seen[-1].arm_positions == pytest.approx(bent, abs=0.05)
    away = np.linalg.norm(bases(run)[:, :2] - AWAY[:2], axis=1)
    moving = int(np.argmax(np.abs(np.array([seen.arm_positions[1, 3] for seen in run.seen]) - READY[1, 3]) > 0.1))
    assert away[moving] < 0.5 * away[-1], "they move while it drives"
    without = bench(start=AWAY, goal=np.array(FARTHER))
    assert without.ended() is None
    assert without.seen[-1].arm_positions == pytest.approx(READY, abs=0.01)


@pytest.mark.parametrize("goal", ["the kitchen", np.array((0.0, 0.0, 0.0))], ids=("no such place", "in the bed"))
def test_where_there_is_no_way_it_stays(goal):
    run = bench(goal=goal)
    assert run.ended() == Reason.PATH_BLOCKED
    assert bases(run)[-1] == pytest.approx((1.25, -0.25, np.pi), abs=0.01)


@pytest.mark.parametrize("deaf_to", [BaseVelocity, JointTrajectory])
def test_a_base_or_an_arm_that_does_not_move_is_told(deaf_to):
    bent = READY.copy()
    bent[:, 3] -= 0.4  # [rad]
    run = bench(start=AWAY, goal=np.array(FARTHER), deaf_to=(deaf_to,), arms=bent)
    assert run.ended() == Reason.COMMAND_LOST
