"""Cuts of gowns other than the scene's usual one.

A cut (sizes of the panels, armholes and sleeves) is known when a gown is hung up; its cloth is not.  So a method may
simulate the right cut.  It learns from many random ones, and is tested on more of them and on one that is kept.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ....sim.scene.gown import GownSpec

FIELDS = ("spacing", "front", "back", "hole", "strap", "length", "sleeve")  # of a gown, all that its cut consists of


def same_cut(one: GownSpec, other: GownSpec) -> bool:
    """Whether two gowns differ in their cloth at most."""
    return all(getattr(one, field) == getattr(other, field) for field in FIELDS)


def random_cut(seed: int, number: int) -> GownSpec:
    """Cut `number` of a seed: a gown for somebody between slight and large."""
    rng = np.random.default_rng([seed, 7, number])
    return GownSpec(
        name=f"cut{number}",
        spacing=round(float(rng.uniform(0.05, 0.06)), 4),
        front=int(rng.integers(12, 17)),
        back=int(rng.integers(2, 5)),
        hole=(int(rng.integers(2, 5)), int(rng.integers(3, 6))),
        strap=int(rng.integers(1, 3)),
        length=int(rng.integers(15, 21)),
        sleeve=int(rng.integers(2, 6)),
    )


# The cut of the dataset `heldout_gown`, drawn in the same way with a seed that `cuts` does not use, and kept.
HELDOUT_GOWN = replace(random_cut(2026, 0), name="heldout")
