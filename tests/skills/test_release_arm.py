"""An arm is let go where the bed carries it; a hand that holds none opens at once."""

import numpy as np
import pytest
from caretree.sim.robot.kinematics import default_kinematics
from caretree.sim.robot.model import READY
from caretree.sim.world import GripperOpening, JointTrajectory
from caretree.skills.core.reasons import Reason
from caretree.skills.release_arm import ReleaseArm

from .bench import ARM, LeafBench, beside_bed, on_arm, pulls

LIFTED = 0.20  # [m] of the elbow above where it lies
MATTRESS = 0.60  # [m] above the floor


def bench(*, weight=15.0, rests_below=-np.inf, holds=ARM, slips_at=None, deaf_to=(), **options):
    """The left hand round a lifted arm, which hangs on it with `weight` [N] until the hand is below a height [m].

    The arm slips out of the fingers at a tick, if one is given; `options` are those of the leaf.
    """

    def carries(bench):
        if len(bench.seen) == slips_at:
            bench.world.between_fingers["left"] = 0.0
        height = bench.world.observe().pose_hand_in_map[0, 2, 3]
        pulls(bench.world, "left", (0.0, 0.0, -weight if height > rests_below else -1.0))

    run = LeafBench(
        lambda context: ReleaseArm("release", context, hand="left", **options),
        beside_bed(hands={"left": on_arm(1.0, LIFTED)}, held={"left": holds}, deaf_to=deaf_to),
        each_tick=carries,
    )
    run.context.guard.declare_grip("left", "arm")
    return run


def parted(run):
    """Number of ticks until the fingers part."""
    return int(np.argmax(run.openings("left") > run.openings("left")[0] + 0.002))


def test_an_arm_is_lowered_until_the_bed_carries_it_and_let_go_there():
    run = bench(lower=True, rests_below=0.80)
    assert run.ended() is None
    way, opens = run.way("left"), parted(run)
    assert way[opens, 2] == pytest.approx(0.80, abs=0.02)
    assert np.ptp(way[:opens, :2], axis=0) == pytest.approx((0.0, 0.0), abs=0.01), "straight down"
    assert np.diff(way[:opens, 2]).min() > -0.045 / 15  # [m] a tick, at 0.04 m/s
    assert run.openings("left")[-1] > 0.08, "the hand is open"
    assert way[-1, 2] - way[opens, 2] == pytest.approx(0.16, abs=0.03), "it is clear of the arm"


def test_an_arm_that_the_bed_never_carries_is_lowered_to_just_above_the_mattress():
    run = bench(lower=True)
    assert run.ended() is None
    assert run.way("left")[parted(run), 2] == pytest.approx(MATTRESS + 0.05, abs=0.02)


@pytest.mark.parametrize(("holds", "lower"), [(ARM, False), (0.0, True)], ids=("not asked to lower", "holds nothing"))
def test_it_opens_at_once_where_nothing_is_to_be_lowered(holds, lower):
    run = bench(lower=lower, holds=holds)
    start = run.world.observe().pose_hand_in_map[0, 2, 3]
    assert run.ended() is None
    assert parted(run) <= 2
    assert run.way("left")[:, 2].min() == pytest.approx(start, abs=0.002)
    assert run.openings("left")[-1] > 0.08


def test_one_that_is_to_be_ready_ends_in_the_ready_posture():
    run = bench(ready="always")
    assert run.ended() is None
    ready = default_kinematics().pose_hand_in_map("left", READY[0], run.world.observe().pose_base_in_map)
    assert run.way("left")[-1] == pytest.approx(ready[:3, 3], abs=0.03)
    stays = bench(ready="never")
    assert stays.ended() is None
    assert np.linalg.norm(stays.way("left")[-1] - ready[:3, 3]) > 0.1


@pytest.mark.parametrize(("ready", "reason"), [("always", Reason.COMMAND_LOST), ("if possible", None)])
def test_a_hand_that_does_not_get_ready_is_a_failure_only_where_it_has_to(ready, reason):
    run = bench(ready=ready, deaf_to=(JointTrajectory,))
    assert run.ended() == reason
    assert run.openings("left")[-1] > 0.08


def test_fingers_that_do_not_open_are_told():
    assert bench(deaf_to=(GripperOpening,)).ended() == Reason.COMMAND_LOST


def test_an_arm_that_slips_out_on_the_way_down_is_lowered_no_farther():
    run = bench(lower=True, slips_at=30)
    assert run.ended() is None
    way = run.way("left")[:, 2]
    assert 0.05 < way[0] - way.min() < 0.11  # [m]: 2 s at 0.04 m/s, and the time until the fingers have closed
