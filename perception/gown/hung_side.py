"""Which side of a gown on its hook faces the camera."""

from __future__ import annotations

import numpy as np

from ...sim.world import Frame
from ..estimates import GownSide
from ..image.cloud import points_in_map
from ..image.garment import gown_labels, gown_side
from ..image.surfaces import Surface
from .hung_corner import hook, strips

BELOW = 0.13  # within this distance of the hook the fabric is the panel that the neckline carries, not a sleeve [m]
UNSEEN = 0.3  # confidence in the inside where no neckline is seen
WHOLE = 0.8  # weight of what the rest of the gown shows, against that


def hung_side(frame: Frame) -> GownSide:
    """Decide by the fabric just below the hook, and by all of it where that is cut in two.

    Where no neckline is seen below the hook, whatever shows of the outside is wrapped round from the other side.

    Raises:
        PerceptionFailure: no neckline, or no fabric, is seen.
    """
    top, labels = hook(frame).position_in_map, gown_labels(frame)
    with np.errstate(invalid="ignore"):
        near = (np.linalg.norm(points_in_map(frame) - top, axis=2) < BELOW) & (frame.depth > 0)
    outside, inside = (int(((labels == surface) & near).sum()) for surface in (Surface.OUTSIDE, Surface.INSIDE))
    whole = gown_side(frame)
    score = (outside - inside) / max(outside + inside, 1) + (WHOLE if whole.outside else -WHOLE) * whole.confidence
    if score > 0.0 and not strips(frame, top):
        return GownSide(stamp=frame.stamp, confidence=UNSEEN, outside=False)
    return GownSide(stamp=frame.stamp, confidence=min(1.0, abs(score)), outside=score > 0.0)
