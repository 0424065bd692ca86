"""The hung gown as the network sees it: its side by its areas, its corners by key points set on their sheet's edge.

A key point tells the corner to some centimetres, mostly along the edge of the cloth, where half a strap's width does
not matter to a hand.  Fingers that close on the edge alone need it across the edge to some millimetres; that the
picture's depth tells, as the gown's outline is segmented well (an IoU of 0.98).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import SIDES, Frame, Side
from ..errors import PerceptionFailure, Problem
from ..estimates import CORNER_OF, GownSide, GraspPoint
from ..image.cloud import clusters, unit
from ..image.projection import points_in_map
from ..image.surfaces import GOWN_SURFACES
from .learned_sight import LearnedSight


@dataclass(frozen=True, kw_only=True)
class HungGownTuning(Quantities):
    """Numbers of the corners of a hung gown."""

    min_confidence: float = quantity(
        0.5,
        "1",
        "in a key point that counts as seen",
        "measured: of plain gowns on 100 to 109, from where the outside shows, 55 of 58 corners were told so surely; "
        "0.55 of them to 2 cm in the picture, 0.76 to 3 cm",
    )
    same_confidence: float = quantity(
        0.25, "1", "the same of a corner that was seen just now", "choice: that it is near there says as much again"
    )
    length: tuple[float, float] = quantity(
        (0.21, 0.66), "m", "from the hook to a corner, through the air", "choice: as of strips of tape, and the error"
    )
    same_distance: float = quantity(
        0.08, "m", "from where it was just now, within which a corner is the same one", "choice: it swings less"
    )
    sheet_step: float = quantity(0.015, "m", "between points of one sheet", "choice: two pixels at 1.2 m")
    around: float = quantity(
        0.06, "m", "of the key point, in which its sheet is looked for", "choice: a strap's width; the error is less"
    )
    min_points: int = quantity(12, "1", "of that sheet", "choice: fewer are noise")
    outline: float = quantity(5.0, "px", "of an outline that may be another sheet's", "choice: three of the network's")
    edge_width: float = quantity(
        0.012, "m", "along the edge, to either side of the key point, where it is measured", "choice: two pixels"
    )
    edge_percentile: float = quantity(
        95.0, "%", "of that cloth outwards, which is its edge", "choice: leaves noise out"
    )
    inset: float = quantity(0.003, "m", "of the grasp from the edge", "choice: as of a tape that shows")
    clear_distance: float = quantity(0.04, "m", "round a corner without other cloth", "choice: what fingers would take")
    crowd: int = quantity(12, "1", "of points of other cloth that count", "choice: fewer are noise")
    crowded_factor: float = quantity(0.4, "1", "of confidence beside other cloth", "choice: takes it below 0.5")


DEFAULT = HungGownTuning()


class HungGown:
    """What a network tells of a gown on its hook.

    Args:
        sight: that sees.
        tuning: numbers.
    """

    def __init__(self, sight: LearnedSight, tuning: HungGownTuning = DEFAULT) -> None:
        self._sight = sight
        self._tuning = tuning

    def side(self, frame: Frame) -> GownSide:
        """Which side of the gown faces the camera.

        Raises:
            PerceptionFailure: no fabric is seen.
        """
        return self._sight.gown_side(frame)

    def shown_corner(self, frame: Frame, hook_in_map: np.ndarray, side: Side | None = None) -> GraspPoint:
        """The corner that is told most surely, of those that hang clear of other cloth if one does.

        Args:
            frame: of a camera that sees the gown's outside.
            hook_in_map: (3,) where the gown hangs [m].
            side: the wearer's, if only that one is wanted.

        Raises:
            PerceptionFailure: neither shows, or not the one that is wanted.
        """
        found: list[GraspPoint] = []
        missed = PerceptionFailure(Problem.NOTHING_SEEN, "a corner of the hung gown's neckline")
        for each in SIDES if side is None else (side,):
            try:
                found.append(self.corner(frame, each, hook_in_map))
            except PerceptionFailure as failure:
                missed = failure
        if not found:
            raise missed
        return max(found, key=lambda corner: corner.confidence)

    def corner(
        self,
        frame: Frame,
        side: Side,
        hook_in_map: np.ndarray,
        near_in_map: np.ndarray | None = None,
        *,
        beside_matters: bool = True,
    ) -> GraspPoint:
        """One corner.

        Args:
            frame: of a camera that sees the gown's outside.
            side: the wearer's.
            hook_in_map: (3,) where the gown hangs [m].
            near_in_map: (3,) where it was just now [m].
            beside_matters: whether a corner with other cloth beside it counts as less sure.

        Raises:
            PerceptionFailure: it is not seen, or is not where it may be.
        """
        tuning, what = self._tuning, f"the {side} corner of the hung gown's neckline"
        seen = self._sight.sight(frame)
        point = seen.key_points[f"corner_{side}"]
        least = tuning.min_confidence if near_in_map is None else tuning.same_confidence
        if point.confidence < least:
            raise PerceptionFailure(Problem.NOTHING_SEEN, what)
        gown = np.isin(seen.surfaces, GOWN_SURFACES) & (frame.depth > 0)
        place, crowded = on_edge(frame, gown, point.pixel, tuning)
        away = float(np.linalg.norm(place - hook_in_map))
        if not tuning.length[0] < away < tuning.length[1]:
            raise PerceptionFailure(Problem.NOTHING_SEEN, what)
        if near_in_map is not None and np.linalg.norm(place - near_in_map) > tuning.same_distance:
            raise PerceptionFailure(Problem.NOTHING_SEEN, what)
        approach = unit((place - frame.pose_camera_in_map[:3, 3]) * (1.0, 1.0, 0.0))
        return GraspPoint(
            stamp=frame.stamp,
            confidence=point.confidence * (tuning.crowded_factor if crowded and beside_matters else 1.0),
            target=CORNER_OF[side],
            position_in_map=place,
            approach_in_map=approach,
            closing_in_map=np.array((-approach[1], approach[0], 0.0)),
        )


def on_edge(
    frame: Frame, gown: np.ndarray, pixel: np.ndarray, tuning: HungGownTuning = DEFAULT
) -> tuple[np.ndarray, bool]:
    """A place (3,) just inside of the edge of the sheet that a pixel is nearest to, and whether other cloth is beside.

    Args:
        frame: of a camera.
        gown: (H, W) bool, where it shows and has a depth.
        pixel: (2,) u and v of a corner, on the sheet or beside it [px].
        tuning: numbers.

    Raises:
        PerceptionFailure: too little of the gown is there.
    """
    lost = PerceptionFailure(Problem.NO_DEPTH, "a corner of the hung gown's neckline")
    rows, columns = np.nonzero(gown)
    if not len(rows):
        raise lost
    apart = np.hypot(columns - pixel[0], rows - pixel[1])
    nearest = int(np.argmin(apart))
    depth = float(frame.depth[rows[nearest], columns[nearest]])
    reach = apart < tuning.around * frame.intrinsics[0] / depth
    cloud = points_in_map(frame)[rows[reach], columns[reach]]
    if len(cloud) < tuning.min_points:
        raise lost
    apart, ahead = apart[reach], frame.depth[rows[reach], columns[reach]]
    sheets = clusters(cloud, tuning.sheet_step)
    large = [k for k in range(sheets.max() + 1) if (sheets == k).sum() >= tuning.min_points]
    if not large:
        raise lost
    reached = {k: float(apart[sheets == k].min()) for k in large}
    least = min(reached.values())
    # at an outline the background may be taken for gown, a pixel wide; the corner is before it
    fits = [k for k in large if reached[k] < least + tuning.outline]
    mine = sheets == min(fits, key=lambda k: float(ahead[sheets == k].min()))
    sheet = cloud[mine]
    close = sheet[np.argsort(apart[mine], kind="stable")[: tuning.min_points // 2]]
    at = np.median(close, axis=0)
    view = unit(at - frame.pose_camera_in_map[:3, 3])
    inwards = sheet.mean(axis=0) - at
    outward = -unit(inwards - (inwards @ view) * view)
    along = np.cross(view, outward)
    strip = sheet[np.abs((sheet - at) @ along) < tuning.edge_width]
    edge = float(np.percentile((strip - at) @ outward, tuning.edge_percentile))
    rim = strip[(strip - at) @ outward > edge - tuning.edge_width]
    rim = np.median(rim, axis=0)
    place = rim + ((at - rim) @ along) * along + (edge - tuning.inset - (rim - at) @ outward) * outward
    beside = np.linalg.norm(cloud[~mine] - place, axis=1) < tuning.clear_distance
    return place, int(beside.sum()) >= tuning.crowd
