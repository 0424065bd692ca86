"""Standing still and watching for a while."""

import pytest
from caretree.sim.world import SensorLost
from caretree.skills.core.reasons import Reason
from caretree.skills.hold_still import HoldStill

from .hung_gown import bench_with, ended


def bench():
    run = bench_with(lambda context: HoldStill("watch", context, seconds=2.0))
    run.looks, look = [], run.world.look

    def noted(camera):
        run.looks.append(run.world.clock.now())
        if run.blind_from is not None and run.looks[-1] > run.blind_from:
            raise SensorLost("the camera is dead")
        return look(camera)

    run.world.look, run.blind_from = noted, None
    return run


def test_watches_as_long_as_it_was_asked_to_and_commands_nothing():
    run = bench()
    assert ended(run) is None
    assert run.world.clock.now() == pytest.approx(2.0, abs=0.15)  # [s]
    assert len(run.looks) == pytest.approx(30, abs=1)  # once per tick, 15 times a second
    assert run.sent == 0


def test_gives_up_when_the_camera_does():
    run = bench()
    run.blind_from = 1.0  # [s]
    assert ended(run) == Reason.SENSOR_LOST
    assert run.world.clock.now() < 1.3
