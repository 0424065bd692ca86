"""Every limit has its source, and limits do not contradict each other."""

from dataclasses import fields

import pytest
from caretree.trees.guard.limits import SOURCES, Limits


def test_every_limit_has_a_source_and_no_other():
    assert {item.name for item in fields(Limits)} == set(SOURCES)


def test_limits_that_contradict_are_refused():
    with pytest.raises(Exception, match=r"cloth_load_slow is 20 N, but must be below cloth_load_stop, 18.0 N"):
        Limits(cloth_load_slow=20)
    with pytest.raises(Exception, match="limit hand_speed is 0, but limits are above zero"):
        Limits(hand_speed=0)


def test_an_arm_is_lifted_at_the_speed_that_takes_the_whole_duration():
    assert Limits(lift_height=0.3, lift_duration=6.0).lift_speed == pytest.approx(0.05)  # [m/s]
