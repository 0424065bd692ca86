"""How far round an arm the cuff of a sleeve shows: what tells an arm inside it from one beside it.

The cuff of a sleeve on its arm shows in front of the arm, beside it, and behind it, on its own far side.  One that
missed the arm shows on one side only.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame
from ..errors import PerceptionFailure, Problem
from ..estimates import Cover
from ..image.cloud import unit
from ..image.projection import points_in_map
from ..image.surfaces import Surface, surfaces


@dataclass(frozen=True, kw_only=True)
class CuffTuning(Quantities):
    """Numbers of how far round an arm a cuff shows."""

    max_distance: float = quantity(
        0.20, "m", "of a tape from the arm's axis", "choice: what is farther off belongs to something else"
    )
    min_points: int = quantity(15, "1", "of a cuff", "choice: fewer are noise")
    full_points: int = quantity(100, "1", "of a cuff that make it certain", "choice: one seen from close by")
    sectors: int = quantity(12, "1", "around the axis that are told apart", "choice: 30 degrees each")
    min_sector_points: int = quantity(3, "1", "of the cuff in one of them", "choice: fewer are noise")
    steepest: float = quantity(
        0.9,
        "1",
        "slope (a sine) up to which directions round the axis are counted from the vertical",
        "choice: any will do",
    )


DEFAULT = CuffTuning()


def cuff_round(frame: Frame, points_in_map: np.ndarray, tuning: CuffTuning = DEFAULT) -> Cover:
    """Share of the directions off an arm's axis in which a cuff shows.

    Args:
        frame: of any camera.
        points_in_map: (m, 3) chain along the axis of the arm, and beyond it as far as a cuff may be [m].
        tuning: numbers of the search.

    Raises:
        PerceptionFailure: too little of a cuff shows near it.
    """
    cuff = tape_near(frame, Surface.CUFF, points_in_map, tuning)
    if len(cuff) < tuning.min_points:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "cuff beside the arm")
    confidence = min(1.0, len(cuff) / tuning.full_points)
    return Cover(stamp=frame.stamp, confidence=confidence, share=share_round(cuff, points_in_map, tuning))


def tape_near(frame: Frame, tape: Surface, chain: np.ndarray, tuning: CuffTuning = DEFAULT) -> np.ndarray:
    """Points (n, 3) of one of the gown's tapes that are seen near a chain (m, 3), all in the map [m]."""
    points = points_in_map(frame)[(surfaces(frame.rgb) == tape) & (frame.depth > 0)].reshape(-1, 3)
    away = np.linalg.norm(_off(points, chain)[0], axis=1)
    return points[away < tuning.max_distance]


def share_round(points: np.ndarray, chain: np.ndarray, tuning: CuffTuning = DEFAULT) -> float:
    """Share (0 to 1) of the directions off a chain (m, 3) in which some of the points (n, 3) lie, in one frame [m]."""
    off, nearest = _off(points, chain)
    counts = np.zeros(tuning.sectors, int)
    for k, along in enumerate(np.diff(chain, axis=0)):
        aside = unit(np.cross(along, (0.0, 0.0, 1.0) if abs(unit(along)[2]) < tuning.steepest else (1.0, 0.0, 0.0)))
        here = off[nearest == k]
        angles = np.arctan2(here @ unit(np.cross(aside, along)), here @ aside)
        counts += np.histogram(angles, bins=tuning.sectors, range=(-np.pi, np.pi))[0]
    return float((counts >= tuning.min_sector_points).mean())


def _off(points: np.ndarray, chain: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Vectors (n, 3) from the nearest places of a chain to points [m], and the index (n,) of their segments."""
    start, edge = chain[:-1], np.diff(chain, axis=0)
    share = np.einsum("nkd,kd->nk", points[:, None] - start, edge) / (edge**2).sum(axis=1)
    vectors = points[:, None] - start - np.clip(share, 0.0, 1.0)[..., None] * edge
    nearest = np.argmin(np.linalg.norm(vectors, axis=2), axis=1)
    return vectors[np.arange(len(points)), nearest], nearest
