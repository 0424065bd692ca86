"""The curves of a record against what the made-up run is known to do."""

import numpy as np
import pytest
from caretree.sim.evaluate.series import read_series


def test_curves_of_a_known_run(make_record, tmp_path):
    series = read_series(make_record(tmp_path / "run"))
    assert series.person_parts == ("torso", "left_arm", "right_arm")
    # the hands move 2 m in 60 frames of 0.08 s and then stand
    np.testing.assert_allclose(series.speed[3:60], 2.0 / 4.8, rtol=1e-4)
    np.testing.assert_allclose(series.speed[-20:], 0.0, atol=1e-6)
    # at the end each hand is 0.2 m from the arm's axis across and above: sqrt(0.08^2 + 0.15^2) less the radius
    assert series.distance[-1, 0] == pytest.approx(np.hypot(0.08, 0.15) - 0.05, abs=1e-5)
    assert series.distance[0, 0] > 1.0
    np.testing.assert_allclose(series.upper_arm[0], 0.0)
    np.testing.assert_allclose(series.upper_arm[-1], 1 - 0.05 / 0.3, atol=1e-5)
    np.testing.assert_allclose(series.stretch_max, 1.0, atol=1e-4)
    assert series.load[0, 0] == pytest.approx(np.hypot(3.0, 1.0))
    assert not series.holds[-1].any()
