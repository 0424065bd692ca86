"""Sizes of the difficulties."""

from dataclasses import fields

from caretree.sim.quantity import rows
from caretree.sim.scene.difficulties import SIZES
from caretree.sim.world_kind import DIFFICULTIES


def test_every_difficulty_has_its_sizes():
    assert tuple(item.name for item in fields(SIZES)) == DIFFICULTIES


def test_every_size_says_where_it_comes_from():
    sources = [row.source for row in rows(SIZES)]
    assert all(
        source.startswith(("choice: ", "paper: ", "datasheet: ", "measured: ", "design requirement: "))
        for source in sources
    )
