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
    far_end: float = quantity(0.95, "1", "quantile of the armhole's points that is its end", "choice: few are noise")
    reach: tuple[float, float, float] = quantity(
        (1.08, -0.73, -1.30),
        "1, 1/m, 1/m",
        "of the armhole, and its change with how far down the arm its far end and the cuff's middle show",
        "measured: least squares over 211 views from beside the shoulder of 20 runs on seeds 101 to 108, sleeves above "
        "0.45 that nobody holds: 0.044 root mean square on seeds left out, 0.069 by the cuff's end",
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

    Half of the armhole is under the arm, and slants: the farther the cuff is, the farther down that half is.

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
    base, by_armhole, by_cuff = tuning.reach
    reach = base + by_armhole * np.quantile(shown[0], tuning.far_end) + by_cuff * np.median(shown[1])
    return float(np.clip(reach, 0.0, 1.0))
