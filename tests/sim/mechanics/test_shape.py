"""The axis of a shape turns with it, as URDF turns things."""

import numpy as np
import pinocchio as pin  # pyright: ignore[reportMissingImports] - lives in a cmeel prefix
import pytest
from caretree.sim.mechanics.shape import Shape


@pytest.mark.parametrize("rpy", [(0.0, 0.0, 0.0), (0.3, -1.1, 2.0), (np.pi / 2, 0.0, 0.0)])
def test_the_axis_is_that_of_the_urdf(rpy):
    axis = Shape(kind="capsule", size=(0.1, 0.2), rpy=rpy).axis
    np.testing.assert_allclose(axis, pin.rpy.rpyToMatrix(*rpy)[:, 2], atol=1e-12)
