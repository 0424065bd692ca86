"""The room's physics run in a tenth of a millisecond: metres, kilograms, and 1/`PER_SECOND` seconds.

Bullet solves cloth damping and contacts together by conjugate residuals up to an absolute residual of 1e-8 in
its own units, or 300 iterations.  In seconds, contact never meets it: every step runs into the cap.  A smaller
unit of time makes the same tolerance mean what physics needs, for three times the speed and the same motion
(docs/assumptions.md).  The rigid solver's threshold compares squared velocities and must be scaled along, or
pinned vertices shake.  Everything that leaves `sim` is in SI units.
"""

from __future__ import annotations

PER_SECOND = 1.0e4
RESIDUAL = 1e-7 / PER_SECOND**2  # Bullet's own default, in these units


def time(seconds: float) -> float:
    """A duration in the room's unit."""
    return seconds * PER_SECOND


def rate(per_second: float) -> float:
    """A velocity, a damping, anything that is divided by one time."""
    return per_second / PER_SECOND


def force(newtons: float) -> float:
    """A force, a torque, a stiffness, an acceleration: anything that is divided by time squared."""
    return newtons / PER_SECOND**2
