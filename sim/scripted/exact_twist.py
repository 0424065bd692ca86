"""A twist of a hand as a made-up arm follows it: exactly, for as long as it lasts, and then at rest."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..world import HandTwist, Side

SINGULAR = 1e-3  # share of the greatest singular value below which a hand does not move in a direction


class ExactTwist:
    """Answers what sim.mechanics.twist.TwistTracker does, for kinematics without limits.

    Args:
        kinematics: with `jacobian_hand_in_map`.
        side: of the hand.
    """

    def __init__(self, kinematics: Any, side: Side) -> None:
        self._kinematics, self._side = kinematics, side
        self._twist, self._until, self._time = np.zeros(6), -np.inf, 0.0
        self._active = False

    @property
    def active(self) -> bool:
        """Whether there is a twist to follow."""
        return self._active

    def start(self, command: HandTwist, time: float) -> HandTwist:
        """Take a new twist at `time` [s]; returns it as it is."""
        self._twist = np.array(command.twist_in_map, float)
        self._time, self._until, self._active = time, time + command.duration, True
        return command

    def cancel(self) -> None:
        """Let go."""
        self._active = False

    def rates(
        self, time: float, q: np.ndarray, dq: np.ndarray, pose_base_in_map: np.ndarray, twist_base: np.ndarray
    ) -> np.ndarray | None:
        """Joint rates (n,) [rad/s] for the period that ends at `time` [s], or None when no twist is active."""
        if not self._active:
            return None
        lasts, moved = time - self._time, min(self._until, time) - self._time
        self._time = time
        if moved <= 1e-9:
            self._active = False
            return None
        jacobian = self._kinematics.jacobian_hand_in_map(self._side, q, pose_base_in_map)
        return pseudo_inverse(jacobian) @ self._twist * (moved / lasts)


def pseudo_inverse(jacobian: np.ndarray) -> np.ndarray:
    """That of `np.linalg.pinv`, which checks its input for longer than it computes."""
    u, s, vt = np.linalg.svd(jacobian, full_matrices=False)
    inverse = np.where(s > SINGULAR * s.max(), 1.0 / np.maximum(s, 1e-300), 0.0)
    return vt.T @ (inverse[:, None] * u.T)
