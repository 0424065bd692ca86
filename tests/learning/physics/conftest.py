from dataclasses import replace

import pytest
from caretree.sim.scene.gown import GownSpec


@pytest.fixture(scope="session")
def small_gown():
    """A gown of few vertices, so that tests are quick."""
    return GownSpec(name="small", spacing=0.11, front=7, back=2, hole=(2, 2), length=9, sleeve=2, air_drag=0.3)


@pytest.fixture(scope="session")
def still_air(small_gown):
    return replace(small_gown, air_drag=0.0)
