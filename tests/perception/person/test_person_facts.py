"""Facts about the person are those of a body."""

import numpy as np
from caretree.perception.person.person_facts import PERSON
from caretree.sim.quantity import rows


def test_every_fact_has_a_source():
    kinds = ("choice:", "measured:", "standard:", "design:", "datasheet:", "paper:")
    assert all(row.source.startswith(kinds) for row in rows(PERSON))


def test_they_fit_each_other():
    upper, fore, _ = PERSON.arm_lengths
    elbow = np.arccos((upper**2 + fore**2 - PERSON.shortest_span**2) / (2 * upper * fore))
    assert 60 < np.rad2deg(elbow) < 120, "an arm at rest is bent by no more than a right angle or so"
    assert all(a > b for a, b in zip(PERSON.arm_radii, PERSON.arm_radii[1:], strict=False))
    assert PERSON.trunk_range[0] < 0.0 < PERSON.trunk_range[1]
