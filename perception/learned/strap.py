"""The strap of a lying sleeve as the network sees it, where no tape shows.

Rules on the surfaces that it sees need their borders, of which it knows half; its key point needs none of them, and
roughly where the strap should be says which of two peaks is meant.  How the strap lies the network does not know from
close by (places on the sheet told it to 45 degrees in 0.31 of 80 pictures): it is taken to lie as on a person who is
dressed, outwards from the neckline, which was so to 45 degrees in 0.62 of them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame, Side
from ..errors import PerceptionFailure, Problem
from ..estimates import SLEEVE_OF, SleeveOpening
from ..image.cloud import surface_normal, unit
from ..image.projection import points_in_map
from ..image.surfaces import GOWN_SURFACES, Surface
from .sight import Sight

_OUTWARDS = {"left": np.array((-1.0, 0.0, 0.0)), "right": np.array((1.0, 0.0, 0.0))}  # of the person, in the map


@dataclass(frozen=True, kw_only=True)
class LearnedStrapTuning(Quantities):
    """Numbers of a strap without tapes."""

    deviation: float = quantity(
        0.10, "m", "of a strap from where it is looked for", "measured: as it is seen from afar, in 32 pictures"
    )
    min_chance: float = quantity(
        0.35,
        "1",
        "that it shows there, else it is looked for from elsewhere",
        "measured: of 80 pictures of a hand, the 20 below 0.49 were right to 6 cm in 0.55, the others in 0.80",
    )
    around: float = quantity(0.08, "m", "of the strap, of cloth that tells its normal", "choice: more than its width")
    min_cells: int = quantity(12, "1", "of that cloth", "choice: fewer are noise")
    rim_distance: float = quantity(0.25, "m", "of the strap, in which its armhole's rim is", "choice: its length")


CLOSELY = LearnedStrapTuning()
# Laid sleeves are 0.2 to 0.3 m beside their hands; of 32 pictures of the head 0.94 were right to 10 cm.
AFAR = LearnedStrapTuning(deviation=0.25, min_chance=0.1, around=0.12, min_cells=4)


def strap_in(
    frame: Frame, sight: Sight, side: Side, near_in_map: np.ndarray, tuning: LearnedStrapTuning = CLOSELY
) -> SleeveOpening:
    """The strap where the network's scores and the place at which it is looked for say together that it is.

    Args:
        frame: a view of the gown, lying on the person.
        sight: what the network sees in it.
        side: the wearer's sleeve that is meant.
        near_in_map: (3,) roughly where it is [m].
        tuning: numbers, `CLOSELY` or `AFAR`.

    Returns:
        As `Senses.sleeve_strap` does; its confidence is the chance that the strap shows there.

    Raises:
        PerceptionFailure: no gown shows there, or hardly a strap.
    """
    heat = sight.heat[f"strap_{side}"].astype(float)
    at = _cells(frame.depth.shape, heat.shape)
    cloud = points_in_map(frame)[at]
    gown = np.isin(sight.surfaces[at], GOWN_SURFACES) & ~np.isnan(cloud[..., 0])
    cloud, surfaces, scores = cloud[gown], sight.surfaces[at][gown], heat[gown]
    off = np.linalg.norm(cloud - near_in_map, axis=1)
    chance = float(np.exp(scores[off < 2 * tuning.deviation]).sum() / (1.0 + np.exp(heat).sum()))
    if chance < tuning.min_chance:
        raise PerceptionFailure(Problem.NOTHING_SEEN, f"strap of the {side} armhole")
    scores -= off**2 / (2 * tuning.deviation**2)
    weights = np.exp(scores - scores.max())
    middle = weights @ cloud / weights.sum()
    off = np.linalg.norm(cloud - middle, axis=1)
    around = cloud[off < tuning.around]
    if len(around) < tuning.min_cells:
        raise PerceptionFailure(Problem.NOTHING_SEEN, f"cloth around the strap of the {side} armhole")
    normal = surface_normal(around, frame.pose_camera_in_map[:3, 3])
    outwards = _OUTWARDS[side] - (_OUTWARDS[side] @ normal) * normal
    rim = cloud[(surfaces == Surface.ARMHOLE) & (off < tuning.rim_distance)]
    rim = rim if len(rim) else around
    return SleeveOpening(
        stamp=frame.stamp,
        confidence=chance,
        target=SLEEVE_OF[side],
        position_in_map=middle,
        approach_in_map=-normal,
        closing_in_map=unit(np.cross(outwards, -normal)) * (1.0 if side == "left" else -1.0),
        armhole_points_in_map=rim,
        centre_in_map=rim.mean(axis=0),
    )


def _cells(picture: tuple[int, ...], cells: tuple[int, ...]) -> tuple[np.ndarray, ...]:
    """Rows and columns of a picture's pixels in the middle of the network's cells."""
    rows, columns = (((np.arange(n) + 0.5) * size / n).astype(int) for size, n in zip(picture, cells, strict=True))
    return np.ix_(rows, columns)
