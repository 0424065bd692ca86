"""How high the front of the chest lies."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.person.chest_front import chest_front
from caretree.sim.render.solids import box_mesh

SHOULDERS = np.array((0.0, -0.55, 0.7))


@pytest.mark.parametrize("seed", range(4))
def test_a_bare_chest_is_as_high_as_its_body(scenes, bed, seed):
    scene = scenes.person(seed)
    seen = chest_front(scene.frame(0, stamp=1.5), bed, SHOULDERS)
    assert seen.height == pytest.approx(0.22 * scene.scale, abs=0.008)
    assert seen.breastbone < seen.height - 0.01  # the two capsules of the manikin meet there
    assert seen.stamp == 1.5


def test_what_lies_on_it_counts(scenes, bed):
    scene = scenes.person(0)
    top = bed[1, 2] + 0.25
    scene.renderer.add_rigid(
        "gown", *box_mesh((-0.25, -0.6, top - 0.01), (0.25, 0.0, top)), scene.look.colours["gown_outside"]
    )
    seen = chest_front(scene.frame(0), bed, SHOULDERS)
    assert seen.height == pytest.approx(0.25, abs=0.008)
    assert seen.breastbone == pytest.approx(0.25, abs=0.008)


def test_half_a_chest_out_of_view_is_no_answer(scenes, bed):
    with pytest.raises(PerceptionFailure) as away:
        chest_front(scenes.person(0).frame(0), bed, SHOULDERS + (0.0, 5.0, 0.0))
    assert away.value.problem is Problem.OUT_OF_REACH
