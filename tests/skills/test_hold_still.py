"""The robot stands, looks on every tick, and gives up when its camera does."""

import pytest
from caretree.sim.world import SensorLost
from caretree.skills.core.reasons import Reason
from caretree.skills.hold_still import HoldStill

from .bench import LeafBench, beside_bed


def bench(seconds, dies_at=None):
    """A robot that stands; its camera may die at a tick."""
    run = LeafBench(lambda context: HoldStill("hold", context, seconds=seconds), beside_bed())
    look, run.cameras = run.world.look, []

    def watched(camera):
        run.cameras.append(camera)
        if dies_at is not None and len(run.cameras) > dies_at:
            raise SensorLost("the camera is dead")
        return look(camera)

    run.world.look = watched
    return run


def test_it_looks_once_a_tick_for_as_long_as_it_is_told_and_commands_nothing():
    run = bench(2.0)
    assert run.ended() is None
    assert run.seen[-1].time - run.start.time == pytest.approx(2.0, abs=0.15)  # [s]
    assert run.cameras == ["head"] * (len(run.seen) - 1)
    assert run.sent == 0


def test_a_camera_that_dies_ends_it():
    run = bench(2.0, dies_at=10)
    assert run.ended() == Reason.SENSOR_LOST
    assert len(run.seen) == 11
