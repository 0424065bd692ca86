"""Force sensors of the wrists."""

import numpy as np
from caretree.sim.scene.difficulties import stream
from caretree.sim.sensors.wrist_sensors import WristSensors
from scipy.spatial.transform import Rotation

RNG = np.random.default_rng(0)
POSES = np.tile(np.eye(4), (200, 2, 1, 1))
POSES[..., :3, :3] = Rotation.random(400, rng=RNG).as_matrix().reshape(200, 2, 3, 3)
DRAWN = [WristSensors.drawn(stream(seed, "wrench_bias")) for seed in range(100, 200)]
NOTHING = np.zeros((2, 6))


def test_exact_sensors_report_what_pulls():
    wrench = RNG.standard_normal((2, 6))
    np.testing.assert_allclose(WristSensors().measured(wrench, POSES[0], POSES[0]), wrench, atol=1e-12)


def test_a_bias_of_half_a_newton_turns_with_the_hand():
    bias = np.array([sensors.bias for sensors in DRAWN])
    np.testing.assert_allclose(np.linalg.norm(bias[..., :3], axis=-1), 0.5)
    np.testing.assert_allclose(np.linalg.norm(bias[..., 3:], axis=-1), 0.02)
    assert np.abs(bias.mean(axis=0)).max() < 0.1
    only = WristSensors(bias=bias[0])
    for poses in POSES[:5]:
        reported = only.measured(NOTHING, poses, poses)
        for n in range(2):
            np.testing.assert_allclose(poses[n, :3, :3].T @ reported[n, :3], bias[0, n, :3], atol=1e-12)


def test_what_is_left_of_gravity_depends_on_the_hand_and_is_of_real_size():
    residue = []
    for sensors, poses in zip(DRAWN, POSES, strict=False):
        unbiased = WristSensors(mass_taken=sensors.mass_taken, centre_error=sensors.centre_error, tilt=sensors.tilt)
        residue.append(unbiased.measured(NOTHING, poses, poses))
    force, torque = (np.linalg.norm(np.array(residue)[..., part], axis=-1) for part in (np.s_[:3], np.s_[3:]))
    assert 0.1 < np.median(force) < 0.3
    assert force.max() < 0.6
    assert 0.01 < np.median(torque) < 0.08
    sensors = DRAWN[0]
    turning = np.array([sensors.measured(NOTHING, poses, poses)[0, :3] for poses in POSES])
    assert turning.std(axis=0).min() > 0.1


def test_a_hand_that_is_taken_to_be_turned_feels_its_own_weight():
    told = POSES[0].copy()
    told[:, :3, :3] = Rotation.from_rotvec((np.deg2rad(1.0), 0.0, 0.0)).as_matrix() @ told[:, :3, :3]
    reported = WristSensors().measured(NOTHING, POSES[0], told)
    np.testing.assert_allclose(np.abs(reported[:, 1]), 0.9 * 9.81 * np.sin(np.deg2rad(1.0)), rtol=1e-6)


def test_the_load_itself_comes_through():
    pull = np.array((0.0, 0.0, -10.0, 0.0, 0.0, 0.0))
    for sensors in DRAWN[:20]:
        more = sensors.measured(np.tile(pull, (2, 1)), POSES[0], POSES[0]) - sensors.measured(
            NOTHING, POSES[0], POSES[0]
        )
        assert np.abs(more[:, :3] - pull[:3]).max() < 10.0 * np.sin(np.deg2rad(2.0))
