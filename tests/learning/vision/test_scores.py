"""Scores of simple cases are what one reckons by hand."""

import math

import numpy as np
from caretree.learning.vision.scores import Tally


def test_overlap_is_of_all_pictures_together():
    tally = Tally()
    full, half, none = np.ones((2, 2), bool), np.array([[True, True], [False, False]]), np.zeros((2, 2), bool)
    tally.overlap("gown", half, full)
    tally.overlap("gown", full, full)
    tally.overlap("gown", none, none)
    assert tally.iou("gown") == (6 / 8, 3)
    assert math.isnan(tally.iou("nothing")[0])


def test_rates_and_medians_say_of_how_many():
    tally = Tally()
    tally.hits["corner"] += [True, False, True, True]
    tally.values["away"] += [0.1, math.inf, 0.2]
    assert tally.rate("corner") == (0.75, 4)
    assert tally.median("away") == (0.2, 3)


def test_a_calibrated_and_a_boastful_confidence():
    tally = Tally()
    tally.confidence("honest", np.full(10, 0.8), np.arange(10) < 8)
    tally.confidence("boastful", np.full(10, 0.99), np.arange(10) < 5)
    assert tally.calibration_error("honest")[0] < 1e-9
    assert np.isclose(tally.calibration_error("boastful")[0], 0.49)
