"""Stage C, close up: the strap of an armhole, the strip of cloth between its rim and the gown's upper edge.

A strap is what becomes the shoulder seam, so it is where the gown is held when the armhole is pulled up the arm.
It continues the navy neck binding, which is as wide, past the binding's end; on the bed or hanging over its edge.
"""

from __future__ import annotations

import numpy as np

from ...sim.world import Frame, Side
from ..errors import PerceptionFailure, Problem
from ..estimates import SLEEVE_OF, SleeveOpening
from ..image.cloud import clusters, points_in_map, surface_normal, thinned, unit
from ..image.garment import gown_labels
from ..image.surfaces import GOWN_SURFACES, Surface
from .lying_sleeve import sleeve_opening
from .strap_edge import AROUND, HALF_LENGTH, strap_between

WIDTH = 0.055  # of the binding and of the strap [m]
_AGREE = 0.04  # two ways to see the strap that are no farther apart mean the same place [m]
_AGREE_AFAR = 0.055  # the same for the view of the whole armhole, which is coarser [m]
_SPOT, _BARE = 0.02, 0.7  # around a grasp [m], and the least share of it that is no binding of a sleeve
_WHOLE = 400  # points of a strap that shows from border to border
_STEP = 0.0137  # of the walk along the strap; six lead to its middle [m]
_FEWEST = 6  # points of the gown around a step


def sleeve_strap(frame: Frame, side: Side, near_in_map: np.ndarray) -> SleeveOpening:
    """Find the strap and how it lies.

    Two ways to see it are compared: between the armhole's rim and the gown's edge, which tells best where it is while
    it shows whole, and past the end of the neck binding, which needs less of it.  In recorded views the first was right
    to 4 cm in all 8 where it rests on 400 points and more, and off by 7 to 23 cm in the 12 others; there the second
    counts, if the view of the whole armhole agrees with it and no sleeve has fallen over it there.

    Args:
        frame: a view from close by, such as a hand camera's.
        side: the wearer's sleeve that is meant.
        near_in_map: (3,) roughly where its armhole is [m].

    Returns:
        Position: middle of the strap.  Approach: into the side of the cloth that is seen.  Closing: unit vector across
        the strap; approach x closing points along it, from the neckline outwards on the wearer's left, and opposite on
        the right.  Where the strap is not twisted, closing points from the armhole to the gown's upper edge.

    Raises:
        PerceptionFailure: no rim near the place, or the strap is hidden.
    """
    try:
        between = strap_between(frame, near_in_map)
    except PerceptionFailure:
        return _past_binding(frame, side, near_in_map)
    try:
        past = _past_binding(frame, side, near_in_map)
        if np.linalg.norm(past.position_in_map - between.middle) < _AGREE:
            return past
        if between.points < _WHOLE:
            whole = sleeve_opening(frame, side, near_in_map)
            agrees = np.linalg.norm(past.position_in_map - whole.position_in_map) < _AGREE_AFAR
            if agrees and _plain(frame, past.position_in_map):
                return past
    except PerceptionFailure:
        pass
    # a strap folded over, its inside up, is held the other way round: see above what closing means
    across = -between.across if between.inside else between.across
    return SleeveOpening(
        stamp=frame.stamp,
        confidence=min(0.6, between.points / 200),
        target=SLEEVE_OF[side],
        position_in_map=between.middle,
        approach_in_map=-between.normal,
        closing_in_map=across,
        ring_points_in_map=between.rim,
        centre_in_map=np.percentile(between.rim, (5, 95), axis=0).mean(axis=0),
    )


def _plain(frame: Frame, place: np.ndarray) -> bool:
    """Whether the strap itself shows at a place (3,), not the sleeve fallen over it."""
    around = np.nan_to_num(np.linalg.norm(points_in_map(frame) - place, axis=2), nan=np.inf) < _SPOT
    plain = np.isin(gown_labels(frame)[around], (Surface.OUTSIDE, Surface.INSIDE, Surface.COLLAR))
    return bool(around.any() and plain.mean() > _BARE)


def _past_binding(frame: Frame, side: Side, near_in_map: np.ndarray) -> SleeveOpening:
    """The strap along the line of the neck binding, past its end."""
    labels, cloud = gown_labels(frame), points_in_map(frame)
    near = np.nan_to_num(np.linalg.norm(cloud - near_in_map, axis=2), nan=np.inf) < AROUND
    rim = thinned(cloud[(labels == Surface.ARMHOLE) & near])
    navy = thinned(cloud[(labels == Surface.COLLAR) & near])
    if len(rim) < 15 or len(navy) < 30:
        what = "rim" if len(rim) < 15 else "end of the neck binding beside"
        raise PerceptionFailure(Problem.NOTHING_SEEN, f"{what} of the {side} armhole")
    rim, navy = rim[clusters(rim, 0.03) == 0], navy[clusters(navy, 0.02) == 0]
    gown = thinned(cloud[np.isin(labels, GOWN_SURFACES) & near], 4000)
    eye = frame.pose_camera_in_map[:3, 3]
    start, along, headward = _end_of_binding(navy, rim, gown, eye)
    middle, along, headward, found = _walk(gown, start, along, headward, eye)
    if found < 4:
        raise PerceptionFailure(Problem.NOTHING_SEEN, f"strap of the {side} armhole")
    normal = np.cross(headward, along)
    normal *= np.sign(normal @ (eye - middle))
    closing = np.cross(along, normal) * (1.0 if side == "right" else -1.0)
    return SleeveOpening(
        stamp=frame.stamp,
        confidence=found / 6 * min(1.0, len(navy) / 150),
        target=SLEEVE_OF[side],
        position_in_map=middle,
        approach_in_map=-normal,
        closing_in_map=closing,
        ring_points_in_map=rim,
        centre_in_map=np.percentile(rim, (5, 95), axis=0).mean(axis=0),
    )


def _end_of_binding(
    navy: np.ndarray, rim: np.ndarray, gown: np.ndarray, eye: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Middle of the binding's end (3,), direction out of it (3,), and the one towards the gown's upper edge (3,)."""
    last = navy
    along = np.linalg.svd(navy - navy.mean(axis=0), full_matrices=False)[2][0]
    along *= np.sign(along @ (rim.mean(axis=0) - navy.mean(axis=0)))
    for _ in range(2):  # the binding may bend over the bed's edge: its last centimetres give the direction
        marks = navy @ along
        last = navy[marks > marks.max() - 0.09]
        axes = np.linalg.svd(last - last.mean(axis=0), full_matrices=False)[2]
        turned = max(axes[:2], key=lambda axis: abs(axis @ along))
        along = unit(along + turned * np.sign(turned @ along))
    marks = last @ along
    normal = surface_normal(last, eye)
    headward = unit(np.cross(normal, along))
    body = gown[np.linalg.norm(gown - last.mean(axis=0), axis=1) < 0.12].mean(axis=0)
    headward *= -np.sign(headward @ (body - last.mean(axis=0)))
    across = last @ headward
    end = last.mean(axis=0)
    end = end + along * (np.percentile(marks, 98) - end @ along)
    return end + headward * (np.percentile(across, 97) - WIDTH / 2 - end @ headward), along, headward


def _walk(
    gown: np.ndarray, start: np.ndarray, along: np.ndarray, headward: np.ndarray, eye: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray, int]:
    """From the end of the binding to the middle of the strap: point, directions, and in how many steps it was seen."""
    here, found = start, 0
    for _ in range(round(HALF_LENGTH / _STEP)):
        normal = np.cross(headward, along)
        ahead = here + _STEP * along
        offset = gown - ahead
        slab = np.abs(offset @ along) < 0.6 * _STEP
        near = slab & (np.abs(offset @ normal) < 0.025) & (np.abs(offset @ headward) < 0.05)
        if near.sum() < _FEWEST:
            here = ahead
            continue
        found += 1
        edge = float(np.percentile(offset[near] @ headward, 95))
        strip = near & (np.abs(offset @ headward - edge + WIDTH / 2) < WIDTH / 2 + 0.005)
        deep = float(np.median(offset[strip] @ normal)) if strip.any() else 0.0
        reached = ahead + headward * np.clip(edge - WIDTH / 2, -0.01, 0.01) + normal * deep
        along = unit(along + 0.5 * unit(reached - here))
        here = reached
        headward = unit(headward - (headward @ along) * along)
        around = gown[(np.linalg.norm(gown - here, axis=1) < 0.03)]
        if len(around) >= 12:
            up = surface_normal(around, eye)
            up = up if up @ normal > 0 else -up
            up = unit(normal + 0.5 * (up - (up @ along) * along))
            headward = unit(np.cross(along, up)) * np.sign(np.cross(along, up) @ headward)
    return here, along, headward, found
