"""Every sense: the right type from a good picture, a stamp, and a failure instead of a guess."""

import numpy as np
import pytest
from caretree.perception import estimates
from caretree.perception.classical import ClassicalSenses, ClassicalTuning
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.senses import Senses
from caretree.sim.quantity import changed, rows
from caretree.sim.world import RoomMap

CALLS = {  # name -> scene, type, details from the scene
    "gown_side": ("on_rail", estimates.GownSide, lambda s: {}),
    "hang_point": ("on_rail", estimates.GraspPoint, lambda s: {}),
    "pre_grasp": ("in_hand", estimates.PreGrasp, lambda s: {"poses_hand_in_map": [s.hand], "distance": (0.12, np.inf)}),
    "layers": (
        "in_hand",
        estimates.LayerCount,
        lambda s: {
            "side": "left",
            "pose_hand_in_map": s.hand,
            "poses_cloth_in_map": [s.hand],
            "opening": 0.085,
        },
    ),
    "gripped_cloth": ("in_hand", estimates.Estimate, lambda s: {"pose_hand_in_map": s.hand}),
    "sleeve_opening": (
        "lying",
        estimates.SleeveOpening,
        lambda s: {"side": "right", "near_in_map": s.arms["right"][0]},
    ),
    "collar_middle": (
        "lying",
        estimates.GraspPoint,
        lambda s: {"near_in_map": (s.arms["left"][0] + s.arms["right"][0]) / 2},
    ),
    "head": ("person", estimates.Head, lambda s: {}),
    "arm": ("person", estimates.ArmPosture, lambda s: {"side": "right"}),
}


def fresh(bed):
    return ClassicalSenses(RoomMap(free=np.ones((2, 2), bool), origin=np.zeros(2), resolution=1.0, bed=bed), 0)


ELSEWHERE = {
    "hook",
    "shown_corner",
    "hung_corner",
    "hung_side",
    "held_armhole",
    "sleeve_heading",
    "skin_cover",
    "cuff_round",
    "shoulder_seam",
    "relocalised_arm",
    "arm_shift",
    "worn_sleeve",
    "sleeve_on_forearm",
    "sleeve_profile",
    "overhang",
    "sleeve_strap",
    "chest_cover",
    "chest_front",
}  # these need a whole scene


def ask(senses, name, frame, details):
    return getattr(senses, name)([frame] if name in ("pre_grasp", "layers") else frame, **details)


def test_all_are_covered():
    assert Senses.__abstractmethods__ == set(CALLS) | ELSEWHERE


@pytest.mark.parametrize("name", CALLS)
def test_type_stamp_confidence_and_failure(scenes, bed, black, name):
    kind, expected, details = CALLS[name]
    scene = getattr(scenes, kind)(0)
    found = ask(fresh(bed), name, scene.frame(1, stamp=2.5), details(scene))
    assert type(found) is expected
    assert found.stamp == 2.5
    assert 0 < found.confidence <= 1
    with pytest.raises(PerceptionFailure) as failure:
        ask(fresh(bed), name, black, details(scene))
    assert failure.value.problem in Problem
    empty = scenes.room(0, scene.camera).frame(1)
    if name != "gripped_cloth":  # nothing held is an answer there
        with pytest.raises(PerceptionFailure):
            ask(fresh(bed), name, empty, details(scene))


def test_random_choices_follow_the_seed(scenes, bed):
    frame = scenes.on_rail(0).frame()
    a, b = (fresh(bed).hang_point(frame) for _ in range(2))
    assert (a.position_in_map == b.position_in_map).all()


def test_arm_takes_the_grip(scenes, bed):
    scene = scenes.person(0)
    arm = fresh(bed).arm
    arm(scene.frame(0, stamp=0.0), side="right")
    held = arm(scene.frame(1, stamp=0.1), side="right", grip_in_map=scene.arms["right"][1], arm_coordinate=1.0)
    assert np.linalg.norm(held.points_in_map[1] - scene.arms["right"][1]) < 0.03


def test_an_arm_that_was_never_found_is_not_looked_for_again(scenes, bed):
    with pytest.raises(PerceptionFailure) as failure:
        fresh(bed).relocalised_arm(scenes.person(0).frame(0), side="right")
    assert failure.value.problem is Problem.ARM_LOST


def test_its_numbers_can_be_set(scenes, bed):
    scene = scenes.person(0)
    room = RoomMap(free=np.ones((2, 2), bool), origin=np.zeros(2), resolution=1.0, bed=bed)
    points = np.linspace(*scene.arms["right"][2:], 6)
    asks = {
        "skin_cover.min_points": (7, lambda senses, frame: senses.skin_cover(frame, points_in_map=points)),
        "head.min_points": (10**6, lambda senses, frame: senses.head(frame)),
        "skin.height_range": ((5.0, 6.0), lambda senses, frame: senses.head(frame)),
        "arm.search.min_points": (10**6, lambda senses, frame: senses.arm(frame, side="right")),
    }
    frame = scene.frame(0)
    for name, (value, ask_for) in asks.items():
        ask_for(ClassicalSenses(room, 0), frame)
        with pytest.raises(PerceptionFailure):
            ask_for(ClassicalSenses(room, 0, tuning=changed(ClassicalTuning(), {name: value})), frame)


def test_every_number_says_where_it_comes_from():
    found = rows(ClassicalTuning())
    assert {row.name.split(".")[0] for row in found} >= {"arm", "head", "hung_corner", "sleeve_strap", "worn_sleeve"}
    kinds = ("choice:", "measured:", "standard:", "design:", "datasheet:", "paper:")
    assert [row.name for row in found if not row.source.startswith(kinds)] == []
