"""Which side of a sleeve shows between its two bindings."""

from __future__ import annotations

import numpy as np

from ..sim.world import Frame
from .cloud import points_in_map
from .colours import Surface
from .garment import gown_labels

_NEAR = 0.08  # a sleeve is twice as long: what is this near to both bindings lies between them [m]


def inside_share(frame: Frame, armhole: np.ndarray, cuff: np.ndarray) -> float:
    """Share of the fabric between points of the armhole's (n, 3) and of the cuff's binding (m, 3) that is inside out.

    Raises:
        PerceptionFailure: no gown in the picture.
    """
    from scipy.spatial import KDTree

    labels, cloud = gown_labels(frame), points_in_map(frame)
    fabric = np.isin(labels, (Surface.INSIDE, Surface.OUTSIDE)) & np.isfinite(cloud[..., 2])
    points, inside = cloud[fabric], labels[fabric] == Surface.INSIDE
    between = np.ones(len(points), bool)
    for binding in (armhole, cuff):
        between &= KDTree(binding).query(points, distance_upper_bound=_NEAR)[0] < _NEAR
    return float(inside[between].mean()) if between.any() else 0.0
