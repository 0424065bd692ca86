"""How far round an arm the cuff of a sleeve shows: what tells an arm inside it from one beside it.

The cuff of a sleeve on its arm shows in front of the arm, beside it, and behind it, on its own far side.  One that
missed the arm shows on one side only.
"""

from __future__ import annotations

import numpy as np

from ...sim.world import Frame
from ..errors import PerceptionFailure, Problem
from ..estimates import Cover
from ..image.cloud import points_in_map, unit
from ..image.surfaces import Surface, surfaces

NEAR = 0.20  # from the arm's axis, what is farther off belongs to something else [m]
_POINTS = 15
_SECTORS, _FEWEST = 12, 3  # directions off the axis that are told apart, and points that show in one


def cuff_round(frame: Frame, points_in_map: np.ndarray) -> Cover:
    """Share of the directions off an arm's axis in which a cuff shows.

    Args:
        frame: of any camera.
        points_in_map: (m, 3) chain along the axis of the arm, and beyond it as far as a cuff may be [m].

    Raises:
        PerceptionFailure: too little of a cuff shows near it.
    """
    cuff = binding_near(frame, Surface.CUFF, points_in_map)
    if len(cuff) < _POINTS:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "cuff beside the arm")
    return Cover(stamp=frame.stamp, confidence=min(1.0, len(cuff) / 100), share=share_round(cuff, points_in_map))


def binding_near(frame: Frame, binding: Surface, chain: np.ndarray) -> np.ndarray:
    """Points (n, 3) of a binding that are seen near a chain (m, 3) [m]."""
    points = points_in_map(frame)[(surfaces(frame.rgb) == binding) & (frame.depth > 0)].reshape(-1, 3)
    away = np.linalg.norm(_off(points, chain)[0], axis=1)
    return points[away < NEAR]


def share_round(points: np.ndarray, chain: np.ndarray) -> float:
    """Share of the directions off a chain (m, 3) in which some of the points (n, 3) lie [m]."""
    off, nearest = _off(points, chain)
    counts = np.zeros(_SECTORS, int)
    for k, along in enumerate(np.diff(chain, axis=0)):
        aside = unit(np.cross(along, (0.0, 0.0, 1.0) if abs(unit(along)[2]) < 0.9 else (1.0, 0.0, 0.0)))
        here = off[nearest == k]
        angles = np.arctan2(here @ unit(np.cross(aside, along)), here @ aside)
        counts += np.histogram(angles, bins=_SECTORS, range=(-np.pi, np.pi))[0]
    return float((counts >= _FEWEST).mean())


def _off(points: np.ndarray, chain: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Vectors (n, 3) from the nearest places of a chain to points [m], and the numbers (n,) of their segments."""
    start, edge = chain[:-1], np.diff(chain, axis=0)
    share = np.einsum("nkd,kd->nk", points[:, None] - start, edge) / (edge**2).sum(axis=1)
    vectors = points[:, None] - start - np.clip(share, 0.0, 1.0)[..., None] * edge
    nearest = np.argmin(np.linalg.norm(vectors, axis=2), axis=1)
    return vectors[np.arange(len(points)), nearest], nearest
