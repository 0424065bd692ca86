"""What was taken from a table stands there again, and the hand is open above it."""

import numpy as np
import pytest
from caretree.skills.core.reasons import Reason
from caretree.trees.tasks.wipe_forearm.put_back import PutBack

from ....skills.hung_gown import DOWN, at, bench_with, ended, seen_at

PLACE = at(0.95, -0.2, 0.75)
FAR = at(1.6, -0.2, 0.75)


@pytest.mark.parametrize("place", [PLACE, FAR])
def test_it_is_let_go_of_where_it_was_taken(place):
    opened = []
    run = bench_with(lambda context: PutBack("put back", context, hand="right", grasp=seen_at(place, approach=DOWN)))
    send = run.world.send

    def watched(command):
        if getattr(command, "opening", 0.0) > 0.05:
            opened.append(run.world.hand("right")[:3, 3].copy())
        return send(command)

    run.world.send = watched
    assert ended(run) is None
    assert opened[0] == pytest.approx(place, abs=0.025)  # [m]: fingertips go a little beyond
    assert run.world.hand("right")[2, 3] > place[2] + 0.08


def test_a_place_too_high_to_reach_is_told():
    run = bench_with(
        lambda context: PutBack("put back", context, hand="right", grasp=seen_at(at(0.95, -0.2, 2.6), approach=DOWN))
    )
    assert ended(run) == Reason.UNREACHABLE


def test_it_is_let_go_of_where_it_stands_already():
    run = bench_with(
        lambda context: PutBack("put back", context, hand="right", grasp=seen_at(PLACE, approach=DOWN)),
        pull=lambda side, hand: np.array((0.0, 0.0, 3.0 if hand[2] < PLACE[2] + 0.03 else -1.0)),
    )
    assert ended(run) is None
    assert run.world.hand("right")[2, 3] > PLACE[2] + 0.08
