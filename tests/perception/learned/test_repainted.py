"""Pictures repainted in the colours that the rules read, and senses that look at those."""

import numpy as np
from caretree.perception.image.surfaces import GOWN_SURFACES, Surface, surfaces
from caretree.perception.learned.repainted import gown_repainted, repainted
from caretree.sim.world import Frame, RoomMap

BED = np.array(((-0.5, -1.0, 0.0), (0.5, 1.0, 0.6)))
ROOM = RoomMap(free=np.ones((2, 2), bool), origin=np.zeros(2), resolution=1.0, bed=BED)


def frame(rgb, camera="head"):
    rgb = np.asarray(rgb, np.uint8)
    return Frame(
        camera=camera,
        stamp=0.0,
        rgb=rgb,
        depth=np.ones(rgb.shape[:2], np.float32),
        intrinsics=(100.0, 100.0, 8.0, 8.0),
        pose_camera_in_map=np.eye(4),
    )


def test_the_rules_take_for_skin_what_the_network_does_whatever_its_colour():
    seen = np.where(np.arange(16) < 8, Surface.SKIN, Surface.OTHER)[:, None] * np.ones(16, np.uint8)
    wood = np.full((16, 16, 3), (190, 140, 105))
    assert (surfaces(frame(wood).rgb) == Surface.SKIN).all()
    for picture in (wood, np.zeros((16, 16, 3)), np.full((16, 16, 3), (60, 45, 40))):
        told = surfaces(repainted(frame(picture), seen).rgb) == Surface.SKIN
        assert told[:7].all()  # the median filter of the rules blurs the border
        assert not told[9:].any()


def test_the_colours_of_a_gown_stay():
    navy = np.full((16, 16, 3), (20, 30, 90))
    shown = repainted(frame(navy), np.full((16, 16), Surface.OUTSIDE, np.uint8)).rgb
    assert (shown == navy).all()


def test_a_gown_that_is_seen_gets_the_colours_of_the_rules_and_nothing_else_has_them():
    bands = np.repeat(np.array(GOWN_SURFACES, np.uint8), 5)[:, None] * np.ones(25, np.uint8)  # five rows each
    seen = np.where(np.arange(25) < 15, bands, Surface.OTHER).astype(np.uint8)
    for picture in (np.full((25, 25, 3), (20, 30, 90)), np.full((25, 25, 3), (250, 250, 250))):  # navy, white
        told = surfaces(gown_repainted(frame(picture), seen).rgb)
        for k, surface in enumerate(GOWN_SURFACES):
            assert (told[5 * k + 1 : 5 * k + 4, :13] == surface).all()
        assert not np.isin(told[:, 17:], GOWN_SURFACES).any()
