import numpy as np
from caretree.learning.physics.clips.depth_holes import fill_depth_holes
from caretree.learning.physics.clips.depth_noise import disturb
from caretree.learning.physics.clips.frames import look_at
from caretree.learning.physics.clips.render_clip import render_clip
from caretree.sim.scene.gown import GOWNS


def disc(radius=20):
    y, x = np.mgrid[:64, :64] - 31.5
    depth = np.full((3, 64, 64), np.nan, np.float32)
    depth[:, x**2 + y**2 < radius**2] = 2.5
    return depth


def test_holes_close_with_the_depth_around_them():
    holed = disc()
    holed[1, 30:33, 30:33] = np.nan
    holed[1, 20, 40] = np.nan
    closed, share = fill_depth_holes(holed)
    np.testing.assert_allclose(closed[1], disc()[1])
    assert share == np.float64(10 / np.isfinite(holed).sum())


def test_what_was_there_stays_as_it_was():
    noisy = disturb(disc(), np.random.default_rng(0))
    closed, _ = fill_depth_holes(noisy)
    there = np.isfinite(noisy)
    np.testing.assert_array_equal(closed[there], noisy[there])


def test_a_large_gap_and_the_outside_stay_open():
    holed = disc()
    holed[:, 20:44, 20:44] = np.nan
    closed, _ = fill_depth_holes(holed)
    assert np.isnan(closed[:, 26:38, 26:38]).all()
    assert np.isnan(closed[:, :8]).all()


def test_gaps_tell_a_cameras_clip_from_a_rendered_one():
    gown = GOWNS["medium"]
    clips = [render_clip(gown, disturbed=disturbed).depth for disturbed in (False, True)]
    assert look_at(np.array(clips)).rough.tolist() == [False, True]
