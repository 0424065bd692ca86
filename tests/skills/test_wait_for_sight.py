"""The robot waits until all cameras show again, and gives up in the end."""

import pytest
from caretree.sim.world import SensorLost
from caretree.skills.core.reasons import Reason
from caretree.skills.wait_for_sight import WaitForSight, WaitForSightTuning

from .bench import LeafBench, beside_bed

PATIENCE = WaitForSightTuning().patience


def bench(dead, until):
    """A robot of which one camera gives no image `until` a time [s]."""
    run = LeafBench(lambda context: WaitForSight("wait", context), beside_bed())
    look, begins = run.world.look, run.world.clock.now()

    def dead_at_first(camera):
        if camera == dead and run.world.clock.now() < begins + until:
            raise SensorLost("the camera is dead")
        return look(camera)

    run.world.look = dead_at_first
    return run


@pytest.mark.parametrize("camera", ["head", "left_hand", "right_hand"])
def test_it_goes_on_as_soon_as_every_camera_shows_and_moves_nothing(camera):
    run = bench(camera, until=20.0)
    assert run.ended() is None
    assert run.seen[-1].time - run.start.time == pytest.approx(20.0, abs=0.15)  # [s]
    assert run.sent == 0


def test_a_camera_that_stays_dead_ends_it():
    run = bench("head", until=1000.0)
    assert run.ended() == Reason.SENSOR_LOST
    assert run.seen[-1].time - run.start.time == pytest.approx(PATIENCE, abs=0.15)  # [s]
