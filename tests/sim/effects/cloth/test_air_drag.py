"""Drag of still air on moving cloth."""

import numpy as np
import pytest
from caretree.sim.effects.cloth.air_drag import AirDrag
from caretree.sim.effects.cloth.cloth_effect import ProxyState


def test_grows_with_the_area_and_the_square_of_the_speed():
    velocity = np.array(((0.0, 0.0, -1.0), (0.0, 0.0, -2.0), (3.0, 0.0, 4.0)))  # [m/s]
    state = ProxyState(
        t=0.0,
        x=np.zeros((3, 3)),
        v=velocity,
        start=np.zeros((3, 3)),
        mass=np.ones(3),
        area=np.array((0.1, 0.1, 0.2)),  # [m^2]
        pairs=np.zeros((0, 2), int),
        lengths=np.zeros(0),
        capsules=np.zeros((0, 7)),
        gravity=np.zeros(3),
    )
    force = AirDrag().forces(state, {"coefficient": 0.5})
    expected = np.array(((0.0, 0.0, 0.05), (0.0, 0.0, 0.2), (-1.5, 0.0, -2.0)))  # [N]
    assert force == pytest.approx(expected)
