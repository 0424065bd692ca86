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


def patient_bench(dead, until):
    """A robot that waits for all cameras, of which one gives no image `until` a time [s]."""
    wait = {"seconds": 0.0, "all_cameras": True, "patience": 30.0}
    run = LeafBench(lambda context: HoldStill("wait", context, **wait), beside_bed())
    look, begins = run.world.look, run.world.clock.now()

    def dead_at_first(camera):
        if camera == dead and run.world.clock.now() < begins + until:
            raise SensorLost("the camera is dead")
        return look(camera)

    run.world.look = dead_at_first
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


@pytest.mark.parametrize("camera", ["head", "left_hand", "right_hand"])
def test_with_patience_it_goes_on_as_soon_as_every_camera_shows(camera):
    run = patient_bench(camera, until=20.0)
    assert run.ended() is None
    assert run.seen[-1].time - run.start.time == pytest.approx(20.0, abs=0.15)  # [s]
    assert run.sent == 0


def test_with_patience_a_camera_that_shows_ends_it_at_once():
    run = patient_bench("head", until=0.0)
    assert run.ended() is None
    assert len(run.seen) == 1


def test_a_camera_that_stays_dead_ends_its_patience():
    run = patient_bench("head", until=1000.0)
    assert run.ended() == Reason.SENSOR_LOST
    assert run.seen[-1].time - run.start.time == pytest.approx(30.0, abs=0.15)  # [s]
