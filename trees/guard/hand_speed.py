"""How fast commands move the hands, and how much slower a trajectory must run near the person."""

from __future__ import annotations

import numpy as np

from ...sim.world import JointTrajectory
from ...skills.geometry.person_zone import PersonZone

SAMPLE = 0.05  # [s] between the places where a trajectory is checked
SAMPLES_MAX = 2000


def sampled(trajectory: JointTrajectory) -> tuple[np.ndarray, np.ndarray]:
    """Times (m,) and positions (m, n) at the knots and at most `SAMPLE` apart between them."""
    times = np.asarray(trajectory.times, float)
    count = int(min(np.ceil(times[-1] / SAMPLE), SAMPLES_MAX))
    fine = np.union1d(times, np.linspace(0.0, times[-1], count + 1))
    columns = np.asarray(trajectory.positions, float).T
    return fine, np.stack([np.interp(fine, times, column) for column in columns], axis=1)


def near_speed(times: np.ndarray, ends: np.ndarray, radii: np.ndarray, zone: PersonZone, near: float) -> float:
    """Highest speed of links while either end of a step is near the person [m/s]; 0 when never.

    Args:
        times: (k,) [s].
        ends: (k, r, 2, 3) of the links' axes [m].
        radii: (r,) of the links [m].
        zone: where the person is.
        near: closer than this counts [m].
    """
    if len(times) < 2:
        return 0.0
    count, links = ends.shape[:2]
    speed = np.linalg.norm(np.diff(ends, axis=0), axis=3).max(axis=2) / np.maximum(np.diff(times), 1e-9)[:, None]
    gap = zone.link_distance(ends.reshape(-1, 2, 3), np.tile(radii, count)).reshape(count, links)
    close = gap < near
    return float(speed[close[:-1] | close[1:]].max(initial=0.0))


def stretched(trajectory: JointTrajectory, factor: float) -> JointTrajectory:
    """The same path, `factor` times slower."""
    return JointTrajectory(
        joints=trajectory.joints, times=np.asarray(trajectory.times, float) * factor, positions=trajectory.positions
    )
