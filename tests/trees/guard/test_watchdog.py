"""Senses that stand still are dead."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.sim.scripted.world import ScriptedWorld
from caretree.skills.core.reasons import Reason
from caretree.trees.guard.limits import Limits
from caretree.trees.guard.watchdog import Watchdog

LIMITS = Limits(stale_after=0.5, frozen_after=1.0, frame_stale_after=1.0, frozen_frames=3)  # [s], [s], [s], frames


@pytest.fixture
def seen():
    return ScriptedWorld().observe()


def test_live_senses_are_well(seen):
    dog = Watchdog(LIMITS)
    for time in np.arange(0.0, 3.0, 0.1):
        dog.sample(replace(seen, time=time, wrench_hand_in_map=np.full((2, 6), time)), time)
        assert dog.judge(time) is None


def test_samples_that_stop_coming_are_noticed(seen):
    dog = Watchdog(LIMITS)
    dog.sample(replace(seen, time=2.0), 2.0)
    assert dog.judge(2.4) is None
    dog.sample(replace(seen, time=2.0), 2.5)  # the same one once more
    verdict = dog.judge(2.6)
    assert verdict.reason == Reason.SENSOR_STALE
    assert "joint state" in verdict.detail


def test_nothing_at_all_counts_from_the_first_question():
    dog = Watchdog(LIMITS)
    assert dog.judge(10.0) is None
    assert dog.judge(10.6).reason == Reason.SENSOR_STALE


def test_one_hand_whose_force_repeats_every_bit_is_named(seen):
    dog = Watchdog(LIMITS)
    for time in np.arange(0.0, 1.25, 0.1):
        dog.sample(replace(seen, time=time, wrench_hand_in_map=np.array(([time] * 6, [1.0] * 6))), time)
    assert "right wrench" in dog.judge(1.25).detail


def test_frozen_images_are_noticed_each_camera_on_its_own():
    world, dog = ScriptedWorld(), Watchdog(LIMITS)
    frame = world.look("head")
    for stamp in (1.0, 2.0, 3.0):
        assert dog.frame(replace(frame, stamp=stamp)) == ""
    assert dog.frame(replace(frame, camera="left_hand", stamp=4.0)) == ""
    assert "the head image has not varied in 3 frames" in dog.frame(replace(frame, stamp=4.0))
    assert dog.frame(replace(world.look("head"), stamp=5.0)) == "", "noise is back"
