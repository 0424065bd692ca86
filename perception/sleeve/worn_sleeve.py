"""Where the tapes of a sleeve show along an arm that is, or is not, inside it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame, Side
from ..errors import PerceptionFailure, Problem
from ..estimates import WornSleeve
from ..image.surfaces import Surface
from .cuff_round_arm import share_round, tape_near


@dataclass(frozen=True, kw_only=True)
class WornSleeveTuning(Quantities):
    """Numbers of where a sleeve shows along an upper arm."""

    line: tuple[float, float] = quantity(
        (-1.0, 2.0), "1", "ends of the line beside which tape counts: 0 shoulder, 1 elbow", "choice: all of a sleeve"
    )
    min_points: int = quantity(15, "1", "of either tape", "choice: fewer are noise")
    depth: float = quantity(
        0.01, "m", "below the arm's axis, down to which tape counts for the reach", "choice: what a camera above sees"
    )
    cuff_end: float = quantity(0.95, "1", "quantile of the cuff's points that is its far end", "choice: few are noise")
    reach: tuple[float, float, float] = quantity(
        (1.55, -2.83, -0.96),
        "1, 1/m, 1/m",
        "of the armhole, and its change with how far down the arm the cuff's end and the armhole's middle show",
        "measured: least squares over 1,137 states of about 40 runs on seeds 100 to 108 (vertices above the "
        "axis, sleeves above 0.5 that nobody holds): 0.045 root mean square; by the cuff's middle alone 0.065",
    )
    full_points: int = quantity(100, "1", "of the smaller one that make it certain", "choice: seen from close by")


DEFAULT = WornSleeveTuning()


def worn_sleeve(frame: Frame, side: Side, arm_in_map: np.ndarray, tuning: WornSleeveTuning = DEFAULT) -> WornSleeve:
    """Where along the upper arm both tapes of its sleeve show, and how far round it the cuff does.

    Args:
        frame: of any camera.
        side: of the person.
        arm_in_map: (4, 3) shoulder, elbow, wrist, fingertip [m].
        tuning: numbers of the search.

    Raises:
        PerceptionFailure: too little of either is seen.
    """
    shoulder, along = arm_in_map[0], arm_in_map[1] - arm_in_map[0]
    line = shoulder + np.outer(tuning.line, along)
    found = [tape_near(frame, tape, line) for tape in (Surface.ARMHOLE, Surface.CUFF)]
    if min(map(len, found)) < tuning.min_points:
        raise PerceptionFailure(Problem.NOTHING_SEEN, f"both bindings of the worn {side} sleeve")
    length = float(np.linalg.norm(along))
    ways = [(points - shoulder) @ along / length for points in found]
    armhole, cuff = (float(np.median(way)) / length for way in ways)
    return WornSleeve(
        stamp=frame.stamp,
        confidence=min(1.0, min(map(len, found)) / tuning.full_points),
        side=side,
        armhole_at=armhole,
        cuff_at=cuff,
        reach=_reach(found, ways, shoulder, along / length, tuning),
        round_arm=share_round(found[1], line),
    )


def _reach(
    found: list[np.ndarray], ways: list[np.ndarray], shoulder: np.ndarray, along: np.ndarray, tuning: WornSleeveTuning
) -> float:
    """How far up the upper arm the armhole is, by what shows of both tapes.

    Half of the armhole is under the arm, and slants: the farther the cuff's far end, the farther down it is.

    Args:
        found: points (n, 3) of the armhole's and of the cuff's tape [m].
        ways: (n,) how far down the arm they lie [m].
        shoulder: (3,) [m].
        along: (3,) unit vector down the arm.
        tuning: numbers of the estimate.
    """
    shown = []
    for points, way in zip(found, ways, strict=True):
        above = ((points - shoulder) - np.outer(way, along))[:, 2] > -tuning.depth
        shown.append(way[above] if np.count_nonzero(above) >= tuning.min_points else way)
    base, by_cuff, by_armhole = tuning.reach
    reach = base + by_cuff * np.quantile(shown[1], tuning.cuff_end) + by_armhole * np.median(shown[0])
    return float(np.clip(reach, 0.0, 1.0))
