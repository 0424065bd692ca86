"""Cameras that are not quite where they should be."""

import numpy as np
from caretree.sim.scene.difficulties import stream
from caretree.sim.sensors.camera_extrinsics import camera_errors
from caretree.sim.world import CAMERAS
from scipy.spatial.transform import Rotation

DRAWN = np.array([list(camera_errors(stream(seed, "camera_extrinsics")).values()) for seed in range(100, 200)])


def test_every_camera_has_an_error_of_its_own():
    assert tuple(camera_errors(stream(100, "camera_extrinsics"))) == CAMERAS
    assert len(np.unique(DRAWN[:, :, 0, 3])) == 300


def test_they_are_off_by_five_millimetres_in_any_direction():
    offset = DRAWN[..., :3, 3]
    np.testing.assert_allclose(np.linalg.norm(offset, axis=-1), 0.005)
    assert np.abs(offset.mean(axis=(0, 1))).max() < 0.0006


def test_they_are_turned_by_half_a_degree_to_one_about_any_axis():
    turns = np.rad2deg(Rotation.from_matrix(DRAWN[..., :3, :3].reshape(-1, 3, 3)).as_rotvec())
    angles = np.linalg.norm(turns, axis=1)
    assert 0.5 <= angles.min() < 0.52
    assert 0.98 < angles.max() <= 1.0
    assert np.abs(turns.mean(axis=0)).max() < 0.08


def test_the_same_seed_is_the_same_error():
    again = np.array(list(camera_errors(stream(100, "camera_extrinsics")).values()))
    np.testing.assert_array_equal(again, DRAWN[0])
