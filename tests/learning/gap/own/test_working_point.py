import numpy as np
from caretree.learning.gap.joints.workflow import explained
from caretree.learning.gap.own.working_point import WorkingPoint

from .slider import Slider
from .test_simulation import simulation


def test_at_the_values_it_leaves_what_simulating_leaves():
    sim = simulation(hidden={"rate": 0.4, "slope": 0.1})
    values = {**sim.none, "rate": 0.35, "slope": 0.12}
    point = WorkingPoint(sim, values)
    chosen = [b for b in point.blocks if b.name in ("viscous", "tilt")]
    theta = np.array([0.35, 0.12])
    for log, r in zip(point.logs, sim.recordings, strict=True):
        left = log.residual - explained(chosen, theta, log)
        np.testing.assert_allclose(left, sim.left(r, values), atol=1e-12)


def test_the_same_log_without_a_filter_is_the_same():
    point = WorkingPoint(simulation(), simulation().none)
    wide = point.logs[0].wide()
    np.testing.assert_allclose(wide.residual, point.logs[0].residual, atol=1e-12)
    np.testing.assert_array_equal(point.blocks[0].build(wide), point.blocks[0].build(point.logs[0]))


class Idle(Slider):
    name = "idle"

    def predict(self, log, values):
        return super().predict(log, {**values, "force": 0.0})


def test_an_effect_that_moves_nothing_is_no_hypothesis():
    names = [b.name for b in WorkingPoint(simulation(Idle()), simulation().none).blocks]
    assert names == ["viscous", "tilt", "ripple"]
