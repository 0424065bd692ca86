"""What is too old, or no number, is lost."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.sim.freshness import AHEAD, NUMBERS, fresh_frame, fresh_observation
from caretree.sim.observation_form import ObservationForm
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.scripted.world import ScriptedWorld
from caretree.sim.world import SensorLost, SensorStale

FORM = ObservationForm(BAXTER)


@pytest.fixture
def world():
    world = ScriptedWorld(seed=100)
    world.clock.wait_until(2.0)
    return world


def test_what_is_new_passes_as_it_is(world):
    seen, frame = world.observe(), world.look("head")
    assert fresh_observation(seen, 2.5, 0.5, FORM) is seen
    assert fresh_frame(frame, 3.0, 1.0) is frame


def test_what_is_old_is_lost_with_its_age(world):
    with pytest.raises(SensorStale, match=r"no new joint state for 0\.7 s"):
        fresh_observation(world.observe(), 2.7, 0.5, FORM)
    with pytest.raises(SensorStale, match=r"the left_hand image is 1\.2 s old"):
        fresh_frame(world.look("left_hand"), 3.2, 1.0)
    assert issubclass(SensorStale, SensorLost)


@pytest.mark.parametrize("name", NUMBERS)
def test_no_field_may_hold_what_is_no_number(world, name):
    seen = world.observe()
    bad = np.array(getattr(seen, name), float)
    bad.flat[-1] = np.nan
    bad = bad if bad.shape else float(bad)
    with pytest.raises(SensorLost, match=f"{name} of the joint state holds a number that is not finite"):
        fresh_observation(replace(seen, **{name: bad}), 2.0, 0.5, FORM)


def test_no_time_is_no_new_time(world):
    with pytest.raises(SensorLost, match="no time"):
        fresh_observation(replace(world.observe(), time=np.nan), 2.0, 0.5, FORM)
    frame = world.look("head")
    for broken in (replace(frame, stamp=np.nan), replace(frame, pose_camera_in_map=np.full((4, 4), np.inf))):
        with pytest.raises(SensorLost, match="the head image has no time or no place"):
            fresh_frame(broken, 2.0, 1.0)


def test_what_was_measured_in_the_future_is_lost(world):
    with pytest.raises(SensorLost, match=r"the time of the joint state is 1\.5 s ahead of the clock"):
        fresh_observation(replace(world.observe(), time=3.5), 2.0, 0.5, FORM)
    with pytest.raises(SensorLost, match=r"the time of the head image is 1\.5 s ahead of the clock"):
        fresh_frame(replace(world.look("head"), stamp=3.5), 2.0, 1.0)
    seen = replace(world.observe(), time=2.0 + 0.5 * AHEAD)
    assert fresh_observation(seen, 2.0, 0.5, FORM) is seen, "clocks of two computers differ a little"


def test_texts_are_no_numbers(world):
    with pytest.raises(SensorLost, match="arm_efforts of the joint state holds what is no number"):
        fresh_observation(replace(world.observe(), arm_efforts=np.full((2, 7), "1.0")), 2.0, 0.5, FORM)
