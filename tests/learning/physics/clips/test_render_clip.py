from dataclasses import replace

import numpy as np
import pytest
from caretree.learning.physics.clips.camera import standard_camera
from caretree.learning.physics.clips.clip import SIZE
from caretree.learning.physics.clips.parameters import HIGH, LOW, NAMES, to_spec
from caretree.learning.physics.clips.render_clip import render_clip
from caretree.learning.physics.engine.fall import FRAMES
from caretree.sim.errors import CaretreeError
from caretree.sim.scene.gown import GOWNS


def test_a_clip_is_what_a_method_expects(small_gown):
    clip = render_clip(small_gown)
    assert clip.depth.shape == (FRAMES, SIZE, SIZE)
    assert clip.depth.dtype == np.float32
    assert 1.5 < np.nanmin(clip.depth) < np.nanmax(clip.depth) < 4.0


def test_the_released_side_falls_and_the_held_one_does_not(small_gown):
    seen = np.isfinite(render_clip(small_gown).depth)
    columns = np.flatnonzero(seen[0].any(axis=0))
    left, right = columns[:4], columns[-4:]  # the wearer's left is the picture's right, and held

    def top(frame, where):
        return np.flatnonzero(seen[frame][:, where].any(axis=1)).min()

    assert abs(top(14, right) - top(0, right)) <= 3
    assert top(14, left) - top(0, left) >= 8 or not seen[14][:, left].any()


def test_the_same_seed_gives_the_same_bytes(small_gown):
    assert render_clip(small_gown).depth.tobytes() == render_clip(small_gown).depth.tobytes()
    one, two, other = (render_clip(small_gown, seed=seed, disturbed=True) for seed in (1, 1, 2))
    assert one.depth.tobytes() == two.depth.tobytes() != other.depth.tobytes()


def test_a_disturbed_clip_has_lost_pixels_and_says_the_nominal_camera(small_gown):
    clean, spoilt = render_clip(small_gown), render_clip(small_gown, seed=1, disturbed=True)
    assert np.isfinite(spoilt.depth).sum() < 0.95 * np.isfinite(clean.depth).sum()
    np.testing.assert_array_equal(spoilt.pose_camera_in_map, standard_camera().pose_camera_in_map)


@pytest.mark.parametrize("engine", ["fast", "bullet"])
def test_friction_does_not_show(still_air, engine):
    """Nothing touches the gown: that is why friction is no identifiable parameter of a clip."""
    clips = [render_clip(replace(still_air, friction=friction), engine=engine).depth for friction in (0.04, 2.0)]
    assert clips[0].tobytes() == clips[1].tobytes()


@pytest.mark.parametrize("name", [name for name in NAMES if name != "friction"])
def test_every_other_parameter_shows(small_gown, name):
    k = NAMES.index(name)
    low, high = (
        render_clip(replace(small_gown, **{name: float(value)})).depth
        for value in (LOW[k] ** 0.7 * HIGH[k] ** 0.3, LOW[k] ** 0.3 * HIGH[k] ** 0.7)
    )
    both = np.isfinite(low) & np.isfinite(high)
    assert np.abs(low - high)[both].mean() > 0.003


@pytest.mark.parametrize("corner", [0.0, 1.0])
def test_the_ends_of_the_range_can_be_rendered(corner, small_gown):
    render_clip(to_spec(np.full(6, corner), small_gown))


def test_bad_requests_are_refused():
    with pytest.raises(CaretreeError, match="unknown engine 'blender'; there are fast, bullet"):
        render_clip(GOWNS["medium"], engine="blender")
    with pytest.raises(CaretreeError, match="needs steps of"):
        render_clip(replace(GOWNS["medium"], elastic=1e6))
