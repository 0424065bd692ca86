"""The middle between the shoulders, from arms that were seen once, and the collar from close by."""

import numpy as np
import pytest
from caretree.perception.estimates import GraspPoint
from caretree.skills.belief.close_look import CloseLook, close_look
from caretree.skills.belief.shoulders import CollarSeen, between_shoulders, look_at_collar, off_middle
from caretree.skills.scripted.scripted_person import lying_posture
from caretree.trees.tasks.dressing.check_collar import CheckCollar

from ..bench import LeafBench, beside_bed

MIDDLE = np.mean([lying_posture(side).points_in_map[0] for side in ("left", "right")], axis=0)  # [m]


def test_arms_that_are_not_known_are_looked_for_and_then_remembered():
    looks = []

    def arm(frame, side, **_):
        looks.append(side)
        return lying_posture(side)

    skill = LeafBench(lambda context: CheckCollar("lies well", context), beside_bed(arm=arm)).skill
    skill.initialise()
    assert between_shoulders(skill) == pytest.approx(MIDDLE, abs=1e-6)
    seen = len(looks)
    assert {"left", "right"} <= set(looks)
    assert between_shoulders(skill) == pytest.approx(MIDDLE, abs=1e-6)
    assert len(looks) == seen


def test_aside_is_to_the_right_of_the_bed_less_what_is_seen_too_much_and_headward_away_from_the_feet():
    assert off_middle(MIDDLE + (0.1, -0.2, 0.3), MIDDLE, CollarSeen(aside=0.02)) == pytest.approx((0.08, 0.2))


def collar(x, stamp=1.0):
    return GraspPoint(
        stamp=stamp,
        confidence=0.9,
        target="collar_middle",
        position_in_map=np.array((x, -0.5, 0.8)),
        approach_in_map=np.array((0.0, 0.0, -1.0)),
        closing_in_map=np.array((0.0, 1.0, 0.0)),
    )


def looking(asked):
    """A skill whose head camera sees the collar at x = 0.3 m, and keeps what it was asked for."""

    def seen(frame, near_in_map, away):
        asked.append(away)
        return collar(0.3 + away[0])

    arm = {"arm": lambda frame, side, **_: lying_posture(side)}
    skill = LeafBench(lambda context: CheckCollar("lies", context), beside_bed(collar_middle=seen, **arm)).skill
    skill.initialise()
    return skill


def test_a_close_look_tells_where_the_collar_lies_and_the_head_only_what_lies_beside_it():
    asked = []
    skill = looking(asked)
    assert look_at_collar(skill, MIDDLE).position_in_map[0] == pytest.approx(0.3)
    CloseLook.of(skill).seen = collar(0.1, stamp=skill.now())
    assert look_at_collar(skill, MIDDLE).position_in_map[0] == pytest.approx(0.1)
    assert look_at_collar(skill, MIDDLE, (0.05, 0.0)).position_in_map[0] == pytest.approx(0.15)
    assert asked[-1] == pytest.approx((-0.15, 0.0))


@pytest.mark.parametrize(("age", "known"), [(59.0, True), (61.0, False)])
def test_a_close_look_grows_old(age, known):
    skill = looking([])
    CloseLook.of(skill).seen = collar(0.1, stamp=skill.now() - age)
    assert (close_look(skill) is not None) == known
