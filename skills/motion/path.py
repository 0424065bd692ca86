"""Paths of the base across the room: A* on the occupancy map, kept off the walls, then straightened."""

from __future__ import annotations

import heapq
from dataclasses import dataclass

import numpy as np

from ...sim.compiled import njit
from ...sim.quantity import Quantities, quantity
from ...sim.world import RoomMap
from .errors import PathBlocked

_DIAGONAL = float(np.hypot(1, 1))


@dataclass(frozen=True, kw_only=True)
class PathTuning(Quantities):
    """Numbers of the base's path planner."""

    comfort: float = quantity(
        0.25, "m", "distance from obstacles below which a cell costs extra", "choice: room to correct the path"
    )
    comfort_cost: float = quantity(
        2.0, "1", "extra cost of a cell right beside an obstacle", "choice: a narrow way counts three times its length"
    )
    snap: float = quantity(
        0.4, "m", "farthest that a start outside the free space is from it", "choice: a base half under the bed"
    )
    line_step: float = quantity(
        0.3, "1", "spacing of the tests along a straight line, in cells", "choice: no cell is passed over"
    )


PATH = PathTuning()


def is_free(room: RoomMap, position: np.ndarray) -> bool:
    """Whether the base's centre may be at `position` (2,) in the map."""
    row, column = _cell(room, position)
    rows, columns = room.free.shape
    return bool(0 <= row < rows and 0 <= column < columns and room.free[row, column])


def plan_path(room: RoomMap, start: np.ndarray, goal: np.ndarray, *, tuning: PathTuning = PATH) -> np.ndarray:
    """Corner points (k, 2) of a free path of the base's centre, start first, goal last.

    A start just outside the free space (the base pushed half under the bed) is allowed: the path leaves by
    the nearest free cell.

    Args:
        room: the map.
        start: (2,) or (3,) in the map [m].
        goal: (2,) or (3,) in the map [m].
        tuning: numbers of the planner.

    Raises:
        PathBlocked: the goal is not free, or walled off, or the start is nowhere near free space.
    """
    from scipy.ndimage import distance_transform_edt

    start, goal = np.asarray(start, float)[:2], np.asarray(goal, float)[:2]
    if not is_free(room, goal):
        raise PathBlocked(f"the base cannot stand at {np.round(goal, 2).tolist()} m: the map has an obstacle there")
    clearance = np.asarray(distance_transform_edt(np.pad(room.free, 1)))[1:-1, 1:-1] * room.resolution
    cost = 1.0 + tuning.comfort_cost * np.clip(1.0 - clearance / tuning.comfort, 0.0, 1.0)
    cells = _astar(room.free, cost, _nearest_free(room, start, tuning.snap), _cell(room, goal))
    if cells is None:
        raise PathBlocked(f"no free way leads from {np.round(start, 2).tolist()} to {np.round(goal, 2).tolist()} m")
    points = [_centre(room, cell) for cell in cells]
    inside = is_free(room, start)
    points = [start, *(points[1:] if inside else points)]
    points = [*points[:-1], goal] if len(points) > 1 else [start, goal]
    return np.array(_straighten(room, points, 0 if inside else 1, tuning.line_step))


def path_length(path: np.ndarray) -> float:
    """Length [m] of corner points (k, 2)."""
    return float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())


def _cell(room: RoomMap, position: np.ndarray) -> tuple[int, int]:
    column, row = np.round((np.asarray(position)[:2] - room.origin) / room.resolution).astype(int)
    return int(row), int(column)


def _centre(room: RoomMap, cell: tuple[int, int]) -> np.ndarray:
    return np.asarray(room.origin, float) + room.resolution * np.array((cell[1], cell[0]))


def _nearest_free(room: RoomMap, position: np.ndarray, snap: float) -> tuple[int, int]:
    if is_free(room, position):
        return _cell(room, position)
    cells = np.argwhere(room.free)
    distance = np.linalg.norm(cells[:, ::-1] * room.resolution + room.origin - position, axis=1)
    if not len(cells) or distance.min() > snap:
        raise PathBlocked(f"the base at {np.round(position, 2).tolist()} m is over {snap} m from any free space")
    row, column = cells[int(distance.argmin())]
    return int(row), int(column)


def _astar(
    free: np.ndarray, cost: np.ndarray, start: tuple[int, int], goal: tuple[int, int]
) -> list[tuple[int, int]] | None:
    rows, columns = np.indices(free.shape)
    came = _searched(free, cost, np.hypot(goal[0] - rows, goal[1] - columns), start, goal)
    if start != goal and came[goal] < 0:
        return None
    path = [goal]
    while path[-1] != start:
        row, column = divmod(int(came[path[-1]]), free.shape[1])
        path.append((row, column))
    return path[::-1]


@njit()
def _searched(
    free: np.ndarray, cost: np.ndarray, to_go: np.ndarray, start: tuple[int, int], goal: tuple[int, int]
) -> np.ndarray:
    """The cell before each one that was reached, numbered by rows, and -1 elsewhere."""
    rows, columns = free.shape
    best = np.full(free.shape, np.inf)
    came = np.full(free.shape, -1)
    done = np.zeros(free.shape, np.bool_)
    best[start] = 0.0
    queue = [(0.0, start[0], start[1])]
    while queue:
        _, row, column = heapq.heappop(queue)
        if (row, column) == goal:
            break
        if done[row, column]:
            continue
        done[row, column] = True
        for dr in range(-1, 2):
            for dc in range(-1, 2):
                r, c = row + dr, column + dc
                if not (0 <= r < rows and 0 <= c < columns and free[r, c]) or (dr == 0 and dc == 0):
                    continue
                if dr != 0 and dc != 0 and not (free[row, c] and free[r, column]):
                    continue  # no cutting of corners
                length = _DIAGONAL if dr != 0 and dc != 0 else 1.0
                total = best[row, column] + length * 0.5 * (cost[row, column] + cost[r, c])
                if total < best[r, c]:
                    best[r, c], came[r, c] = total, row * columns + column
                    heapq.heappush(queue, (total + to_go[r, c], r, c))
    return came


def _straighten(room: RoomMap, points: list[np.ndarray], keep: int, step: float) -> list[np.ndarray]:
    """Leave out corners that a straight free line makes unnecessary; the first `keep` segments stay."""
    result = points[: keep + 1]
    n = keep
    while n < len(points) - 1:
        m = len(points) - 1
        while m > n + 1 and not _line_free(room, points[n], points[m], step):
            m -= 1
        result.append(points[m])
        n = m
    return result


def _line_free(room: RoomMap, a: np.ndarray, b: np.ndarray, step: float) -> bool:
    count = int(np.ceil(np.linalg.norm(b - a) / (step * room.resolution))) + 1
    columns, rows = np.round((np.linspace(a, b, count) - room.origin) / room.resolution).astype(int).T
    inside = (rows >= 0) & (rows < room.free.shape[0]) & (columns >= 0) & (columns < room.free.shape[1])
    return bool(inside.all()) and bool(room.free[rows, columns].all())
