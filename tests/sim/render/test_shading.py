"""The lamp throws shadows, but not those of the walls."""

from __future__ import annotations

import numpy as np
import pytest
from caretree.sim.render.camera import Renderer, intrinsics_of, looking_at
from caretree.sim.render.raster import Light
from caretree.sim.render.shading import shaded, shadow_map
from caretree.sim.render.solids import box_mesh

EYE = looking_at(np.array((0.7, -2.0, 2.5)), np.array((0.7, 0.2, 0.0)))


@pytest.mark.parametrize("casting", [True, False])
def test_a_lamp_above_darkens_what_lies_under_a_box(casting):
    renderer = Renderer(Light(direction_in_map=np.array((0.0, 0.0, 1.0))))
    renderer.add_rigid("floor", *box_mesh(np.array((-3, -3, -0.05)), np.array((4, 3.5, 0))), (200, 200, 200))
    renderer.add_rigid("box", *box_mesh(np.array((0.4, 0.0, 1.0)), np.array((1.0, 0.4, 1.1))), (200, 200, 200))
    triangles, lens = renderer.triangles(), intrinsics_of((160, 120))
    shadows = shadow_map(triangles, renderer.light, np.full(len(triangles.faces), True) & casting)
    picture = renderer.render(EYE, (160, 120))
    ratio = shaded(picture, EYE, lens, shadows).astype(float) / np.maximum(picture.rgb, 1)
    local = (np.array((0.7, 0.2, 0.0)) - EYE[:3, 3]) @ EYE[:3, :3]  # the floor's point under the box
    u, v = (round(lens[k] * local[k] / local[2] + lens[2 + k]) for k in range(2))
    assert (ratio[v, u, 0] < 0.8) == casting
    assert np.median(ratio[ratio > 0]) > 0.98
