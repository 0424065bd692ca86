"""Places of poses are those that scipy tells."""

import numpy as np
from caretree.sim.mechanics.quaternion import places
from scipy.spatial.transform import Rotation


def test_places_are_those_of_scipy():
    rng = np.random.default_rng(2)
    half = np.pi * np.concatenate((np.eye(3), -np.eye(3)))
    turns = Rotation.concatenate(
        [Rotation.random(500, random_state=rng), Rotation.from_rotvec(half), Rotation.from_rotvec(np.zeros((1, 3)))]
    )
    poses = np.tile(np.eye(4), (len(turns), 1, 1))
    poses[:, :3, :3], poses[:, :3, 3] = turns.as_matrix(), rng.normal(size=(len(turns), 3))
    found = places(poses)
    np.testing.assert_array_equal(found[:, :3], poses[:, :3, 3])
    np.testing.assert_allclose(found[:, 3:], Rotation.from_matrix(poses[:, :3, :3]).as_quat(), rtol=0, atol=1e-15)
