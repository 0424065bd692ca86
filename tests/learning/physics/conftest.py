from dataclasses import replace

import numpy as np
import pytest
from caretree.learning.physics.clips.parameters import SHOWN
from caretree.learning.physics.methods.gp_inversion import fit_gp_inversion
from caretree.learning.physics.methods.method import Examples
from caretree.learning.physics.methods.simulator import Simulator
from caretree.sim.scene.gown import GOWNS, GownSpec


@pytest.fixture(scope="session")
def small_gown():
    """A gown of few vertices, so that tests are quick."""
    return GownSpec(name="small", spacing=0.11, front=7, back=2, hole=(2, 2), length=9, sleeve=2, air_drag=0.3)


@pytest.fixture(scope="session")
def still_air(small_gown):
    return replace(small_gown, air_drag=0.0)


def _examples(small_gown, count, seed):
    unit = np.random.default_rng(seed).uniform(0.3, 0.7, (count, 6))
    return Examples(frames=Simulator(small_gown)(unit), unit=unit, class_id=np.full(count, -1), hash=str(seed))


@pytest.fixture(scope="session")
def new_clips(small_gown):
    """Three clips of the small gown that nothing is fitted to."""
    return _examples(small_gown, 3, 7)


@pytest.fixture(scope="session")
def fitted(small_gown):
    """GP inversion that learned from clips of the small gown."""
    valid = _examples(small_gown, 24, 1)
    method = fit_gp_inversion(_examples(small_gown, 60, 0), valid, seed=0, shown=SHOWN)
    some = valid.part(np.arange(12))
    method.sort(False).set_widths("simulated", some.unit, *method.raw(some, lambda _: Simulator(small_gown)))
    return method


@pytest.fixture
def small_cut(monkeypatch, small_gown):
    """The medium gown has the small gown's cut."""
    monkeypatch.setitem(GOWNS, "medium", small_gown)
