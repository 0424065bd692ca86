"""A made-up arm whose hand position is linear in its joints: exact to follow and to invert in microseconds.

It stands in for a robot's kinematics on the scripted world, where no geometry matters.  The first three
joints move the hand along x, y and z of the base, the others turn it about those axes, the last does nothing.
"""

from __future__ import annotations

import numpy as np

from ..world import SIDES, Side

GAIN = 0.5  # [m/rad] of the first three joints
HOME_IN_BASE = {"left": np.array((0.6, 0.3, 1.0)), "right": np.array((0.6, -0.3, 1.0))}


def _turn(axis: int, angle: float) -> np.ndarray:
    """Rotation (3, 3) by `angle` [rad] about one axis."""
    c, s = np.cos(angle), np.sin(angle)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    turned = np.eye(3)
    turned[i, i] = turned[j, j] = c
    turned[i, j], turned[j, i] = -s, s
    return turned


class LinearArms:
    """Both arms; the same questions as sim.mechanics.kinematics.Kinematics answers for the real ones."""

    def pose_hand_in_map(self, side: Side, q: np.ndarray, pose_base_in_map: np.ndarray) -> np.ndarray:
        """Pose (4, 4) of one hand for its n angles (n,), of which the first six count, [rad] and a base pose (3,)."""
        x, y, yaw = np.asarray(pose_base_in_map, float)
        base = np.eye(4)
        base[:3, :3], base[:3, 3] = _turn(2, yaw), (x, y, 0.0)
        hand = np.eye(4)
        hand[:3, :3] = _turn(0, q[3]) @ _turn(1, q[4]) @ _turn(2, q[5])
        hand[:3, 3] = HOME_IN_BASE[side] + GAIN * np.asarray(q[:3], float)
        return base @ hand

    def jacobian_hand_in_map(self, side: Side, q: np.ndarray, pose_base_in_map: np.ndarray) -> np.ndarray:
        """Jacobian (6, n) of the hand: linear, then angular velocity, along the axes of the map."""
        assert side in SIDES
        yaw = _turn(2, float(pose_base_in_map[2]))
        jacobian = np.zeros((6, len(q)))
        jacobian[:3, :3] = GAIN * yaw
        first, second = _turn(0, q[3]), _turn(1, q[4])
        jacobian[3:, 3:6] = yaw @ np.stack((np.eye(3)[0], first[:, 1], (first @ second)[:, 2]), axis=1)
        return jacobian
