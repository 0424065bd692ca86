"""What every effect shares: units, the sign of a velocity, and values that are refused."""

import numpy as np
import pytest
from caretree.sim.effects.effect import EffectError, JointMotion, Parameter, check_values

NEEDED = (Parameter(name="level", unit="F s/x", lower=0.0, upper=2.0),)
WIDTH = (Parameter(name="width", unit="x", lower=0.0),)


def test_units_are_spelled_out_for_the_kind_of_joint():
    assert NEEDED[0].unit_for(prismatic=True) == "N s/m"
    assert NEEDED[0].unit_for(prismatic=False) == "N m s/rad"


def test_the_direction_is_a_sign_that_passes_smoothly_through_zero():
    directions = [
        float(JointMotion.instant(q=0.0, dq=dq, slow=0.1).direction[0]) for dq in (-5.0, -0.01, 0.0, 0.01, 5.0)
    ]
    assert directions == pytest.approx([-1.0, -0.197, 0.0, 0.197, 1.0], abs=1e-3)


def test_a_wider_passage_counts_a_narrower_one_does_not():
    motion = JointMotion.instant(q=0.0, dq=0.05, slow=0.1)
    assert motion.direction_within(0.01) == motion.direction
    assert motion.direction_within(1.0)[0] == pytest.approx(np.tanh(0.1))


@pytest.mark.parametrize("values", [{"level": 1.0}, {"level": 2.0, "width": 0.3}])
def test_values_that_fit_pass(values):
    check_values("friction", values, NEEDED, WIDTH)


@pytest.mark.parametrize(
    ("values", "says"),
    [
        ({}, r"has parameters \[\], it takes \['level', 'width'\]"),
        ({"level": 1.0, "depth": 1.0}, "it takes"),
        ({"level": 3.0}, "level = 3 is outside 0 to 2"),
        ({"level": 1.0, "width": -1.0}, "width = -1 is outside 0 to inf"),
        ({"level": float("nan")}, "level = nan"),
    ],
)
def test_values_that_do_not_fit_are_told(values, says):
    with pytest.raises(EffectError, match=says):
        check_values("friction", values, NEEDED, WIDTH)
