"""The armhole of a sleeve that a hand holds by its strap: how it hangs beside the grip."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame, Side
from ..errors import PerceptionFailure, Problem
from ..estimates import SLEEVE_OF, SleeveOpening
from ..gown.gown_facts import GOWN
from ..image.cloud import unit
from ..image.projection import points_in_map
from ..image.surfaces import Surface, surfaces


@dataclass(frozen=True, kw_only=True)
class HeldArmholeTuning(Quantities):
    """Numbers of a sleeve's tapes around a grip."""

    min_points: int = quantity(15, "1", "of a tape", "choice: fewer are noise")
    full_points: int = quantity(120, "1", "of the armhole that make it certain", "choice: one seen from close by")
    extent: tuple[float, float] = quantity(
        (3.0, 97.0), "%", "of the points, which are its extent", "choice: leaves noise out"
    )


DEFAULT = HeldArmholeTuning()


def held_armhole(
    frame: Frame, side: Side, near_in_map: np.ndarray, tuning: HeldArmholeTuning = DEFAULT
) -> SleeveOpening:
    """All of the armhole's tape that is seen around a grip.

    Args:
        frame: of any camera.
        side: the sleeve's.
        near_in_map: (3,) fingertips that hold the strap [m].
        tuning: numbers of the search.

    Returns:
        Its points, and as centre the middle of their extent; position and directions are those of the grip.

    Raises:
        PerceptionFailure: too little of it is seen.
    """
    points = held_tape(frame, Surface.ARMHOLE, near_in_map)
    if len(points) < tuning.min_points:
        raise PerceptionFailure(Problem.NOTHING_SEEN, f"held armhole of the {side} sleeve")
    low, high = np.percentile(points, tuning.extent, axis=0)
    view = unit(near_in_map - frame.pose_camera_in_map[:3, 3])
    return SleeveOpening(
        stamp=frame.stamp,
        confidence=float(min(1.0, len(points) / tuning.full_points)),
        target=SLEEVE_OF[side],
        position_in_map=np.asarray(near_in_map, float),
        approach_in_map=view,
        closing_in_map=unit(np.cross(view, (0.0, 0.0, 1.0))),
        armhole_points_in_map=points,
        centre_in_map=(low + high) / 2,
    )


def held_tape(frame: Frame, tape: Surface, near_in_map: np.ndarray) -> np.ndarray:
    """Points (n, 3) of one of a sleeve's tapes that are seen around a grip at (3,), in the map [m]."""
    points = points_in_map(frame)[(surfaces(frame.rgb) == tape) & (frame.depth > 0)].reshape(-1, 3)
    return points[np.linalg.norm(points - near_in_map, axis=1) < GOWN.armhole_drop]
