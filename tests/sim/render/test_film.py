"""A picture of the video holds two views, the head camera, and a caption."""

from __future__ import annotations

import numpy as np
from caretree.sim.render.camera import Renderer
from caretree.sim.render.film import FILM_SIZE, HANDS_SIZE, ROOM_SIZE, Caption, Film, Moment
from caretree.sim.render.raster import Light
from caretree.sim.render.solids import box_mesh

HANDS = np.array(((0.0, -0.2, 1.0), (0.0, 0.2, 1.0)))


def picture(**options):
    renderer = Renderer(Light(direction_in_map=np.array((0.0, 0.0, 1.0))))
    renderer.add_rigid("table", *box_mesh(np.array((-1, -1, 0)), np.array((1, 1, 0.5))), (100, 150, 200))
    film = Film(renderer.light, shell=())
    return film.draw(Moment(time=1.0, triangles=renderer.triangles(), hands=HANDS, **options))


def test_everything_is_in_the_picture():
    head = np.full((300, 400, 3), 77, np.uint8)
    drawn = picture(head=(head, 0.5), caption=Caption("dress", "pull the sleeve"))
    assert drawn.shape == (FILM_SIZE[1], FILM_SIZE[0], 3)
    assert drawn.dtype == np.uint8
    assert drawn[: ROOM_SIZE[1], : ROOM_SIZE[0]].std() > 5
    assert drawn[: HANDS_SIZE[1], ROOM_SIZE[0] :].std() > 5
    assert tuple(drawn[500, 1100]) == (77, 77, 77)


def test_the_caption_is_written():
    plain, told = picture(), picture(caption=Caption("dress ä ✂", "x" * 500))
    strip = slice(ROOM_SIZE[1], None)
    assert (plain[strip, :400] != told[strip, :400]).any()
    assert (plain[: ROOM_SIZE[1]] == told[: ROOM_SIZE[1]]).all()
