"""The head that stops the base's approach."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure
from caretree.perception.person.head import head_seen
from caretree.sim.render.camera import looking_at


@pytest.mark.parametrize("seed", range(4))
def test_head_is_where_it_is(scenes, bed, seed):
    scene = scenes.person(seed)
    head = head_seen(scene.frame(seed), bed)
    assert head.middle == pytest.approx(0.0, abs=0.025)
    assert head.crown_in_map[1] == pytest.approx(-0.55 - 0.31 * scene.scale, abs=0.025)
    assert head.confidence > 0.5


@pytest.mark.parametrize("seed", range(4))
def test_a_head_that_the_picture_cuts_off_is_not_told(scenes, bed, seed):
    scene, told, cut = scenes.person(seed), 0, 0
    for aim in np.arange(-0.3, 0.7, 0.05):  # along the bed [m]
        scene.camera = looking_at((1.25, -0.24, 1.5), (0.0, aim, 0.6))
        try:
            head = head_seen(scene.frame(seed), bed)
        except PerceptionFailure:
            cut += 1
        else:
            told += 1
            assert head.crown_in_map[1] == pytest.approx(-0.55 - 0.31 * scene.scale, abs=0.04)
    assert told > 3
    assert cut > 3


def test_no_head_in_view(scenes, bed, black):
    scene = scenes.person(0)
    scene.camera = looking_at((0.8, 0.9, 1.4), (0.0, 0.9, 0.6))  # legs only
    for frame in (scene.frame(), black, scenes.room(0, scene.camera).frame()):
        with pytest.raises(PerceptionFailure) as failure:
            head_seen(frame, bed)
        assert failure.value.kind == "nothing_seen"
