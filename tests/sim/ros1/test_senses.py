"""What the robot measures is put at the time when it was measured."""

import threading
from unittest.mock import MagicMock

from caretree.sim.ros1.senses import Senses
from caretree.sim.ros1.site import DEFAULT, read_site


def test_a_state_that_comes_before_the_time_is_known_has_not_come(ros_here):
    """It was put at 0, where the simulated clock begins at 1000, and counted as stale."""
    site = read_site(DEFAULT)
    senses = Senses(MagicMock(), site, threading.Condition())
    senses._heard_state(MagicMock())
    assert site.state.topic in senses.missing()
    senses.now = lambda: 1000.0
    senses._heard_state(MagicMock())
    assert site.state.topic not in senses.missing()
