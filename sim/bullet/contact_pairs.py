"""Which capsules of the robot reach into which of the person: the nearest points of all pairs, compiled."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..compiled import njit

FAR = 0.1  # of pairs farther apart only a lower bound of the distance is computed [m]
MOST = 64  # overlaps that are kept; a hand with all its fingers on the trunk makes ten


@dataclass(frozen=True, kw_only=True)
class Capsules:
    """Capsules at one instant, n of them.

    Attributes:
        ends: (n, 2, 3) of their axes [m].
        speed: (n, 2, 3) of these ends [m/s].
        radii: (n,) [m].
    """

    ends: np.ndarray
    speed: np.ndarray
    radii: np.ndarray


@dataclass(frozen=True, kw_only=True)
class Overlaps:
    """Pairs of capsules that reach into each other, n of them.

    Attributes:
        robot: (n,) int, which capsule of the robot.
        person: (n,) int, which capsule of the person.
        depth: (n,) how far [m].
        normal: (n, 3) unit, from the person to the robot.
        point: (n, 3) midway between the two surfaces [m].
        speed: (n, 3) of the robot relative to the person there [m/s].
        gap: between the surfaces of the nearest pair, negative where any overlap; a lower bound above `FAR` [m].
    """

    robot: np.ndarray
    person: np.ndarray
    depth: np.ndarray
    normal: np.ndarray
    point: np.ndarray
    speed: np.ndarray
    gap: float


def overlaps(robot: Capsules, person: Capsules, ignored: np.ndarray) -> Overlaps:
    """All overlaps between the capsules of the robot, r, and of the person, p.

    Args:
        robot: its links.
        person: the parts of the body.
        ignored: (r, p) bool, pairs that may overlap.
    """
    index, numbers = np.empty((MOST, 2), np.int64), np.empty((MOST, 10))
    count, gap = _search(
        robot.ends, robot.speed, robot.radii, person.ends, person.speed, person.radii, ignored, index, numbers
    )
    index, numbers = index[:count], numbers[:count]
    return Overlaps(
        robot=index[:, 0],
        person=index[:, 1],
        depth=numbers[:, 0],
        normal=numbers[:, 1:4],
        point=numbers[:, 4:7],
        speed=numbers[:, 7:10],
        gap=gap,
    )


@njit()
def _search(robot, robot_speed, robot_radii, person, person_speed, person_radii, ignored, index, numbers):
    """Fill `index` (MOST, 2) and `numbers` (MOST, 10); returns how many and the smallest gap."""
    count, least = 0, np.inf
    away = np.empty(3)
    for i in range(robot.shape[0]):
        for j in range(person.shape[0]):
            if ignored[i, j]:
                continue
            reach = robot_radii[i] + person_radii[j]
            apart = _apart(robot[i], person[j]) - reach
            if apart > FAR:
                least = min(least, apart)
                continue
            s, t = _nearest(robot[i], person[j])
            square = 0.0
            for k in range(3):
                on_robot = robot[i, 0, k] + s * (robot[i, 1, k] - robot[i, 0, k])
                away[k] = on_robot - person[j, 0, k] - t * (person[j, 1, k] - person[j, 0, k])
                square += away[k] * away[k]
            distance = np.sqrt(square)
            least = min(least, distance - reach)
            if distance >= reach or count == MOST:
                continue
            index[count, 0], index[count, 1] = i, j
            numbers[count, 0] = reach - distance
            for k in range(3):
                # where the axes meet, out to the front of the body, which is up
                normal = away[k] / distance if distance > 1e-9 else (1.0 if k == 2 else 0.0)
                skin = person[j, 0, k] + t * (person[j, 1, k] - person[j, 0, k]) + normal * person_radii[j]
                here = robot_speed[i, 0, k] + s * (robot_speed[i, 1, k] - robot_speed[i, 0, k])
                there = person_speed[j, 0, k] + t * (person_speed[j, 1, k] - person_speed[j, 0, k])
                numbers[count, 1 + k] = normal
                numbers[count, 4 + k] = skin - 0.5 * (reach - distance) * normal
                numbers[count, 7 + k] = here - there
            count += 1
    return count, least


@njit(inline="always")
def _apart(one, other):
    """Distance of the balls round two segments (2, 3) [m]: their capsules are not nearer by more than the radii."""
    between, own, its = 0.0, 0.0, 0.0
    for k in range(3):
        between += (one[0, k] + one[1, k] - other[0, k] - other[1, k]) ** 2
        own += (one[1, k] - one[0, k]) ** 2
        its += (other[1, k] - other[0, k]) ** 2
    return 0.5 * (np.sqrt(between) - np.sqrt(own) - np.sqrt(its))


@njit(inline="always")
def _nearest(one, other):
    """Where two segments (2, 3) come nearest, as shares of their lengths (Ericson, Real-Time Collision Detection)."""
    uu, vv, uv, uw, vw = 1e-12, 1e-12, 0.0, 0.0, 0.0
    for k in range(3):
        u, v, w = one[1, k] - one[0, k], other[1, k] - other[0, k], one[0, k] - other[0, k]
        uu += u * u
        vv += v * v
        uv += u * v
        uw += u * w
        vw += v * w
    square = uu * vv - uv * uv
    s = 0.5  # parallel: any start does, the middle is the least arbitrary
    if square > 1e-6 * uu * vv:
        s = min(max((uv * vw - vv * uw) / square, 0.0), 1.0)
    t = min(max((uv * s + vw) / vv, 0.0), 1.0)
    return min(max((uv * t - uw) / uu, 0.0), 1.0), t
