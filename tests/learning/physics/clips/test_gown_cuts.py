from dataclasses import replace

from caretree.learning.physics.clips.gown_cuts import HELDOUT_GOWN, random_cut, same_cut
from caretree.sim.scene.gown import GOWNS, build_gown


def test_cuts_can_be_sewn_and_repeat():
    cuts = [random_cut(0, number) for number in range(40)]
    for cut in cuts:
        build_gown(cut)
    assert cuts == [random_cut(0, number) for number in range(40)]
    assert len({(c.spacing, c.front, c.length) for c in cuts}) > 35


def test_the_same_cut_may_be_of_another_cloth():
    medium = GOWNS["medium"]
    assert same_cut(medium, replace(medium, mass=0.2, name="other"))
    assert not same_cut(medium, GOWNS["large"])
    assert not any(same_cut(HELDOUT_GOWN, random_cut(0, number)) for number in range(100))
