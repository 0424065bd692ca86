from itertools import pairwise

import numpy as np
from caretree.learning.gap.joints.alternatives import experiments
from caretree.learning.gap.joints.rivals import beside, determined, parting, rivals
from caretree.learning.gap.measurement import load_set
from caretree.learning.gap.open_study import open_study


def sets(study):
    return [{name for name, _ in r.effects} for r in study.rivals()]


def test_a_number_holds_whichever_set_is_right(axis_set):
    study = open_study(load_set(axis_set(lambda q, v, a: np.where(v > 0, 1.6, -0.5) + 12.0 * q, noise=0.2)))
    effects = study.name()[1]
    every = [{f.name for f in effects}, *sets(study)]  # a spring may rest anywhere, and that is an offset
    assert {"coulomb_friction", "spring"} in every
    assert {"asymmetric_friction", "spring"} in every
    numbers = {p.name: p for f in effects for p in f.parameters}
    assert numbers["preload"].doubt  # unequal friction may have any part of it
    assert numbers["stiffness"].low < 12.0 < numbers["stiffness"].high
    assert not numbers["stiffness"].doubt


def test_nothing_else_fits_where_the_recordings_tell(axis_set):
    study = open_study(load_set(axis_set(lambda q, v, a: 6.0 * v, noise=0.1)))
    search, chosen = study.named.search, study.named.chosen
    plain = {"spring", "offset", "coulomb_friction", "delay"}
    assert not [r for r in rivals(search, chosen) if {search.blocks[i].name for i in r} <= plain]


def test_what_an_effect_may_have_swallowed_is_told(axis_set):
    study = open_study(load_set(axis_set(lambda q, v, a: 6.0 * v + 0.06 * np.sign(v), noise=0.4)))
    assert [f.name for f in study.name()[1]] == ["viscous_friction"]
    assert {"viscous_friction", "coulomb_friction"} in sets(study) or not sets(study)
    assert all({"viscous_friction"} < s or "viscous_friction" not in s for s in sets(study))


def test_the_motion_that_parts_two_sets_is_found(axis_set):
    study = open_study(load_set(axis_set(lambda q, v, a: 0.8 * np.sign(v))))
    search = study.named.search
    at = {b.name: i for i, b in enumerate(search.blocks) if not b.shape}
    motions = experiments(study.model, study.fitted[0])
    text, apart = parting(search, (at["coulomb_friction"],), (at["viscous_friction"],), motions, study.named.noise.rms)
    assert "speed" in text
    assert apart > 1.0
    assert parting(search, (at["offset"],), (at["offset"],), motions, study.named.noise.rms)[1] == 0.0


def test_what_hides_beside_the_named_effects_is_told_and_nothing_else(axis_set):
    study = open_study(load_set(axis_set(lambda q, v, a: np.where(v > 0, 1.6, -0.5), noise=0.2)))
    search = study.named.search
    at = {b.key[0]: i for i, b in enumerate(search.blocks) if not b.shape}
    unequal, viscous = ((at[name],) for name in ("asymmetric_friction", "viscous_friction"))
    # a log that never rests has the offset in the friction
    assert (*unequal, at["offset"]) in beside(search, unequal)
    assert (*unequal, at["viscous_friction"]) not in beside(search, unequal)
    assert (*viscous, at["offset"]) not in beside(search, viscous)
    assert beside(search, ()) == []
    assert determined(search, unequal).all()
    assert not determined(search, (*unequal, at["offset"])).any()
    assert determined(search, viscous).all()


def test_a_burst_beside_an_effect_may_be_that_effects_own_form(axis_set):
    folder = axis_set(lambda q, v, a: 6.0 * v, noise=0.1)
    data = np.loadtxt(folder / "e0.csv", delimiter=",", skiprows=1)
    turns = np.flatnonzero(np.diff(np.sign(data[:, 2])))
    a, b = max(pairwise(turns), key=lambda pair: pair[1] - pair[0])
    middle = (a + b) // 2  # far from a reversal
    data[middle - 20 : middle + 20, 3] += 1.5
    np.savetxt(folder / "e0.csv", data, delimiter=",", header="t,q,dq,force", comments="")
    study = open_study(load_set(folder))
    assert {f.name for f in study.name()[1]} == {"viscous_friction", "contact"}
    first, *others = study.rivals()
    assert first.effects == (("viscous_friction", "axis"),)
    assert "repeat the motion" in first.experiment
    assert all(("contact", "axis") in r.effects for r in others)  # it is beside the other sets too
