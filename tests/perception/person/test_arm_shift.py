"""An arm that its owner moves has left its place; one that rests, is covered or is carried by a hand has not."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure
from caretree.perception.person.arm_shift import arm_shift
from caretree.sim.render.camera import looking_at
from caretree.sim.render.solids import box_mesh, capsule_mesh

LIFT = 0.4  # [rad] of the right arm, clear of the bed


def shifts(scenes, seed, stir, **details):
    """Shift of the right arm, by `stir` [rad] upwards."""
    before, now = scenes.person(seed, lift=LIFT), scenes.person(seed, lift=LIFT + stir)
    return arm_shift(before.frame(1), now.frame(2, stamp=0.2), before.arms["right"], **details)


def test_an_arm_that_rests_has_not_moved_wherever_it_is_seen_from(scenes):
    for seed in range(4):
        for camera in (None, looking_at(np.array((0.75, -0.25, 1.66)), np.array((-0.20, -0.25, 0.70)))):
            before, now = scenes.person(seed), scenes.person(seed)
            now.camera = now.camera if camera is None else camera
            for side in ("left", "right"):
                shift = arm_shift(before.frame(1), now.frame(2, stamp=0.2), before.arms[side])
                assert shift.share < 0.05
                assert shift.stamp == 0.2


@pytest.mark.parametrize("stir", [0.1, -0.1])
def test_an_arm_that_stirs_has_left_its_place(scenes, stir):
    for seed in range(4):
        assert shifts(scenes, seed, stir).share > 0.3
    assert shifts(scenes, 0, stir / 5).share < 0.1, "a slow motion is no stir"


def test_an_arm_that_goes_with_the_hand_that_holds_it_has_not(scenes):
    for seed in range(4):
        elbows = [scenes.person(seed, lift=lift).arms["right"][1] for lift in (LIFT, LIFT + 0.1)]
        assert shifts(scenes, seed, 0.1, grips_in_map=(elbows[0], elbows[1])).share < 0.1
        assert shifts(scenes, seed, 0.0, grips_in_map=(elbows[0], elbows[1])).share > 0.3, "it was left behind"


def test_what_comes_before_an_arm_says_nothing(scenes):
    before, now = scenes.person(0), scenes.person(0)
    wrist, tip = now.arms["right"][2:]
    now.renderer.add_rigid("sleeve", *capsule_mesh(wrist, tip, 0.09), now.look.colours["gown_outside"])
    covered = arm_shift(before.frame(1), now.frame(2), before.arms["right"])
    assert covered.share < 0.05
    assert covered.confidence < 0.9
    other = scenes.person(0)
    other.renderer.add_rigid(
        "arm", *capsule_mesh(wrist + (0.25, 0.0, 0.25), tip + (0.25, 0.0, 0.25), 0.06), other.look.colours["skin"]
    )
    assert arm_shift(before.frame(1), other.frame(2), before.arms["right"]).share < 0.05, "another arm, high above"


def test_an_arm_that_hardly_shows_is_no_answer(scenes, black):
    before, hidden = scenes.person(0), scenes.person(0)
    arm = before.arms["right"]
    board = box_mesh(arm.min(axis=0) - 0.3, arm.max(axis=0) + (0.3, 0.3, 0.15))
    hidden.renderer.add_rigid("board", *board, hidden.look.colours["robot_grey"])
    for first, second in ((before, hidden), (hidden, before)):
        with pytest.raises(PerceptionFailure):
            arm_shift(first.frame(1), second.frame(2), arm)
    with pytest.raises(PerceptionFailure):
        arm_shift(black, before.frame(2), arm)
    for beside in ((5.0, 0.0, 0.0), (-5.0, 0.0, 0.0), (0.0, 0.0, 3.0), (0.0, 5.0, 0.0)):
        with pytest.raises(PerceptionFailure):
            arm_shift(before.frame(1), before.frame(2), arm + beside)
