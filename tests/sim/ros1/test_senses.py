"""What the robot measures is put at the time when it was measured."""

import threading
from types import SimpleNamespace
from unittest.mock import MagicMock

import numpy as np
import pytest
from caretree.sim.ros1.senses import UNSTAMPED, Sample, Senses
from caretree.sim.ros1.site import DEFAULT, read_site
from caretree.sim.world import SIDES


def test_a_state_that_comes_before_the_time_is_known_has_not_come(ros_here):
    """It was put at 0, where the simulated clock begins at 1000, and counted as stale."""
    site = read_site(DEFAULT)
    senses = Senses(MagicMock(), site, threading.Condition())
    senses._heard_state(MagicMock())
    assert site.state.topic in senses.missing()
    senses.now = lambda: 1000.0
    senses._heard_state(MagicMock())
    assert site.state.topic not in senses.missing()


@pytest.fixture
def senses(ros_here):
    """Everything but the state has been measured at 1001 s."""
    senses = Senses(MagicMock(), read_site(DEFAULT), threading.Condition())
    senses.measured = 1001.0
    senses._odometry.append(Sample(1001.0, None))
    for side in SIDES:
        senses._fingers[side] = senses._wrenches[side] = Sample(1001.0, None)
    return senses


def test_nothing_is_complete_without_the_state_and_a_late_one_is_waited_for(senses):
    """Time went on without it, to where the observation that it is a part of counted as stale."""
    assert senses.complete == -np.inf
    senses.now = lambda: 1000.5
    senses._heard_state(SimpleNamespace())
    assert senses.complete == 1000.5 + UNSTAMPED
    senses.now = lambda: 1000.9
    senses._heard_state(SimpleNamespace())
    assert senses.complete == 1001.0
    senses._wrenches["left"] = Sample(1000.6, None)
    assert senses.complete == 1000.6
