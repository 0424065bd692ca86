from dataclasses import replace

import pytest
from caretree.learning.physics.clips import dataset, generate
from caretree.sim.scene.gown import GOWNS


@pytest.fixture
def quick(monkeypatch, small_gown):
    """Shards of four clips of a small gown."""
    monkeypatch.setattr(generate, "SHARD", 4)
    monkeypatch.setattr(dataset, "SHARD", 4)
    monkeypatch.setitem(GOWNS, "medium", small_gown)
    monkeypatch.setattr(dataset, "HELDOUT_GOWN", replace(small_gown, name="heldout", length=8))
    monkeypatch.setattr(dataset, "random_cut", lambda seed, number: replace(small_gown, length=8 - number % 2))
