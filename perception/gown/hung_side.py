"""Which side of a gown on its hook faces the camera."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame
from ..estimates import GownSide
from ..image.garment import gown_labels, gown_side
from ..image.projection import points_in_map
from ..image.surfaces import Surface
from .hung_corner import hook
from .neckline_strip import strips


@dataclass(frozen=True, kw_only=True)
class HungSideTuning(Quantities):
    """Numbers of the decision which side of a hung gown is seen."""

    panel_distance: float = quantity(
        0.13,
        "m",
        "below the hook, within which fabric is the panel below the neckline",
        "choice: no sleeve hangs there",
    )
    wrapped_confidence: float = quantity(
        0.3, "1", "in the inside where no neckline is seen below the hook", "choice: a guess worth a second look"
    )
    whole_weight: float = quantity(
        0.8, "1", "of what the rest of the gown shows, against the panel", "choice: the panel decides where they differ"
    )


DEFAULT = HungSideTuning()


def hung_side(frame: Frame, tuning: HungSideTuning = DEFAULT) -> GownSide:
    """Decide by the fabric just below the hook, and where both sides show there, by all of the gown.

    Where no neckline is seen below the hook, what shows of the outside is wrapped round from the other side.

    Raises:
        PerceptionFailure: no neckline, or no fabric, is seen.
    """
    top, labels = hook(frame).position_in_map, gown_labels(frame)
    with np.errstate(invalid="ignore"):
        near = (np.linalg.norm(points_in_map(frame) - top, axis=2) < tuning.panel_distance) & (frame.depth > 0)
    outside, inside = (int(((labels == surface) & near).sum()) for surface in (Surface.OUTSIDE, Surface.INSIDE))
    whole = gown_side(frame)
    weight = tuning.whole_weight if whole.outside else -tuning.whole_weight
    score = (outside - inside) / max(outside + inside, 1) + weight * whole.confidence
    if score > 0.0 and not strips(frame, top):
        return GownSide(stamp=frame.stamp, confidence=tuning.wrapped_confidence, outside=False)
    return GownSide(stamp=frame.stamp, confidence=min(1.0, abs(score)), outside=score > 0.0)
