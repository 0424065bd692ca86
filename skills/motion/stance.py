"""Where to stand: the base pose near a waypoint from which the wanted hand poses are best reached."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...sim.robot import model
from ...sim.robot.kinematics import Kinematics
from ...sim.world import SIDES, RoomMap, Side
from .errors import Unreachable
from .ik import FreeAxis, solve_ik
from .path import is_free


@dataclass(frozen=True, kw_only=True)
class Stance:
    """A base pose and how good it is.

    Attributes:
        pose_base_in_map: (3,) [m, m, rad].
        reached: how many of the targets are within reach.
        comfort: 0 (a joint at its limit or an arm stretched out) to 1, of the worst reached target.
    """

    pose_base_in_map: np.ndarray
    reached: int
    comfort: float


def reach_score(kinematics: Kinematics, side: Side, pose_hand_in_map: np.ndarray, pose_base_in_map: np.ndarray, *,
                free: FreeAxis = "approach", seeds: int = 3) -> float:
    """Comfort of one hand pose from one base pose, 0 when it is out of reach."""
    seed = model.READY[SIDES.index(side)]
    try:
        q = solve_ik(kinematics, side, pose_hand_in_map, pose_base_in_map, seed, free=free, seeds=seeds)
    except Unreachable:
        return 0.0
    limits = kinematics.limits[side]
    room = np.min(np.minimum(q - limits.lower, limits.upper - q) / 0.5)  # full marks from 0.5 rad on
    stretch = np.linalg.svd(kinematics.jacobian_hand_in_base(side, q)[:3], compute_uv=False)[-1] / 0.25
    return float(np.clip(min(room, stretch), 0.02, 1.0))


def best_base_pose(kinematics: Kinematics, targets: Sequence[tuple[Side, np.ndarray]], room: RoomMap,
                   near: tuple[float, float, float] | np.ndarray, *, radius: float = 0.4, step: float = 0.1,
                   free: FreeAxis = "approach") -> Stance:
    """Base pose within `radius` of `near` that reaches most targets, then comfortably, then nearest.

    Args:
        kinematics: the robot.
        targets: (side, pose of that hand (4, 4) in the map).
        room: where the base may be.
        near: (3,) waypoint; its yaw is kept.
        radius: how far from it to search along x and y [m].
        step: spacing of the search [m].
        free: hand axis about which the targets' orientation does not matter.

    Raises:
        Unreachable: no free base pose reaches any target.
    """
    near = np.asarray(near, float)
    offsets = np.arange(-radius, radius + 1e-9, step)
    candidates = sorted(((x, y) for x in offsets for y in offsets), key=lambda offset: float(np.hypot(*offset)))
    best: tuple[tuple[int, float], Stance] | None = None
    for x, y in candidates:
        base = near + np.array((x, y, 0.0))
        if not is_free(room, base[:2]):
            continue
        scores = [reach_score(kinematics, side, pose, base, free=free) for side, pose in targets]
        reached = sum(score > 0.0 for score in scores)
        comfort = min((score for score in scores if score > 0.0), default=0.0)
        # Comfort counts in coarse steps, so that the nearer of two equally good poses wins.
        rank = (reached, round(4.0 * comfort))
        if reached and (best is None or rank > best[0]):
            best = (rank, Stance(pose_base_in_map=base, reached=reached, comfort=comfort))
    if best is None:
        raise Unreachable(f"no free base pose within {radius} m of {np.round(near[:2], 2).tolist()} reaches any of the "
                          f"{len(targets)} hand poses", np.inf, np.inf, model.READY[0])
    return best[1]
