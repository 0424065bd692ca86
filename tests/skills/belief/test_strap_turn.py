"""A strap is turned about the vertical by what the run remembers of the hand that holds it."""

import numpy as np
import pytest
from caretree.skills.belief.strap_turn import strap_turns, turned_strap
from caretree.skills.geometry.strap_grip import presenting

from ..bench import GRIP
from ..moving import idle, robot

ALONG, PLACE = np.array((0.6, 0.8, 0.0)), np.array((0.4, 0.3, 0.9))


def level(direction):
    return np.arctan2(direction[1], direction[0])


@pytest.mark.parametrize("degrees", [0.0, 35.0, 110.0, -80.0])
def test_the_hand_turns_by_the_angle_as_seen_from_above(degrees):
    skill = idle(robot()[1])
    strap_turns(skill)[GRIP.hand] = np.deg2rad(degrees)
    straight, turned = (presenting(grip, ALONG, PLACE, lean=0.0) for grip in (GRIP, turned_strap(skill, GRIP)))
    for axis in (0, 1):
        by = level(turned[:, axis]) - level(straight[:, axis])
        assert (by - np.deg2rad(degrees) + np.pi) % (2 * np.pi) - np.pi == pytest.approx(0.0, abs=1e-9)
    np.testing.assert_allclose(turned[:3, 2:], straight[:3, 2:], atol=1e-12)


def test_the_other_hand_holds_its_strap_as_it_was():
    skill = idle(robot()[1])
    strap_turns(skill)["left" if GRIP.hand == "right" else "right"] = 1.0
    np.testing.assert_array_equal(turned_strap(skill, GRIP).across_in_hand, GRIP.across_in_hand)
