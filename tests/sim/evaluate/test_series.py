"""The curves of a record against what the made-up run is known to do."""

import numpy as np
import pytest
from caretree.sim.errors import RecordError
from caretree.sim.evaluate.series import read_series
from caretree.sim.evaluate.verdict import evaluate

from ...gownless import without_gown


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
    # the palms stay 0.3 m past the head and 1 m over it, at x = 0.5 m; the head's axis ends at y = -0.25 m
    assert series.clearance is not None
    np.testing.assert_allclose(series.clearance[:, 0], np.sqrt(0.5**2 + 0.25**2 + 1.0) - 0.08 - 0.05, atol=1e-6)
    assert (series.clearance[:, 1] > 1.0).all()
    np.testing.assert_allclose(series.wrists, 0.1, atol=1e-6)


def test_old_records_have_the_other_curves(damaged_record):
    series = read_series(damaged_record(lambda z: z.pop("bed_top")))
    assert series.clearance is None
    assert series.wrists is None
    assert len(series.load) == len(series.t)


def test_a_task_without_a_gown_has_the_other_curves(make_record, tmp_path):
    series = read_series(without_gown(make_record(tmp_path / "run")))
    assert np.isnan(series.upper_arm).all()
    assert np.isnan(series.stretch_max).all()
    assert series.person_force.max() == pytest.approx(2.0)
    assert series.distance[-1, 0] == pytest.approx(np.hypot(0.08, 0.15) - 0.05, abs=1e-5)
    assert series.clearance is not None
    with pytest.raises(RecordError, match="holds a garment without vertices or faces"):
        evaluate(tmp_path / "run")
