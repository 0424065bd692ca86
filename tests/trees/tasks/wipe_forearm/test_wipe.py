"""The cloth is pressed on evenly, to and fro along the forearm, and never hard."""

import numpy as np
import pytest
from caretree.skills.core.reasons import Reason
from caretree.skills.scripted.scripted_person import lying_posture
from caretree.trees.tasks.wipe_forearm.wipe import Wipe, WipeTuning

from ....skills.bench import CLOTH, PATH, LeafBench, beside_bed, pulls

WEIGHT, REACH = 1.0, 0.09  # of the cloth [N], and how far it reaches below the fingertips to the arm's axis [m]
AXIS = PATH.points[2] - PATH.points[1]
OFF = np.cross(np.cross(AXIS, (0.0, 0.0, 1.0)), AXIS) / AXIS.dot(AXIS)  # off the arm, upwards


def bench(stiffness=500.0, strokes=2):
    """The right hand holds a cloth, through which the right forearm is felt."""
    felt = []

    def feels(run):
        hand = run.world.observe().pose_hand_in_map[1, :3, 3]
        off = OFF / np.linalg.norm(OFF)
        pressed = stiffness * max(REACH - float((hand - PATH.points[1]) @ off), 0.0)
        felt.append((PATH.coordinate_of(hand), pressed))
        pulls(run.world, "right", pressed * off - (0.0, 0.0, WEIGHT))

    run = LeafBench(
        lambda context: Wipe("wipe", context, side="right", hand="right", strokes=strokes),
        beside_bed(held={"right": CLOTH}, arm=lying_posture("right")),
        each_tick=feels,
    )
    return run, felt


def test_it_goes_to_and_fro_with_an_even_force_and_lifts_off():
    run, felt = bench(strokes=2)
    assert run.ended() is None
    along, pressed = np.array(felt).T
    wiping = (along > 1.2) & (along < 1.8) & (pressed > 0.0)
    assert wiping.sum() > 60  # two strokes of 0.15 m at 0.06 m/s, 15 ticks a second
    low, high = np.percentile(pressed[wiping], (5, 95))
    assert (low, high) == pytest.approx((3.5, 3.5), abs=1.0)
    assert pressed.max() < 5.0
    assert along[pressed > 1.0].min() < 1.2
    assert along[pressed > 1.0].max() > 1.8
    assert pressed[-1] == 0.0


def test_a_hand_without_a_cloth_goes_no_lower_than_the_arm():
    run, _ = bench(stiffness=0.0)
    assert run.ended() == Reason.CLOTH_SLIPPED
    assert (run.way("right") - PATH.points[1]).dot(OFF).min() > 0.02  # [m]


def test_what_does_not_give_ends_it():
    run, felt = bench(stiffness=20_000.0)
    assert run.ended() == Reason.FORCE_LIMIT
    assert np.array(felt)[:-3, 1].max() < WipeTuning().max_force + 20_000.0 * 0.03 / 15  # one tick of lowering more
