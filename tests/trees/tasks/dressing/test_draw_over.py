"""A gown that lies to one side is taken on the chest by both hands, lifted, and carried over."""

import dataclasses

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.estimates import Estimate, GraspPoint
from caretree.sim.world import SIDES
from caretree.skills.belief.close_look import CloseLook
from caretree.skills.belief.shoulders import COLLAR_SEEN
from caretree.skills.core.reasons import Reason
from caretree.skills.geometry.stances import stance_at_head
from caretree.skills.scripted.scripted_person import lying_posture
from caretree.trees.tasks.dressing.draw_over import DrawOver

from ....skills.bench import LeafBench, beside_bed

MIDDLE = np.mean([lying_posture(side).points_in_map[0] for side in SIDES], axis=0)  # of the shoulders [m]
HEIGHT = 0.83  # of the chest [m]
HIDDEN = PerceptionFailure(Problem.NOTHING_SEEN, "cloth")
HELD = Estimate(stamp=0.0, confidence=0.9)


def bench(aside, *, cloth=HELD, shown=0.9, bare=()):
    """The collar `aside` [m], of which a share is `shown`, over a chest with `bare` sides."""

    def collar(frame, *, near_in_map, away=(0.0, 0.0)):
        x = aside + COLLAR_SEEN.aside + away[0]
        if any(away) and ("left" if x < 0.0 else "right") in bare:
            raise HIDDEN
        return GraspPoint(
            stamp=0.0,
            confidence=shown,
            target="collar_middle",
            position_in_map=np.append(MIDDLE[:2] + (aside + COLLAR_SEEN.aside, -0.05) + np.asarray(away), HEIGHT),
            approach_in_map=np.array((0.0, 0.0, -1.0)),
            closing_in_map=np.array((0.0, 1.0, 0.0)),
        )

    return LeafBench(
        lambda context: DrawOver("draw over", context),
        beside_bed(
            stand=stance_at_head(),
            collar_middle=collar,
            gripped_cloth=cloth,
            arm=lambda frame, side, **_: lying_posture(side),
        ),
    )


def held(run, side):
    """Positions (n, 3) of a hand while its fingers were closed [m]."""
    return run.way(side)[run.openings(side) < 0.005]


@pytest.mark.parametrize(("aside", "way"), [(0.06, -0.11), (0.12, -0.17), (0.20, -0.17), (-0.07, 0.12)])
def test_it_is_carried_over_from_the_side_where_the_collar_lies(aside, way):
    run = bench(aside)
    assert run.ended() is None
    for side in SIDES:
        path = held(run, side)
        assert path[-1, 0] - path[0, 0] == pytest.approx(way, abs=0.03)
        assert path[:, 2].max() - path[0, 2] == pytest.approx(0.10, abs=0.02), "above the body"
        assert path[-1, 2] - path[0, 2] == pytest.approx(0.02, abs=0.02), "laid down"
        assert path[0, 1] > MIDDLE[1] + 0.08, "on the chest"
        assert run.openings(side)[-1] > 0.03
        assert run.way(side)[-1, 2] > path[-1, 2] + 0.08, "drawn back"
    assert np.linalg.norm(held(run, "left")[0] - held(run, "right")[0]) > 0.2  # [m]


@pytest.mark.parametrize(("aside", "shown"), [(0.03, 0.9), (-0.04, 0.9), (0.15, 0.65)])
def test_one_that_lies_in_the_middle_or_hardly_shows_is_left_alone(aside, shown):
    run = bench(aside, shown=shown)
    assert run.ended() is None
    assert all(np.ptp(run.way(side), axis=0) == pytest.approx(0.0, abs=1e-3) for side in SIDES)


def test_one_that_hardly_shows_is_drawn_over_where_both_hands_saw_it_aside():
    run = bench(0.15, shown=0.65)
    place = np.append(MIDDLE[:2] + (0.15 + COLLAR_SEEN.aside, -0.05), HEIGHT)
    towards = {"approach_in_map": np.array((0.0, 0.0, -1.0)), "closing_in_map": np.array((0.0, 1.0, 0.0))}
    seen = GraspPoint(stamp=0.0, confidence=0.65, target="collar_middle", position_in_map=place, **towards)
    CloseLook.of(run.skill).seen = seen
    assert run.ended() is None
    assert np.ptp(held(run, "left")[:, 0]) > 0.1  # [m]


@pytest.mark.parametrize("bare", SIDES)
def test_a_gown_beside_a_bare_side_of_the_chest_is_drawn_by_the_other_hand(bare):
    run = bench(0.12, bare=(bare,))
    other = SIDES[1 - SIDES.index(bare)]
    assert run.ended() is None
    assert np.ptp(held(run, other)[:, 0]) > 0.15  # [m]
    assert len(held(run, bare)) == 0


def test_over_a_bare_chest_there_is_nothing_to_draw():
    assert bench(0.12, bare=SIDES).ended() == Reason.NOTHING_SEEN


def test_one_hand_alone_draws_it_too():
    def cloth(frame, pose_hand_in_map):
        return dataclasses.replace(HELD, confidence=0.0 if pose_hand_in_map[0, 3] > MIDDLE[0] + 0.05 else 0.9)

    run = bench(0.12, cloth=cloth)
    assert run.ended() is None
    path = held(run, "left")
    assert path[-1, 0] - path[0, 0] == pytest.approx(-0.17, abs=0.03)


def test_where_neither_hand_holds_cloth_it_fails_with_open_hands():
    run = bench(0.12, cloth=HIDDEN)
    assert run.ended() == Reason.GRASP_MISSED
    assert run.seen[-1].gripper_opening.min() > 0.03
