"""A laid gown is taken up by a strap, unless an arm may be in it."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.sim.mechanics.planar import planar_pose
from caretree.sim.world import SIDES
from caretree.skills.belief.sleeve_search import SLEEVE_SEARCH
from caretree.skills.control.base import BASE
from caretree.skills.core.reasons import Reason
from caretree.skills.geometry.stances import LIFTING, stance
from caretree.skills.scripted.scripted_person import laid_strap, lying_posture
from caretree.trees.tasks.dressing import take_up
from caretree.trees.tasks.dressing.take_up import GoToStrap, TakeUpGown

from ....skills.bench import CLOTH, LeafBench, beside_bed, on_arm, pulls


def going(monkeypatch, side, *, share=1.0, feetward=0.2):
    """Goes to a strap on a side of the person, of whose arm a share shows; where the robot ends, and why."""
    monkeypatch.setattr(take_up, "visible_share", lambda frame, posture: share)
    strap = laid_strap(side)
    place = strap.position_in_map + (0.0, feetward, 0.0)
    run = LeafBench(
        lambda context: GoToStrap("go", context, side=side, hand=LIFTING[side]),
        beside_bed(
            stand=stance(side, "lift"),
            sleeve_opening=replace(strap, position_in_map=place),
            arm=lambda frame, side, **_: lying_posture(side),
        ),
    )
    return run.ended(), run.seen[-1].pose_base_in_map, place


@pytest.mark.parametrize("side", SIDES)
def test_it_stands_where_the_hand_nearer_to_the_head_reaches_the_strap(monkeypatch, side):
    (failed, near, _), (_, far, _) = (going(monkeypatch, side, feetward=feetward) for feetward in (0.2, 0.4))
    assert failed is None
    assert far[1] - near[1] == pytest.approx(0.2, abs=0.03), "it goes along with the strap"
    assert near[2] == pytest.approx(stance(side, "lift")[2], abs=0.02)


def test_it_stands_square_before_the_strap(monkeypatch):
    _, base, place = going(monkeypatch, "right")
    ahead, aside = base[0] - place[0], place[1] - SLEEVE_SEARCH.armhole_to_strap - base[1]
    assert 0.6 < ahead < 1.0
    assert aside < -0.1, "the left hand is at its left, which is towards the head"


def test_a_covered_arm_may_be_in_the_sleeve(monkeypatch):
    failed, base, _ = going(monkeypatch, "right", share=0.4)
    assert failed == Reason.ARM_COVERED
    assert np.allclose(base, stance("right", "lift"), atol=0.01)


def at_strap():
    """Pose (4, 4) of the left hand at a strap on the bed, where `GoToStrap` has brought the robot."""
    pose, base = on_arm(1.0), planar_pose(stance("right", "lift"))
    pose[:2, 3] = (base @ (*BASE.ease, 0.0, 1.0))[:2]
    return pose


def raising(weight):
    """The left hand holds a strap; `weight` gives its load by the height it was lifted [N], [m]."""
    begun = []

    def answer(bench):
        height = bench.world.observe().pose_hand_in_map[0, 2, 3]
        begun.append(height)
        pulls(bench.world, "left", (0.0, 0.0, -weight(height - begun[0])))

    return LeafBench(
        lambda context: TakeUpGown("take up", context, side="right", hand="left"),
        beside_bed(hands={"left": at_strap()}, held={"left": CLOTH}),
        each_tick=answer,
    )


def test_the_hand_rises_by_its_height():
    run = raising(lambda risen: 4.0)
    assert run.ended() is None
    way = run.way("left")
    assert 0.58 < way[-1, 2] - way[0, 2] < 0.72, "as high as the arm gets, and as is asked for"
    near = way[way[:, 2] < way[0, 2] + 0.4]  # higher, this arm comes to its end, clear of the person
    assert np.abs(near[:, :2] - way[0, :2]).max() < 0.02, "straight up"
    assert run.openings("left")[-1] < 0.01, "it holds on"


@pytest.mark.parametrize(("held_at", "reason"), [(0.1, Reason.SLEEVE_CAUGHT), (0.65, None)])
def test_a_gown_that_holds_the_hand_back_is_let_be(held_at, reason):
    run = raising(lambda risen: 4.0 if risen < held_at else 9.0)
    assert run.ended() == reason
    assert run.way("left")[:, 2].max() < run.way("left")[0, 2] + held_at + 0.03
