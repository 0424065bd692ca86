"""Cubic splines through waypoints: scipy's to the last bit, without what takes longer to load than motions to plan."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np

Condition = tuple[int, np.ndarray]  # order 1 and the slope (m,) at that end
Conditions = Literal["not-a-knot"] | tuple[Condition, Condition]


class CubicSpline:
    """What `scipy.interpolate.CubicSpline` is to toppra: a path with two continuous derivatives, or one of those.

    Args:
        x: (n,) places of the points, ascending.
        y: (n, m) points.
        bc_type: the slopes at both ends, or that the two pieces at each end are one.
    """

    def __init__(self, x: np.ndarray, y: np.ndarray, bc_type: Conditions = "not-a-knot") -> None:
        self._x, y = np.asarray(x, float), np.asarray(y, float)
        steps = np.diff(self._x)
        if len(self._x) < 2 or not (steps > 0.0).all() or not np.isfinite(y).all():
            raise ValueError("a spline takes two and more finite points at ascending places")
        slopes = _slopes(self._x, steps[:, None], y, bc_type)
        mean = np.diff(y, axis=0) / steps[:, None]
        bend = (slopes[:-1] + slopes[1:] - 2 * mean) / steps[:, None]
        # (4, n - 1, m) factors of the powers of the way from the last point, the highest first
        self._powers = np.stack(
            (bend / steps[:, None], (mean - slopes[:-1]) / steps[:, None] - bend, slopes[:-1], y[:-1])
        )

    def derivative(self) -> CubicSpline:
        """The slope of this one."""
        spline = object.__new__(CubicSpline)
        spline._x = self._x
        spline._powers = self._powers[:-1] * np.arange(len(self._powers) - 1.0, 0.0, -1.0)[:, None, None]
        return spline

    def __call__(self, at: Any) -> np.ndarray:
        """Values (..., m) at places (...)."""
        places = np.asarray(at, float)
        flat = places.ravel()
        piece = np.clip(np.searchsorted(self._x, flat, side="right") - 1, 0, len(self._x) - 2)
        way = (flat - self._x[piece])[:, None]
        *higher, values = self._powers[:, piece]
        power = way
        for n, factors in enumerate(reversed(higher)):
            power = power * way if n else way
            values = values + factors * power
        return values.reshape(*places.shape, -1)


def _slopes(x: np.ndarray, steps: np.ndarray, y: np.ndarray, ends: Conditions) -> np.ndarray:
    """Slopes (n, m) at the points: what makes the second derivative continuous is a system of three diagonals."""
    from scipy.linalg import solve, solve_banded

    mean = np.diff(y, axis=0) / steps
    if len(x) == 2 and isinstance(ends, str):
        ends = ((1, mean[0]), (1, mean[0]))
    step = steps[:, 0]
    right = np.empty_like(y)
    right[1:-1] = 3 * (steps[1:] * mean[:-1] + steps[:-1] * mean[1:])
    if isinstance(ends, str) and len(x) == 3:  # both ends say the same: a parabola
        matrix = np.array(((1, 1, 0), (step[1], 2 * (step[0] + step[1]), step[0]), (0, 1, 1)), float)
        right[0], right[2] = 2 * mean[0], 2 * mean[1]
        return solve(matrix, right, check_finite=False)
    bands = np.zeros((3, len(x)))  # above the diagonal, on it, below it
    bands[0, 2:], bands[1, 1:-1], bands[2, :-2] = step[:-1], 2 * (step[:-1] + step[1:]), step[1:]
    if isinstance(ends, str):
        first, last = x[2] - x[0], x[-1] - x[-3]
        bands[1, 0], bands[0, 1] = step[1], first
        bands[1, -1], bands[2, -2] = step[-2], last
        right[0] = ((steps[0] + 2 * first) * steps[1] * mean[0] + steps[0] ** 2 * mean[1]) / first
        right[-1] = (steps[-1] ** 2 * mean[-2] + (2 * last + steps[-1]) * steps[-2] * mean[-1]) / last
    else:
        bands[1, 0] = bands[1, -1] = 1.0
        right[0], right[-1] = ends[0][1], ends[1][1]
    return solve_banded((1, 1), bands, right, check_finite=False)
