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

UP = np.array((0.0, 0.0, 1.0))


@dataclass(frozen=True, kw_only=True)
class ArmholeReachTuning(Quantities):
    """Numbers of how far up an armhole is."""

    ends: tuple[float, float] = quantity(
        (0.05, 0.95), "1", "quantiles of the armhole's points that are its ends", "choice: few are noise"
    )
    headward: float = quantity(
        -0.3,
        "1",
        "cosine between the upper arm and the way to the camera, below which that is at the head of the bed",
        "measured: -0.55 to -0.42 there, 0.08 to 0.24 from beside the shoulders (ten seeds)",
    )
    from_beside: tuple[float, float, float] = quantity(
        (0.79, -1.66, -0.75),
        "1, 1/m, 1/m",
        "of the armhole, and its change with how far down the arm its near and its far end show",
        "measured: least squares over 176 views from the head of the bed and from beside the shoulder, of 88 sleeves "
        "above 0.4 that nobody holds in 30 runs on seeds 101 to 104: 0.060 root mean square on seeds left out; by its "
        "far end and the cuff's middle 0.075.  0.05 less since: in 91 views of sleeves of three runs (145, 148, 149) "
        "none of 47 low ones is told up by that, and 33 of 44 that are up; four and 43 before, and two were claimed at "
        "0.697 and 0.673 (149, 150)",
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
        "out 0.045 root mean square above 0.55, 0.006 too low on average; by `from_beside` 0.072 and 0.039.  Told up "
        "from 0.72 on are 88 % of those that are, 1 % of them wrongly; by `from_beside` 59 % from 0.74 on",
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
    if float(unit(eye) @ along) < tuning.headward:
        base, *changes = tuning.from_head
        features = reach_features(armhole_in_map, cuff_in_map, arm_in_map, tuning)
    else:
        base, *changes = tuning.from_beside
        features = np.quantile((armhole_in_map - arm_in_map[0]) @ along, tuning.ends)
    return float(np.clip(base + features @ np.array(changes), 0.0, 1.0))


def reach_features(
    armhole_in_map: np.ndarray, cuff_in_map: np.ndarray, arm_in_map: np.ndarray, tuning: ArmholeReachTuning = DEFAULT
) -> np.ndarray:
    """What tells how far up an armhole is that is seen from the head of the bed.

    Args:
        armhole_in_map: (n, 3) of its tape, as it shows [m].
        cuff_in_map: (m, 3) of the cuff's [m].
        arm_in_map: (4, 3) shoulder, elbow, wrist, fingertip [m].
        tuning: numbers of the rule.

    Returns:
        (9,) five quantiles of the armhole's points along the arm and the cuff's middle [m]; where a plane through the
        points meets the arm's axis [m], and by how much it slants upwards and outwards [1].
    """
    shoulder, along = arm_in_map[0], unit(arm_in_map[1] - arm_in_map[0])
    up = unit(UP - (UP @ along) * along)
    outwards = np.cross(along, up)
    outwards *= np.sign(outwards[0] * shoulder[0]) or 1.0  # away from the bed's middle line
    off = armhole_in_map - shoulder
    way = off @ along
    plane = np.column_stack((np.ones(len(off)), off @ up, off @ outwards))
    stiffness = np.diag((0.0, 1.0, 1.0)) * len(off) * tuning.level**2
    slant = np.linalg.solve(plane.T @ plane + stiffness, plane.T @ way)
    cuff = float(np.median((cuff_in_map - shoulder) @ along))
    return np.concatenate((np.quantile(way, tuning.shares), (cuff,), slant))
