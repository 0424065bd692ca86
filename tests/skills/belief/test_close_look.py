"""What was seen closely is known until a hand comes down to the gown, or for a while."""

import numpy as np
import pytest
from caretree.perception.estimates import GraspPoint
from caretree.skills.belief.close_look import CLOSE_LOOK, CloseLook, SleeveSeen, close_look, sleeve_seen
from caretree.skills.check_sleeve import CheckSleeve

from ..bench import LeafBench, beside_bed


@pytest.fixture
def skill():
    return LeafBench(lambda context: CheckSleeve("sits", context, side="left"), beside_bed()).skill


def collar(stamp):
    down = np.array((0.0, 0.0, -1.0))
    return GraspPoint(
        stamp=stamp,
        confidence=0.9,
        target="collar_middle",
        position_in_map=np.zeros(3),
        approach_in_map=down,
        closing_in_map=np.array((0.0, 1.0, 0.0)),
    )


def test_nothing_is_known_before_a_look(skill):
    assert close_look(skill) is None
    assert sleeve_seen(skill, "left") is None


def test_a_sleeve_is_known_for_a_while(skill):
    now = skill.now()
    CloseLook.of(skill).sleeves["left"] = SleeveSeen(0.8, 0.9, now - 0.9 * CLOSE_LOOK.sleeves_last)
    assert sleeve_seen(skill, "left").reach == 0.8
    assert sleeve_seen(skill, "right") is None
    CloseLook.of(skill).sleeves["left"] = SleeveSeen(0.8, 0.9, now - 1.1 * CLOSE_LOOK.sleeves_last)
    assert sleeve_seen(skill, "left") is None


def test_nothing_is_known_once_the_gown_is_touched(skill):
    known = CloseLook.of(skill)
    known.seen, known.sleeves["left"] = collar(skill.now()), SleeveSeen(0.8, 0.9, skill.now())
    known.forget()
    assert close_look(skill) is None
    assert sleeve_seen(skill, "left") is None
