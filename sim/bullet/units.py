"""The room's physics run in a tenth of a millisecond: metres, kilograms, and 1/`PER_SECOND` seconds.

Bullet solves cloth damping and contacts together by conjugate residuals up to an absolute residual of 1e-8 in
its own units, or 300 iterations.  In seconds, contact never meets it: every step runs into the cap.  A smaller
unit of time makes the same tolerance mean what physics needs, for three times the speed and the same motion
(docs/assumptions.md).  The rigid solver's threshold compares squared velocities and must be scaled along, or
pinned vertices shake.  Everything that leaves `sim` is in SI units.
"""

from __future__ import annotations

from dataclasses import dataclass

PER_SECOND = 1.0e4
_RESIDUAL = 1e-7  # Bullet's own threshold, in seconds


@dataclass(frozen=True)
class TimeUnit:
    """A world's unit of time.  per_second: how many make a second."""

    per_second: float

    @property
    def is_second(self) -> bool:
        """Whether the world runs in plain SI."""
        return self.per_second == 1.0

    @property
    def residual(self) -> float:
        """The rigid solver's threshold, scaled from Bullet's own."""
        return _RESIDUAL / self.per_second**2

    def time(self, seconds: float) -> float:
        """A duration in this unit."""
        return seconds * self.per_second

    def rate(self, per_second: float) -> float:
        """A velocity, a damping, anything that is divided by one time."""
        return per_second / self.per_second

    def force(self, newtons: float) -> float:
        """A force, a torque, a stiffness, an acceleration: anything that is divided by time squared."""
        return newtons / self.per_second**2


ROOM = TimeUnit(PER_SECOND)
