import numpy as np
import pytest
from caretree.learning.gap.joints.rivals import Unsearched, rivals
from caretree.learning.gap.measurement import load_set
from caretree.learning.gap.open_study import open_study

NOISE = 0.4


def changed(folder, k, extra):
    """The set with a force `extra(q, v)` [N] more in recording `k`."""
    data = np.loadtxt(folder / f"e{k}.csv", delimiter=",", skiprows=1)
    data[:, 3] += extra(data[:, 1], data[:, 2])
    np.savetxt(folder / f"e{k}.csv", data, delimiter=",", header="t,q,dq,force", comments="")
    return folder


def rubbing(axis_set, level, level_held_out):
    """A study of viscous friction, with dry friction on the two fitted recordings and on the third."""
    folder = axis_set(lambda q, v, a: 6.0 * v, noise=NOISE)
    for k, size in enumerate((level, level, level_held_out)):
        changed(folder, k, lambda q, v, size=size: size * np.sign(v))
    return open_study(load_set(folder))


def open_without_dry_friction(study):
    """Whether viscous friction alone may be right beside the two, and by how much it fits the searched logs worse."""
    search = study.named.search
    at = {b.name: i for i, b in enumerate(search.blocks) if b.name in ("viscous_friction", "coulomb_friction")}
    both, one = tuple(at.values()), (at["viscous_friction"],)
    worse = float(search.rows @ (np.log(search.rss(one)) - np.log(search.rss(both))))
    return Unsearched(search, study.heldout).leaves_open(both, one, worse), worse / search.price[both[1]]


@pytest.mark.parametrize(("level_held_out", "left_open"), [(0.0, True), (0.08, False)])
def test_what_gains_nothing_on_logs_not_searched_may_have_been_chance(axis_set, level_held_out, left_open):
    found, over_price = open_without_dry_friction(rubbing(axis_set, 0.08, level_held_out))
    assert 1.0 < over_price < 3.0  # enough to be named
    assert found is left_open


def test_what_the_searched_logs_settle_is_settled(axis_set):
    found, over_price = open_without_dry_friction(rubbing(axis_set, 1.5, 0.0))
    assert over_price > 3.0
    assert not found


def test_what_only_the_logs_not_searched_have_is_told(axis_set):
    folder = axis_set(lambda q, v, a: 6.0 * v, noise=0.1)
    changed(folder, 2, lambda q, v: 0.5 * np.sign(v))
    study = open_study(load_set(folder))
    n = study.named
    assert {b.name for b in n.blocks} == {"viscous_friction"}
    together = Unsearched(n.search, study.heldout).together(n.chosen)
    assert {n.search.blocks[i].name for i in together} >= {"viscous_friction", "coulomb_friction"}
    assert rivals(n.search, n.chosen, Unsearched(n.search, study.heldout))[0] == together
    assert Unsearched(n.search, []).together(n.chosen) == n.chosen
    assert together not in rivals(n.search, n.chosen)
