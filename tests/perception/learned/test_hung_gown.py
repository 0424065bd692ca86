"""Corners of a hung gown: key points set on the edge of their sheet, and what is refused."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure
from caretree.perception.image.surfaces import Surface
from caretree.perception.learned.hung_gown import HungGown, on_edge
from caretree.perception.learned.learned_sight import LearnedSight
from caretree.perception.learned.sight import KeyPoint, Sight
from caretree.sim.world import Frame

HOOK = np.array((0.0, 1.0, 0.4))
FOCUS = 200.0
PIXEL = 1.0 / FOCUS  # of a sheet 1 m away [m]


def sheet(behind=3.0, strip=None):
    """A sheet 1 m ahead that ends on the left at column 50, `strip` (columns) of other cloth 3 cm behind its edge."""
    depth = np.full((120, 160), behind, np.float32)
    depth[20:, 50:] = 1.0
    gown = np.zeros((120, 160), bool)
    gown[20:, 50:] = True
    if strip is not None:
        depth[20:, strip] = 1.03
        gown[20:, strip] = True
    pose = np.eye(4)
    pose[:3, :3] = np.array(((1, 0, 0), (0, 0, 1), (0, -1, 0)), float)  # level, along y
    frame = Frame(
        camera="head",
        stamp=2.0,
        rgb=np.zeros((120, 160, 3), np.uint8),
        depth=depth,
        intrinsics=(FOCUS, FOCUS, 79.5, 59.5),
        pose_camera_in_map=pose,
    )
    return frame, gown


def place_of(u, v, depth=1.0):
    return np.array(((u - 79.5) / FOCUS * depth, depth, -(v - 59.5) / FOCUS * depth))


@pytest.mark.parametrize("off", [-3.0, 0.0, 4.0])
def test_a_corner_is_set_just_inside_of_the_edge_it_is_nearest_to(off):
    frame, gown = sheet()
    place, crowded = on_edge(frame, gown, np.array((50.0 + off, 80.0)))
    assert np.allclose(place[1:], place_of(50, 80)[1:], atol=1.5 * PIXEL)
    assert 0.0 < place[0] - place_of(49.5, 80)[0] < 0.01
    assert not crowded


def test_other_cloth_beside_it_is_told():
    frame, gown = sheet(strip=slice(44, 50))
    place, crowded = on_edge(frame, gown, np.array((50.0, 80.0)))
    assert abs(place[1] - 1.0) < 0.01
    assert crowded


def test_an_outline_that_is_the_background_s_is_no_sheet():
    frame, gown = sheet(behind=1.5, strip=None)
    gown[20:, 47:50] = True  # three columns of wall are taken for gown
    place, crowded = on_edge(frame, gown, np.array((47.0, 80.0)))
    assert abs(place[1] - 1.0) < 0.01
    assert not crowded


def test_where_no_gown_is_there_is_no_corner():
    frame, gown = sheet()
    with pytest.raises(PerceptionFailure):
        on_edge(frame, np.zeros_like(gown), np.array((50.0, 80.0)))
    speck = np.zeros_like(gown)
    speck[80, 50:53] = True
    with pytest.raises(PerceptionFailure):
        on_edge(frame, speck, np.array((50.0, 80.0)))


class Seen(LearnedSight):
    """Sees what it is told."""

    def __init__(self, gown, left, right=0.0):
        surfaces = np.where(gown, Surface.OUTSIDE, Surface.OTHER).astype(np.uint8)
        self.tuning = self._tuning = LearnedSight(object())._tuning
        points = {
            f"corner_{side}": KeyPoint(confidence=chance, position_in_map=None, pixel=np.array((50.0, row)))
            for side, chance, row in (("left", left, 80.0), ("right", right, 100.0))
        }
        ones = np.ones(gown.shape, np.float32)
        self.seen = Sight(surfaces=surfaces, confidence=ones, sheet=np.stack([ones] * 3, 2), key_points=points)

    def sight(self, frame):
        return self.seen


def test_the_corner_that_is_told_most_surely_is_shown():
    frame, gown = sheet()
    hung = HungGown(Seen(gown, 0.7, 0.8))
    hook = place_of(50, 20)
    assert hung.shown_corner(frame, hook).target == "collar_corner_right"
    found = hung.shown_corner(frame, hook, "left")
    assert (found.target, found.confidence, found.stamp) == ("collar_corner_left", 0.7, 2.0)
    assert abs(found.approach_in_map[2]) < 1e-9
    assert hung.side(frame).outside


def test_a_corner_beside_other_cloth_is_less_sure_unless_that_does_not_matter():
    frame, gown = sheet(strip=slice(44, 50))
    hung, hook = HungGown(Seen(gown, 0.9)), place_of(50, 20)
    assert hung.corner(frame, "left", hook).confidence < 0.5
    assert hung.corner(frame, "left", hook, beside_matters=False).confidence == 0.9


def test_what_is_not_sure_or_not_there_is_refused():
    frame, gown = sheet()
    hook = place_of(50, 20)
    with pytest.raises(PerceptionFailure, match="left corner"):
        HungGown(Seen(gown, 0.4)).corner(frame, "left", hook)
    hung = HungGown(Seen(gown, 0.4))
    assert hung.corner(frame, "left", hook, near_in_map=place_of(50, 82)).confidence == 0.4
    with pytest.raises(PerceptionFailure, match="left corner"):
        hung.corner(frame, "left", hook, near_in_map=place_of(50, 110))
    with pytest.raises(PerceptionFailure, match="left corner"):
        HungGown(Seen(gown, 0.9)).corner(frame, "left", place_of(50, 75))
