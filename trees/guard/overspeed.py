"""Measured speed of the robot's links near the person: what no command explains is held against the running skill."""

from __future__ import annotations

import numpy as np

from ...sim.segments import furthest_moved
from ...sim.world import Observation
from ...skills.core.reasons import Failure, Reason
from ...skills.geometry.person_zone import PersonZone
from .limits import Limits
from .link_motion import LinkMotion


class Overspeed:
    """Compares each new observation with the one before.

    Args:
        limits: `hand_speed` and `overspeed_...` count.
        zone: where the person is.
        links: of the robot.
    """

    def __init__(self, limits: Limits, zone: PersonZone, links: LinkMotion) -> None:
        self._limits, self._zone, self._links = limits, zone, links
        self._ends: np.ndarray | None = None  # (r, 2, 3) at the observation before
        self._fast_since: float | None = None

    def judge(self, seen: Observation, last: Observation | None) -> Failure | None:
        """The link that has been too fast near the person for too long, if one has.

        Args:
            seen: of a new time.
            last: the one before.
        """
        ends, radii, names = self._links.ends(seen), self._links.radii, self._links.names
        before, self._ends = self._ends, ends
        if last is None or before is None:
            return None
        speed = furthest_moved(before, ends) / (seen.time - last.time)
        fast = speed > self._limits.hand_speed * self._limits.overspeed_factor
        if fast.any():
            fast[fast] = self._zone.link_distance(ends[fast], radii[fast]) < self._limits.near_person
        if not fast.any():
            self._fast_since = None
        elif self._fast_since is None:
            self._fast_since = last.time
        elif seen.time - self._fast_since > self._limits.overspeed_for:
            self._fast_since = None
            n = int(np.argmax(np.where(fast, speed, 0.0)))
            return Failure(Reason.SPEED_LIMIT, f"{names[n].replace('_', ' ')} at {speed[n]:.2f} m/s", "guard")
        return None
