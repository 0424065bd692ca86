"""The room's physics run in centiseconds: lengths in metres, masses in kilograms, time in 1/`PER_SECOND` seconds.

Bullet solves cloth damping and contacts together by conjugate residuals up to an absolute tolerance of 1e-8 in
its own units.  In seconds that asks for far more than physics needs and the solver runs into its cap of 300
iterations in every step with contact; with centiseconds as the unit the tolerance is met early, for 1.6 times the
speed.  Milliseconds would double it, but then pinned vertices shake and a hanging gown pulls twice its weight
(`tests/sim/test_handle.py`).  Everything that leaves `sim` is in SI units.
"""

from __future__ import annotations

PER_SECOND = 100.0


def time(seconds: float) -> float:
    """A duration in the room's unit."""
    return seconds * PER_SECOND


def rate(per_second: float) -> float:
    """A velocity, a damping, anything that is divided by one time."""
    return per_second / PER_SECOND


def force(newtons: float) -> float:
    """A force, a torque, a stiffness, an acceleration: anything that is divided by time squared."""
    return newtons / PER_SECOND**2
