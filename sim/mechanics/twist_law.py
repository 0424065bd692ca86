"""What a hand that follows a twist does within one period, in the map, compiled."""

from __future__ import annotations

import math

import numpy as np

from ..compiled import njit
from .rotation_vector import rotation, rotation_vector

_GAIN = 8.0  # of the position feedback that takes out the drift of integrating joint rates [1/s]
# How fast a joint may go through the room: so many times as fast as the hand is to go, a turn of it counting as that of
# a hand so long, and never less, for the feedback.  With joints at their limits an elbow went four times as fast.
_SWING, _SWING_TURN, _SWING_LEAST = 1.25, 0.3, 0.05  # [1, m, m/s]
_FULL_PACE = (0.1, 0.5)  # [m/s, rad/s]
_MAX_LAG = (0.01, 0.06)  # the pose to follow never runs further ahead than this [m, rad]


@njit()
def ramp(twist: np.ndarray, wanted: np.ndarray, change: float, turn: float) -> float:
    """Bring a twist (6,), in place, nearer to the wanted one by at most so much [m/s], [rad/s]; its greatest part."""
    for first, most in ((0, change), (3, turn)):
        missing = wanted[first : first + 3] - twist[first : first + 3]
        twist[first : first + 3] += missing * min(1.0, most / max(_length(missing), 1e-12))
    return np.max(np.abs(twist))


@njit()
def lead(
    goal: np.ndarray, twist: np.ndarray, dt: float, base: np.ndarray, twist_base: np.ndarray, hand: np.ndarray
) -> np.ndarray:
    """Move the pose to follow on, and tell how the arm is to move the hand after it.

    The pose to follow stays within `_MAX_LAG` of where the hand is: it must not wind up at a limit.

    Args:
        goal: (4, 4) pose to follow in the map; moved on in place.
        twist: (6,) of the hand [m/s, rad/s].
        dt: period [s].
        base: (4, 4) pose of the base in the map.
        twist_base: (3,) velocity of the base in its own frame [m/s, m/s, rad/s].
        hand: (4, 4) pose of the hand in the map.

    Returns:
        Velocity (6,) that the arm gives the hand, along the hand's axes [m/s, rad/s].
    """
    offset = goal[:3, 3] + twist[:3] * dt - hand[:3, 3]
    offset *= min(1.0, _MAX_LAG[0] / max(_length(offset), 1e-12))
    turned = _times(rotation(twist[3:] * dt), goal)
    turn = rotation_vector(_times(turned, hand.T))
    angle = _length(turn)
    if angle > _MAX_LAG[1]:
        turn *= _MAX_LAG[1] / angle
        turned = _times(rotation(turn), hand)
    goal[:3, 3] = hand[:3, 3] + offset
    goal[:3, :3] = turned
    velocity = np.empty((2, 3))
    velocity[0] = twist[:3] + _GAIN * offset
    velocity[1] = twist[3:] + _GAIN * turn
    for k in range(2):  # the moving base gives it some already
        velocity[0, k] -= base[k, 0] * twist_base[0] + base[k, 1] * twist_base[1]
    velocity[0, 0] += twist_base[2] * (hand[1, 3] - base[1, 3])
    velocity[0, 1] -= twist_base[2] * (hand[0, 3] - base[0, 3])
    velocity[1, 2] -= twist_base[2]
    along = np.zeros(6)
    for part in range(2):
        for k in range(3):
            for m in range(3):
                along[3 * part + k] += velocity[part, m] * hand[m, k]
    return along


@njit()
def pace(twist: np.ndarray) -> float:
    """How fast a twist (6,) moves the hand, from 0 to 1.

    Where the hand stands, the elbow stands too: a guard that slows a hand down as a link comes near to something must
    not see that link go on by itself.
    """
    return min(1.0, _length(twist[:3]) / _FULL_PACE[0] + _length(twist[3:]) / _FULL_PACE[1])


@njit()
def swing_allowed(twist: np.ndarray, base: np.ndarray, twist_base: np.ndarray, hand: np.ndarray) -> float:
    """How fast a joint may go [m/s], seen from the base, while the hand follows a twist; arguments as in `lead`."""
    x, y = hand[0, 3] - base[0, 3], hand[1, 3] - base[1, 3]
    wanted = _length(twist[:3]) + _SWING_TURN * _length(twist[3:])
    carried = math.sqrt(twist_base[0] ** 2 + twist_base[1] ** 2) + abs(twist_base[2]) * math.sqrt(x * x + y * y)
    return max(_SWING_LEAST, _SWING * (wanted + carried))


@njit()
def swing(jacobian: np.ndarray, places: np.ndarray, rates: np.ndarray) -> float:
    """How fast the fastest of an arm's joints goes [m/s], seen from the base.

    Args:
        jacobian: (6, n) of the hand, linear before angular.
        places: (n, 3) of the joints, seen from the hand along the same axes [m].
        rates: (n,) of the joints [rad/s].
    """
    fastest, v, w = 0.0, np.zeros(3), np.zeros(3)  # of the hand, were it moved by the joints so far alone
    for n in range(len(rates) - 1):
        for k in range(3):
            v[k] += jacobian[k, n] * rates[n]
            w[k] += jacobian[3 + k, n] * rates[n]
        x, y, z = places[n + 1]
        fastest = max(
            fastest,
            math.sqrt(
                (v[0] + w[1] * z - w[2] * y) ** 2
                + (v[1] + w[2] * x - w[0] * z) ** 2
                + (v[2] + w[0] * y - w[1] * x) ** 2
            ),
        )
    return fastest


@njit(inline="always")
def _length(vector: np.ndarray) -> float:
    return math.sqrt(vector[0] * vector[0] + vector[1] * vector[1] + vector[2] * vector[2])


@njit(inline="always")
def _times(A: np.ndarray, B: np.ndarray) -> np.ndarray:
    """Product (3, 3) of two rotations, or of the rotations of poses: without BLAS, which scipy would have to load."""
    product = np.zeros((3, 3))
    for i in range(3):
        for j in range(3):
            for k in range(3):
                product[i, j] += A[i, k] * B[k, j]
    return product
