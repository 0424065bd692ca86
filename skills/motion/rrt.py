"""A way through joint space when the straight one is blocked: RRT-Connect with shortcuts, seeded."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ...sim.quantity import Quantities, quantity
from .errors import MotionBlocked

Test = Callable[[np.ndarray], bool]


@dataclass(frozen=True, kw_only=True)
class RrtTuning(Quantities):
    """Numbers of the search for a free way."""

    branch: float = quantity(
        0.4, "rad", "longest branch of a tree, by the joint that moves most", "choice: few branches round an obstacle"
    )
    resolution: float = quantity(
        0.08, "rad", "spacing of the tests along a branch", "choice: a hand moves by at most about 8 cm"
    )
    tries: int = quantity(1500, "1", "random samples before giving up", "choice: a few seconds of computing")
    shortcuts: int = quantity(60, "1", "shortcuts that are tried on a path", "choice: later ones hardly shorten it")


RRT = RrtTuning()


def connect(
    start: np.ndarray,
    goal: np.ndarray,
    lower: np.ndarray,
    upper: np.ndarray,
    free: Test,
    *,
    leaving: Test | None = None,
    seed: int = 0,
    tuning: RrtTuning = RRT,
) -> np.ndarray:
    """Waypoints (k, n) of a free path between two joint vectors (n,).

    Args:
        start: where the arms are [rad].
        goal: where they should be [rad].
        lower: lower joint limits (n,) [rad].
        upper: upper joint limits (n,) [rad].
        free: whether a joint vector is allowed.
        leaving: the same on the way from a `start` that is not free, as velocity control may bring arms too near to
            something; none, where there is no such way.
        seed: of the samples; the same seed gives the same path.
        tuning: numbers of the search.

    Raises:
        MotionBlocked: the start or the goal is not free, or no path was found.
    """
    generator = np.random.default_rng(seed)
    if not free(goal):
        raise MotionBlocked("no way to plan: the goal posture touches something")
    if not free(start):
        if leaving is None or not leaving(start):
            raise MotionBlocked("no way to plan: the arms already touch something")
        free = leaving
    trees = (_Tree(start, tuning), _Tree(goal, tuning))
    forward = True
    for n in range(tuning.tries):
        grown, other = trees if forward else trees[::-1]
        sample = other.nodes[0] if n == 0 else generator.uniform(lower, upper)
        tip = grown.extend(sample, free)
        if tip is not None:
            met = other.reach(grown.nodes[tip], free)
            if met is not None:
                first, second = (tip, met) if forward else (met, tip)
                path = np.array(trees[0].branch(first)[::-1] + trees[1].branch(second)[1:])
                return _shorten(path, free, generator, tuning)
        forward = not forward
    raise MotionBlocked(f"no free way found for the arms in {tuning.tries} tries")


def segment_free(a: np.ndarray, b: np.ndarray, free: Test, *, resolution: float = RRT.resolution) -> bool:
    """Whether every posture between two joint vectors (n,) is allowed; the first one is taken on trust.

    Asked from the far end: of a tree that grows into something, the far end is in it before the rest.

    Args:
        a: joint vector to begin with [rad].
        b: joint vector to end with [rad].
        free: whether a joint vector is allowed.
        resolution: spacing of the tests, by the joint that moves most [rad].
    """
    count = max(1, int(np.ceil(np.abs(b - a).max() / resolution)))
    return all(free(a + (b - a) * (n / count)) for n in range(count, 0, -1))


class _Tree:
    def __init__(self, root: np.ndarray, tuning: RrtTuning) -> None:
        self._tuning = tuning
        self.nodes = [np.asarray(root, float)]
        self._parents = [-1]
        self._rows = self.nodes[0][None].copy()  # the nodes as an array, with room for more

    def extend(self, target: np.ndarray, free: Test) -> int | None:
        """Grow one branch towards `target`; returns the new node."""
        return self._grow(self._nearest(target), target, free)

    def reach(self, target: np.ndarray, free: Test) -> int | None:
        """Grow until `target` is met; returns the node that equals it, or None when something is in the way."""
        node = self._nearest(target)
        while True:
            grown = self._grow(node, target, free)
            if grown is None:
                return None
            if np.abs(self.nodes[grown] - target).max() < 1e-9:
                return grown
            node = grown

    def branch(self, node: int) -> list[np.ndarray]:
        """Nodes from `node` back to the root."""
        path = []
        while node >= 0:
            path.append(self.nodes[node])
            node = self._parents[node]
        return path

    def _nearest(self, target: np.ndarray) -> int:
        return int(np.argmin(np.linalg.norm(self._rows[: len(self.nodes)] - target, axis=1)))

    def _grow(self, node: int, target: np.ndarray, free: Test) -> int | None:
        offset = target - self.nodes[node]
        size = float(np.abs(offset).max())
        branch, resolution = self._tuning.branch, self._tuning.resolution
        q = target if size <= branch else self.nodes[node] + offset * (branch / size)
        if size < 1e-12 or not segment_free(self.nodes[node], q, free, resolution=resolution):
            return node if size < 1e-12 else None
        if len(self.nodes) == len(self._rows):
            self._rows = np.concatenate((self._rows, np.empty_like(self._rows)))
        self._rows[len(self.nodes)] = q
        self.nodes.append(np.asarray(q, float))
        self._parents.append(node)
        return len(self.nodes) - 1


def _shorten(path: np.ndarray, free: Test, generator: np.random.Generator, tuning: RrtTuning) -> np.ndarray:
    """Replace stretches between random points of the path by straight free segments."""
    points = list(path)
    for _ in range(tuning.shortcuts):
        if len(points) < 3:
            break
        steps = [float(np.linalg.norm(b - a)) for a, b in pairwise(points)]
        lengths = np.append(0.0, np.cumsum(steps))
        first, last = np.sort(generator.uniform(0.0, lengths[-1], 2))
        i, j = int(np.searchsorted(lengths, first, "right")) - 1, int(np.searchsorted(lengths, last, "right")) - 1
        if i == j:
            continue
        a, b = (
            points[k] + (points[k + 1] - points[k]) * ((at - lengths[k]) / max(lengths[k + 1] - lengths[k], 1e-12))
            for k, at in ((i, first), (j, last))
        )
        if segment_free(a, b, free, resolution=tuning.resolution):
            points = [*points[: i + 1], a, b, *points[j + 1 :]]
    return np.array(points)
