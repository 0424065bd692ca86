"""Whether solids are far from each other for sure: most postures are told free so, and only the others need coal."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..compiled import fma, njit
from .shape import Shape

SLACK = 1e-4  # [m] more than what coal's iterations are off, so that it would say the same


@dataclass(frozen=True, kw_only=True, eq=False)
class Solid:
    """A shape fixed to a joint.

    Attributes:
        joint: index of it.
        shape: box or capsule.
        turn: (3, 3) its axes as columns, in the frame of the joint.
        centre: (3,) in that frame [m].
    """

    joint: int
    shape: Shape
    turn: np.ndarray
    centre: np.ndarray


class FarApart:
    """A lower bound of the distance of pairs of solids, of which one is a segment with a radius round it.

    A segment that does not reach as far as a box along one of the box's axes is at least so far from it; along several
    axes at once, by Pythagoras.  A capsule counts as a box without width, with its radius round it.

    Args:
        solids: boxes and capsules.
        pairs: (p, 2) indices of those whose distances count.
    """

    def __init__(self, solids: Sequence[Solid], pairs: Sequence[tuple[int, int]]) -> None:
        self._pairs = np.array(pairs, np.int64).reshape(-1, 2)
        self._joints = np.array([solid.joint for solid in solids], np.int64)
        self._turns = np.array([solid.turn for solid in solids], float).reshape(-1, 3, 3)
        self._centres = np.array([solid.centre for solid in solids], float).reshape(-1, 3)
        self._halves = np.array([_half(solid.shape) for solid in solids]).reshape(-1, 3)
        self._round = np.array([solid.shape.size[0] if solid.shape.kind == "capsule" else 0.0 for solid in solids])
        longest = self._halves.argmax(axis=1)
        along = np.eye(3)[longest] * self._halves  # (n, 3) from the centre to the end of the segment
        self._wide = self._round + np.linalg.norm(self._halves - along, axis=1)
        arm = np.einsum("nij,nj->ni", self._turns, along)
        self._ends = np.ascontiguousarray(np.stack((self._centres - arm, self._centres + arm), axis=1))

    def all(self, places: np.ndarray, margin: float) -> bool:
        """Whether no pair can be nearer than `margin` [m]; False says nothing.

        Args:
            places: (joints, 12) pose of every joint: rotation by columns, then place (`joint_places`).
            margin: distance between the surfaces [m].
        """
        return _all_far(
            places,
            self._joints,
            self._turns,
            self._centres,
            self._halves,
            self._round,
            self._ends,
            self._wide,
            self._pairs,
            margin + SLACK,
        )


def _half(shape: Shape) -> np.ndarray:
    """Half the edges (3,) of the box that a shape is, or of a capsule's segment [m]."""
    return np.array((0.0, 0.0, shape.size[1]) if shape.kind == "capsule" else shape.size, float) / 2.0


@njit()
def _all_far(
    places: np.ndarray,
    joints: np.ndarray,
    turns: np.ndarray,
    centres: np.ndarray,
    halves: np.ndarray,
    rounds: np.ndarray,
    ends: np.ndarray,
    wide: np.ndarray,
    pairs: np.ndarray,
    margin: float,
) -> bool:
    axes, middle, tips = np.empty((len(joints), 3, 3)), np.empty((len(joints), 3)), np.empty((len(joints), 2, 3))
    for n in range(len(joints)):
        place = places[joints[n]]
        for k in range(3):
            middle[n, k] = _placed(place, centres[n], k) + place[9 + k]
            tips[n, 0, k] = _placed(place, ends[n, 0], k) + place[9 + k]
            tips[n, 1, k] = _placed(place, ends[n, 1], k) + place[9 + k]
            for axis in range(3):
                axes[n, axis, k] = _placed(place, turns[n, :, axis], k)
    for p in range(len(pairs)):
        a, b = pairs[p, 0], pairs[p, 1]
        if (
            _bound(tips[a], axes[b], middle[b], halves[b]) - wide[a] - rounds[b] <= margin
            and _bound(tips[b], axes[a], middle[a], halves[a]) - wide[b] - rounds[a] <= margin
        ):
            return False
    return True


@njit()
def _placed(place: np.ndarray, vector: np.ndarray, k: int) -> float:
    return fma(vector[2], place[6 + k], fma(vector[1], place[3 + k], vector[0] * place[k]))


@njit()
def _bound(tips: np.ndarray, axes: np.ndarray, middle: np.ndarray, half: np.ndarray) -> float:
    """Distance at least of a segment (2, 3) from a box with axes (3, 3) as rows [m]."""
    square = 0.0
    for axis in range(3):
        one = other = 0.0
        for k in range(3):
            one += (tips[0, k] - middle[k]) * axes[axis, k]
            other += (tips[1, k] - middle[k]) * axes[axis, k]
        apart = max(min(one, other) - half[axis], -max(one, other) - half[axis], 0.0)
        square += apart * apart
    return np.sqrt(square)
