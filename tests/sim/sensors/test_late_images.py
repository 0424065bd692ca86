"""Images that arrive late."""

from types import SimpleNamespace

import numpy as np
from caretree.sim.scene.difficulties import SIZES, stream
from caretree.sim.sensors.late_images import LateImages
from caretree.sim.world import CAMERAS

STEP = 0.0025  # of the room [s]


def pass_time(late, until):
    for k in range(round(until / STEP)):
        if late.due(k * STEP):
            late.keep(SimpleNamespace(time=k * STEP))


def test_images_are_50_to_150_ms_old_and_each_camera_has_its_own_latency():
    ages = []
    for seed in range(100, 140):
        late = LateImages(stream(seed, "late_images"))
        assert len(set(late.latency.values())) == len(CAMERAS)
        pass_time(late, 0.5)
        for now in 0.5 + np.linspace(0.0, 0.02, 5):
            ages += [now - late.newest(camera, now).time for camera in CAMERAS]
    assert 0.05 <= min(ages) < 0.06
    assert 0.13 < max(ages) <= 0.15 + STEP


def test_a_camera_takes_one_image_in_30_ms_and_shows_it_until_the_next():
    late = LateImages(stream(100, "late_images"))
    pass_time(late, 0.3)
    shown = [late.newest("head", 0.3 + k * STEP).time for k in range(12)]
    assert len(set(shown)) <= 2
    taken = np.array(shown) / SIZES.late_images.period
    np.testing.assert_allclose(taken, np.round(taken), atol=1e-9)


def test_the_first_image_shows_until_another_arrives_and_nothing_before_it():
    late = LateImages(stream(100, "late_images"))
    assert late.newest("head", 0.0) is None
    pass_time(late, 0.04)
    assert late.newest("head", 0.04).time == 0.0
