"""Does an arm go through a sleeve opening, and in which sense?

An opening is a closed loop of vertices, spanned by a fan of triangles around its centroid.  The arm is a
polyline from inside the shoulder to past the fingertip.  Where it passes the fan along the loop's
right-hand normal counts +1, against it -1; +1 in total means through, from body to hand.  The sign is of
six times the volume of tetrahedra: a segment p q passes the triangle a b c when the volumes of (p q a b),
(p q b c) and (p q c a) have one sign and p, q lie on different sides.  Neighbouring triangles share one
spoke and so one computed volume, hence no path slips between them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .limits import BEYOND, INWARD


@dataclass(frozen=True, kw_only=True)
class Crossing:
    """How one opening sits on one arm over time.

    Attributes:
        net: (T,) int, signed number of passes.
        at: (T,) where on the arm line the opening sits, NaN where `net` is 0: 1 shoulder, 2 elbow,
            3 wrist, 4 fingertip, linear between; the median if it passes several times.
    """

    net: np.ndarray
    at: np.ndarray

    @property
    def upper_arm(self) -> np.ndarray:
        """(T,) way up the upper arm: 0 at the elbow or beyond, 1 at the shoulder; 0 where not through."""
        return np.where(self.net == 0, 0.0, np.clip(2.0 - np.nan_to_num(self.at, nan=2.0), 0.0, 1.0))


def arm_line(arms: np.ndarray) -> np.ndarray:
    """Extend an arm at both ends.

    Args:
        arms: (T, 4, 3) shoulder, elbow, wrist, fingertip [m].

    Returns:
        (T, 6, 3): inside the shoulder, the four points, past the fingertip.
    """

    def direction(start: np.ndarray, end: np.ndarray) -> np.ndarray:
        return (end - start) / (np.linalg.norm(end - start, axis=-1, keepdims=True) + 1e-12)

    inside = arms[:, 0] - INWARD * direction(arms[:, 0], arms[:, 1])
    past = arms[:, 3] + BEYOND * direction(arms[:, 2], arms[:, 3])
    return np.concatenate([inside[:, None], arms, past[:, None]], axis=1)


def _triple(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> np.ndarray:
    return np.einsum("...i,...i->...", a, np.cross(b, c))


def crossing(loop: np.ndarray, line: np.ndarray) -> Crossing:
    """Pass a line through an opening, frame by frame.

    Args:
        loop: (T, n, 3) ordered points of the opening [m].
        line: (T, k, 3) polyline [m].
    """
    frames, count = len(loop), loop.shape[1]
    if count < 3:  # no opening
        return Crossing(net=np.zeros(frames, dtype=int), at=np.full(frames, np.nan))
    p, q = line[:, :-1, None], line[:, 1:, None]  # (T, k-1, 1, 3)
    along = q - p
    centre = loop.mean(axis=1)[:, None, None] - p  # (T, k-1, 1, 3), all seen from p
    rim = loop[:, None] - p  # (T, k-1, n, 3)
    following = np.roll(rim, -1, axis=2)
    spoke = _triple(along, centre, rim) > 0  # (T, k-1, n): which side of the line each spoke passes
    edge = _triple(along, rim, following) > 0
    forward = spoke & edge & ~np.roll(spoke, -1, axis=2)
    backward = ~spoke & ~edge & np.roll(spoke, -1, axis=2)
    normal = np.cross(rim - centre, following - centre)
    height_p = np.einsum("...i,...i->...", normal, centre)  # of the triangle over p
    travel = np.einsum("...i,...i->...", normal, along)
    with np.errstate(divide="ignore", invalid="ignore"):
        fraction = height_p / travel
        between = (fraction >= 0) & (fraction < 1)  # half open: a bend of the line belongs to one segment
    sign = np.where(between, forward.astype(int) - backward.astype(int), 0)
    net = sign.sum(axis=(1, 2))
    place = np.arange(sign.shape[1])[None, :, None] + fraction
    counted = (sign != 0) & (sign == np.sign(net)[:, None, None])
    at = np.full(frames, np.nan)
    for frame in np.flatnonzero(net):
        at[frame] = np.median(place[frame][counted[frame]])
    return Crossing(net=net, at=at)


@dataclass(frozen=True, kw_only=True)
class Sleeve:
    """One sleeve on one arm over time: its two openings."""

    armhole: Crossing
    cuff: Crossing

    @property
    def on(self) -> np.ndarray:
        """(T,) bool, the arm goes once through armhole, then cuff, from body to hand."""
        once = (self.armhole.net == 1) & (self.cuff.net == 1)
        return once & (np.nan_to_num(self.cuff.at) > np.nan_to_num(self.armhole.at))


def sleeve(armhole: np.ndarray, cuff: np.ndarray, arms: np.ndarray) -> Sleeve:
    """One sleeve on one arm.

    Args:
        armhole: (T, n, 3) [m].
        cuff: (T, n', 3) [m].
        arms: (T, 4, 3) [m].
    """
    line = arm_line(arms)
    return Sleeve(armhole=crossing(armhole, line), cuff=crossing(cuff, line))
