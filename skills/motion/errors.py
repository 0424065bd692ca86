"""Why a motion cannot be planned."""

from __future__ import annotations

import numpy as np

from ...sim.errors import CaretreeError


class MotionError(CaretreeError):
    """No motion could be planned; the message is one sentence for the operator."""


class Unreachable(MotionError):  # noqa: N818 - an outcome, as the operator reads it
    """No joint angles bring the hand to the pose.

    Attributes:
        position_residual: distance left at the best configuration found [m].
        rotation_residual: angle left there [rad].
        q: that configuration (n,) [rad].
    """

    def __init__(self, message: str, position_residual: float, rotation_residual: float, q: np.ndarray) -> None:
        super().__init__(message)
        self.position_residual = position_residual
        self.rotation_residual = rotation_residual
        self.q = q


class MotionBlocked(MotionError):  # noqa: N818 - an outcome, as the operator reads it
    """A motion would hit something, or cannot be timed within the limits."""


class PathBlocked(MotionError):  # noqa: N818 - an outcome, as the operator reads it
    """There is no way for the base from here to there."""
