"""How much of the chest a gown covers."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.person.chest_cover import chest_cover
from caretree.sim.render.solids import box_mesh

SHOULDERS = np.array((0.0, -0.55, 0.7))


def covered(scene, bed, feet, surface="gown_outside"):
    """What is seen with a gown from above the shoulders down to `feet` [m]."""
    top = bed[1, 2] + 0.22
    scene.renderer.add_rigid(
        "gown", *box_mesh((-0.25, -0.6, top), (0.25, feet, top + 0.01)), scene.look.colours[surface]
    )
    return chest_cover(scene.frame(0, stamp=1.5), bed, SHOULDERS)


def test_a_gown_over_all_of_it_and_over_half_of_it(scenes, bed):
    whole, half = covered(scenes.person(0), bed, 0.0), covered(scenes.person(0), bed, -0.28)
    assert whole.share > 0.95
    assert half.share == pytest.approx(0.5, abs=0.15)
    assert whole.stamp == 1.5


@pytest.mark.parametrize(("surface", "outside"), [("gown_outside", 1.0), ("gown_inside", 0.0)])
def test_which_side_of_it_is_out(scenes, bed, surface, outside):
    assert covered(scenes.person(0), bed, 0.0, surface).outside == pytest.approx(outside, abs=0.05)


def test_no_gown_and_no_chest_are_no_answer(scenes, bed):
    with pytest.raises(PerceptionFailure) as nothing:
        chest_cover(scenes.person(0).frame(0), bed, SHOULDERS)
    assert nothing.value.problem is Problem.NOTHING_SEEN
    scene = scenes.person(0)
    covered(scene, bed, 0.0)
    with pytest.raises(PerceptionFailure) as away:
        chest_cover(scene.frame(0), bed, SHOULDERS + (5.0, 0.0, 0.0))
    assert away.value.problem is Problem.OUT_OF_REACH
