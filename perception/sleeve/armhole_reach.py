"""How far up its arm the armhole of a worn sleeve is, by the part of its tape that shows.

Half of an armhole is under the arm, and it slants: seen from the head of the bed its upper edge lies near the shoulder
while its lower one may hang at the middle of the upper arm.  So it is told by how its points lie along and round the
arm, and by where the cuff is.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ..image.cloud import unit
from .arm_frame import arm_frame


@dataclass(frozen=True, kw_only=True)
class ArmholeReachTuning(Quantities):
    """Numbers of how far up an armhole is."""

    headward: float = quantity(
        -0.3,
        "1",
        "cosine between the upper arm and the way to the camera, below which that is at the head of the bed",
        "measured: -0.55 to -0.42 there, 0.08 to 0.24 from beside the shoulders (ten seeds)",
    )
    shares: tuple[float, ...] = quantity(
        (0.05, 0.25, 0.5, 0.75, 0.95), "1", "quantiles of the armhole's points along the arm", "choice: its whole slant"
    )
    level: float = quantity(
        0.03,
        "m",
        "off the axis, by which points tell as much of a slant as it is expected not to be",
        "choice: the tape's width",
    )
    from_head: tuple[float, ...] = quantity(
        (0.941, -0.602, -0.305, -0.099, 0.211, 0.006, -0.815, -0.886, 0.035, 0.007),
        "1, 1/m, 1/m, 1/m, 1/m, 1/m, 1/m, 1/m, 1, 1",
        "of the armhole, and its change with `reach_features`",
        "measured: least squares over 324 views of ten development seeds (benchmarks/armhole_reach.py): on seeds left "
        "out 0.045 root mean square above 0.55, 0.006 too low on average.  Told up from 0.72 on are 88 % of those that "
        "are, 1 % of them wrongly",
    )
    from_beside: tuple[float, ...] = quantity(
        (1.201, -0.135, 0.358, 0.014, 0.384, -0.71, -2.298, 0.04, 0.039, -0.024),
        "1, 1/m, 1/m, 1/m, 1/m, 1/m, 1/m, 1/m, 1, 1",
        "likewise, of one that is seen from anywhere else",
        "measured: least squares over 277 views from beside the arm, two stands, of nine development seeds "
        "(benchmarks/armhole_reach.py): on seeds left out 0.052 root mean square above 0.55, 0.003 too low on average; "
        "by its near and far end alone, 0.05 less than fitted, 0.144 and 0.129.  Told up from 0.75 on are 75 % of "
        "those that are, 1 % of them wrongly",
    )


DEFAULT = ArmholeReachTuning()


def armhole_reach(
    armhole_in_map: np.ndarray,
    cuff_in_map: np.ndarray,
    arm_in_map: np.ndarray,
    camera_in_map: np.ndarray,
    tuning: ArmholeReachTuning = DEFAULT,
) -> float:
    """How far up the upper arm an armhole is: 0 elbow, 1 shoulder.

    Args:
        armhole_in_map: (n, 3) of its tape, as it shows [m].
        cuff_in_map: (m, 3) of the cuff's [m].
        arm_in_map: (4, 3) shoulder, elbow, wrist, fingertip [m].
        camera_in_map: (3,) where they were seen from [m].
        tuning: numbers of the rule.
    """
    along, eye = unit(arm_in_map[1] - arm_in_map[0]), camera_in_map - arm_in_map[0]
    at_head = float(unit(eye) @ along) < tuning.headward
    base, *changes = tuning.from_head if at_head else tuning.from_beside
    features = reach_features(armhole_in_map, cuff_in_map, arm_in_map, tuning)
    return float(np.clip(base + features @ np.array(changes), 0.0, 1.0))


def reach_features(
    armhole_in_map: np.ndarray, cuff_in_map: np.ndarray, arm_in_map: np.ndarray, tuning: ArmholeReachTuning = DEFAULT
) -> np.ndarray:
    """What tells how far up an armhole is.

    Args:
        armhole_in_map: (n, 3) of its tape, as it shows [m].
        cuff_in_map: (m, 3) of the cuff's [m].
        arm_in_map: (4, 3) shoulder, elbow, wrist, fingertip [m].
        tuning: numbers of the rule.

    Returns:
        (9,) five quantiles of the armhole's points along the arm and the cuff's middle [m]; where a plane through the
        points meets the arm's axis [m], and by how much it slants upwards and outwards [1].
    """
    shoulder, (along, up, outwards) = arm_in_map[0], arm_frame(arm_in_map)
    off = armhole_in_map - shoulder
    way = off @ along
    plane = np.column_stack((np.ones(len(off)), off @ up, off @ outwards))
    stiffness = np.diag((0.0, 1.0, 1.0)) * len(off) * tuning.level**2
    slant = np.linalg.solve(plane.T @ plane + stiffness, plane.T @ way)
    cuff = float(np.median((cuff_in_map - shoulder) @ along))
    return np.concatenate((np.quantile(way, tuning.shares), (cuff,), slant))
