"""The gown is lifted off its hook by both ends of the neckline and carried away from the rail."""

import numpy as np
import pytest
from caretree.sim.world import SIDES
from caretree.skills.core.reasons import Reason
from caretree.skills.take_down import TakeDown

from .hung_gown import DOWN, STAND, at, bench_with, ended, hand_from_base, holding, seen_at

AHEAD, UP = 0.75, 1.40  # of the hook, from the middle of the base [m]
HOOK = at(AHEAD, 0.0, UP)
ARMS = holding(left=HOOK + (0.0, 0.3, -0.2), right=HOOK + (0.0, -0.3, -0.2))


def bench(weight):
    """Both hands hold an end; `weight(side, height)` is what it carries at a height above the hook [N], [m]."""
    return bench_with(
        lambda context: TakeDown("lift", context, hook=seen_at(HOOK)),
        arms=ARMS,
        pull=lambda side, hand: weight(side, hand[2] - HOOK[2]) * DOWN,
    )


def light_gown(side, height):
    """Off the hook as soon as both hands are above it."""
    return 0.5 if height < 0.0 else 2.0


def test_drives_back_with_the_whole_gown():
    run = bench(light_gown)
    assert ended(run) is None
    assert run.world.observe().pose_base_in_map == pytest.approx(STAND - (0.30, 0.0, 0.0), abs=0.03)
    assert run.skill.load == pytest.approx(4.0, abs=0.1)  # [N]: 2 on each hand


def test_both_hands_rise_on_arcs_about_the_hook():
    run = bench(light_gown)
    places = {side: [] for side in SIDES}

    def note_places():
        if np.allclose(run.world.observe().pose_base_in_map, STAND):
            for side in SIDES:
                places[side].append(hand_from_base(run.world, side) - (AHEAD, 0.0, UP))

    assert ended(run, each_tick=note_places) is None
    for side, sign in (("left", 1.0), ("right", -1.0)):
        place = np.array(places[side])
        assert place[0, 2] < -0.15 < 0.03 < place[-1, 2]  # [m]: from below the hook to above it
        assert (sign * place[:, 1] > 0.2).all()  # [m]: each on its own side
        distance = np.linalg.norm(place, axis=1)
        assert distance.max() < 0.37  # [m]: the strips are 0.36 m long; they are not stretched
        assert distance[len(distance) // 2 :].min() > 0.31  # [m]: nor dropped


def test_a_heavier_gown_is_lifted_higher():
    def highest(weight):
        run = bench(weight)
        assert ended(run) is None
        return hand_from_base(run.world, "left")[2] - UP

    assert highest(light_gown) < 0.14  # [m]
    assert highest(lambda side, height: 0.5 if height < 0.13 else 2.0) > 0.19  # [m]


@pytest.mark.parametrize(
    "weights",
    [{"left": 1.0, "right": 1.0}, {"left": 4.0, "right": 0.2}],  # [N]
    ids=["too little on both", "nothing on one"],
)
def test_hands_that_carry_too_little_have_missed_it(weights):
    assert ended(bench(lambda side, height: weights[side])) == Reason.GRASP_MISSED
