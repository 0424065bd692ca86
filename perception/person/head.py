"""The person's head, at the head end of the bed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame
from ..errors import PerceptionFailure, Problem
from ..estimates import Head
from ..image.projection import project
from .person_facts import PERSON
from .skin import DEFAULT as SKIN_DEFAULT
from .skin import SkinTuning, skin_on_bed


@dataclass(frozen=True, kw_only=True)
class HeadTuning(Quantities):
    """Numbers of the search for the head."""

    min_person_points: int = quantity(60, "1", "of skin of a person", "choice: less is noise")
    aside: float = quantity(0.30, "m", "of the head from the midline of the bed, at most", "choice: it lies on the bed")
    headward: float = quantity(
        0.35, "m", "of the head's skin from the middle of the bed, at least", "choice: hands at rest are nearer"
    )
    min_candidates: int = quantity(40, "1", "of skin points at the head end", "choice: less is noise")
    crown_percentile: float = quantity(0.5, "%", "of these points that may lie beyond the crown", "choice: noise")
    length: float = quantity(0.14, "m", "from the crown, which is the head and not the neck", "choice: half a head")
    width_percentiles: tuple[float, float] = quantity((2, 98), "%", "of the head's points across", "choice: noise")
    top_percentile: float = quantity(95, "%", "of the head's points in height", "choice: noise")
    min_points: int = quantity(30, "1", "of a head", "choice: less is noise")
    sure_points: int = quantity(
        150, "1", "of a head that is seen with certainty", "choice: well above the least that counts"
    )
    border: float = quantity(
        2.0, "px", "of the picture, within which what shows of a head is cut off", "choice: two pixels"
    )
    round_from: float = quantity(
        0.05, "m", "from the crown, where the head begins to be as a cylinder", "choice: clear of the crown's round"
    )
    round_to: float = quantity(0.08, "m", "from the crown, where the head is as a ball", "choice: a head's radius")
    min_round_points: int = quantity(20, "1", "of a fit of a round body", "choice: steadier than the bare extent")
    round_percentiles: tuple[float, float] = quantity((3, 97), "%", "of a round body's points across", "choice: noise")
    max_shift: float = quantity(
        0.06, "m", "of a fitted middle from that of what shows", "choice: a fit that says more is wrong"
    )
    crown_range: tuple[float, float] = quantity(
        (-0.08, 0.01), "m", "of a fitted crown from what shows of it", "choice: a fit that says more is wrong"
    )


DEFAULT = HeadTuning()


def head_seen(
    frame: Frame, bed: np.ndarray, tuning: HeadTuning = DEFAULT, skin_tuning: SkinTuning = SKIN_DEFAULT
) -> Head:
    """Find the head: the skin at the head end of the bed (towards -y), as wide and as high as a head.

    Args:
        frame: a view of the person.
        bed: (2, 3) lower and upper corner of the bed in the map [m].
        tuning: numbers.
        skin_tuning: numbers of what counts as skin.

    Raises:
        PerceptionFailure: no skin at the head end, or the image cuts it off.
    """
    points, _ = skin_on_bed(frame, bed, tuning=skin_tuning)
    if len(points) < tuning.min_person_points:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "person")
    middle_of_bed = bed[:, 0].mean()
    across = np.abs(points[:, 0] - middle_of_bed) < tuning.aside
    candidates = points[across & (points[:, 1] < bed[:, 1].mean() - tuning.headward)]
    if len(candidates) < tuning.min_candidates:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "head")
    crown = float(np.percentile(candidates[:, 1], tuning.crown_percentile))
    blob = candidates[candidates[:, 1] < crown + tuning.length]
    width = float(np.ptp(np.percentile(blob[:, 0], tuning.width_percentiles)))
    height = float(np.percentile(blob[:, 2], tuning.top_percentile)) - bed[1, 2]
    fits = _within(width, PERSON.head_width_range) and _within(height, PERSON.head_top_range)
    if not (fits and len(blob) >= tuning.min_points) or _cut_off(frame, blob, tuning):
        raise PerceptionFailure(Problem.NOTHING_SEEN, "head")
    confidence = min(1.0, len(blob) / tuning.sure_points)
    middle = _centre_of_round(blob[blob[:, 1] > crown + tuning.round_from], tuning)
    crown = _end_of_round(blob[blob[:, 1] < crown + tuning.round_to], crown, tuning)
    return Head(
        stamp=frame.stamp,
        confidence=float(confidence),
        middle=middle,
        crown_in_map=np.array((middle, crown, float(np.median(blob[:, 2])))),
    )


def _cut_off(frame: Frame, blob: np.ndarray, tuning: HeadTuning) -> bool:
    """Whether points (n, 3) of a head reach the picture's border, so that more of it, or all, may lie beyond.

    A neck whose head was out of the picture was taken for it, 0.08 m footward of that, and the shoulders with it (165).
    """
    u, v, _ = project(frame, blob).T
    height, width = frame.depth.shape
    off_border = np.minimum(np.minimum(u, width - 1 - u), np.minimum(v, height - 1 - v))
    return bool(off_border.min() < tuning.border)


def _within(value: float, bounds: tuple[float, float]) -> bool:
    return bounds[0] < value < bounds[1]


def _centre_of_round(points: np.ndarray, tuning: HeadTuning) -> float:
    """X of the centre of a round body along y, of which only the side towards the camera is seen (n, 3)."""
    x, z = points[:, 0], points[:, 2]
    plain = float(np.percentile(x, tuning.round_percentiles).mean())
    if len(points) < tuning.min_round_points:
        return plain
    # x^2 + z^2 = 2 a x + 2 b z + c is linear in the centre (a, b)
    system = np.column_stack([2 * x, 2 * z, np.ones(len(x))])
    a, b, c = np.linalg.lstsq(system, x**2 + z**2, rcond=None)[0]
    radius = np.sqrt(max(c + a**2 + b**2, 0.0))
    return float(a) if _within(radius, PERSON.head_radius_range) and abs(a - plain) < tuning.max_shift else plain


def _end_of_round(points: np.ndarray, seen: float, tuning: HeadTuning) -> float:
    """Y of the far end of a ball of which the crown itself is turned away from the camera; `seen` is what shows [m]."""
    if len(points) < tuning.min_round_points:
        return seen
    system = np.column_stack([2 * points, np.ones(len(points))])
    *centre, rest = np.linalg.lstsq(system, (points**2).sum(axis=1), rcond=None)[0]
    radius = np.sqrt(max(rest + float(np.square(centre).sum()), 0.0))
    end = float(centre[1] - radius)
    return end if _within(radius, PERSON.head_radius_range) and _within(end - seen, tuning.crown_range) else seen
