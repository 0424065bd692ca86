"""Sums between what sensors tell and what the contract asks for: loads of the hands, and where the base stands."""

from __future__ import annotations

import numpy as np

from .site import Wrist, transform

GRAVITY = 9.81  # [m/s^2]


def load_at_hand(measured: np.ndarray, wrist: Wrist, turn_hand: np.ndarray) -> np.ndarray:
    """What pulls at a hand, without what its sensor always carries.

    Args:
        measured: (6,) force and torque along the sensor's axes [N], [N m].
        wrist: calibration.
        turn_hand: (3, 3) axes of the hand in the map.

    Returns:
        (6,) force and torque about the hand point, along the axes of the map.
    """
    turn, at_sensor, weight, of_weight = _parts(wrist, turn_hand)
    unloaded = measured - wrist.zero
    force = turn @ unloaded[:3]
    torque = turn @ unloaded[3:] + np.cross(at_sensor, force)
    return np.concatenate((force - weight, torque - of_weight))


def felt_by_sensor(load: np.ndarray, wrist: Wrist, turn_hand: np.ndarray) -> np.ndarray:
    """What a sensor (6,) says of a load (6,) on its hand: the other way round."""
    turn, at_sensor, weight, of_weight = _parts(wrist, turn_hand)
    force = load[:3] + weight
    torque = load[3:] + of_weight - np.cross(at_sensor, force)
    return np.concatenate((turn.T @ force, turn.T @ torque)) + wrist.zero


def _parts(wrist: Wrist, turn_hand: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Axes of the sensor and its place from the hand, the weight that it carries and its torque about the hand."""
    sensor = transform(wrist.xyz, wrist.rpy)
    weight = np.array((0.0, 0.0, -GRAVITY * wrist.mass))
    return (
        turn_hand @ sensor[:3, :3],
        turn_hand @ sensor[:3, 3],
        weight,
        np.cross(turn_hand @ np.array(wrist.centre), weight),
    )


def way_between(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """The way (3,) from one pose (3,) of a base to another, along the axes of the first [m, m, rad]."""
    c, s = np.cos(first[2]), np.sin(first[2])
    x, y = second[:2] - first[:2]
    return np.array((c * x + s * y, c * y - s * x, second[2] - first[2]))


def carried_on(pose: np.ndarray, way: np.ndarray) -> np.ndarray:
    """Where a base (3,) stands after a way (3,) along its own axes, yaw within -pi and pi [m, m, rad]."""
    c, s = np.cos(pose[2]), np.sin(pose[2])
    yaw = (pose[2] + way[2] + np.pi) % (2.0 * np.pi) - np.pi
    return np.array((pose[0] + c * way[0] - s * way[1], pose[1] + s * way[0] + c * way[1], yaw))
