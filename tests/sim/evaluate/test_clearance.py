"""Distance between robot and person, capsule against capsule."""

import numpy as np
import pytest
from caretree.sim.evaluate.clearance import clearance
from caretree.sim.evaluate.truth_file import read_truth


def test_the_nearest_pair_is_named_with_its_frame(damaged_record):
    def approach(z):
        z["robot_capsules"][30, 1] = (0.0, 0.3, 0.2, 0.0, 0.4, 0.2, 0.05)  # over the trunk, whose skin is at z = 0

    truth = read_truth(damaged_record(approach))
    assert truth.unharmed is not None
    near = clearance(truth, truth.unharmed)
    assert near.parts[:2] == ("neck_head", "trunk")
    assert near.parts[-1] == "right_hand"
    assert near.head.tolist() == [True] + 7 * [False]
    gap, frame, link, part = near.nearest(~near.head)
    assert (gap, frame, link, part) == (pytest.approx(0.15, abs=1e-6), 30, "right_palm", "trunk")
    assert near.least(~near.head)[30] == gap
    assert near.least(~near.head)[31] > 0.5
    assert near.nearest(np.zeros(8, dtype=bool))[0] == np.inf


def test_a_finger_in_the_arm_that_it_holds_has_no_gap(damaged_record):
    def hold(z):
        z["robot_capsule_names"] = np.array(["left_finger_1", "right_palm"])
        z["holds_arm"][40:42, 0] = 1

    truth = read_truth(damaged_record(hold))
    assert truth.unharmed is not None
    near = clearance(truth, truth.unharmed)
    free = np.isinf(near.gap)
    assert free[39:43, 0, -3:].all()  # the three parts of the right arm, with a frame before and after
    assert free.sum() == 4 * 3
