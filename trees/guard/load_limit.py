"""How hard a hand may pull or be pulled: power and force limiting, as ISO/TS 15066 calls it.

| fingers | limit | above it |
|---|---|---|
| hold cloth | `cloth_load_stop`; motions slow down from `cloth_load_slow` on | stop at once |
| stand further apart: an arm, or contact | `arm_load_stop` | wait; stop once it lasts, or at `arm_load_peak` |

What takes load off is never slowed: relief must stay possible.
"""

from __future__ import annotations

import numpy as np

from ...sim.vector import length
from ...sim.world import SIDES, Observation, Side
from ...skills.core.reasons import Failure, Reason, SkillFailure
from .limits import Limits

ARM_OPENING = 0.03  # [m] between fingers that do not hold cloth, at least: no adult's arm is thinner


class LoadLimit:
    """Judges the load on both hands.

    Args:
        limits: those of cloth and arm loads count.
    """

    def __init__(self, limits: Limits) -> None:
        self._limits = limits
        self._opening = np.zeros(2)
        self._over = {side: False for side in SIDES}  # counted already, and has not fallen since
        self._heavy_since: dict[Side, float | None] = {side: None for side in SIDES}

    def judge(self, seen: Observation) -> list[Failure]:
        """Take note of the loads; for each hand whose load newly counts as too high, why the motion must stop."""
        self._opening = seen.gripper_opening
        found = []
        for n, side in enumerate(SIDES):
            load = length(seen.wrench_hand_in_map[n, :3])
            limit = self.stop_load(side)
            if load >= limit and self._lasts(side, load, seen.time) and not self._over[side]:
                self._over[side] = True
                detail = f"{load:.1f} N on the {side} hand, limit {limit:g} N"
                found.append(Failure(Reason.FORCE_LIMIT, detail, "guard"))
            elif load < limit:
                self._heavy_since[side] = None
            if load < limit * self._limits.cloth_load_rearm / self._limits.cloth_load_stop:
                self._over[side] = False
        return found

    def stop_load(self, side: Side) -> float:
        """The load at which a hand stops now [N]."""
        return self._limits.arm_load_stop if self._wide(side) else self._limits.cloth_load_stop

    def ease(self, side: Side, motion: np.ndarray, seen: Observation, retreat: bool) -> float:
        """Factor 0 to 1 for a hand's motion under its present load.

        Args:
            side: which hand.
            motion: (3,) direction in the map, of any length.
            seen: the present loads.
            retreat: the motion takes load off the person, whatever its direction; believed up to `arm_load_peak`.

        Raises:
            SkillFailure: the load is at its limit.
        """
        force = seen.wrench_hand_in_map[SIDES.index(side), :3]
        load, stop = length(force), self.stop_load(side)
        if not motion.any() or float(motion @ force) > 0.0:
            return 1.0  # the hand moves the way it is pulled
        if retreat and load < self._limits.arm_load_peak:
            return 1.0  # away: the load it leaves may still grow a little
        if load >= stop and self._wide(side) and not self._over[side]:
            return 0.0  # it waits for the load to fall, or to have lasted too long
        if load >= stop:
            raise SkillFailure(Reason.FORCE_LIMIT, f"{load:.1f} N on the {side} hand, limit {stop:g} N")
        slow = self._limits.cloth_load_slow
        if self._wide(side) or load <= slow:
            return 1.0
        return (stop - load) / (stop - slow)

    def _lasts(self, side: Side, load: float, time: float) -> bool:
        """Whether a load above the limit counts: the pull of a held arm has to last, or to be far above it."""
        if not self._wide(side) or load >= self._limits.arm_load_peak:
            return True
        since = self._heavy_since[side]
        if since is None:
            self._heavy_since[side] = time
            return False
        return time - since > self._limits.arm_load_for

    def _wide(self, side: Side) -> bool:
        """Whether fingers stand too far apart to hold cloth: what they feel is an arm, or contact."""
        return bool(self._opening[SIDES.index(side)] > ARM_OPENING)
