"""From a Cartesian velocity of a hand to joint rates: damped least squares with null-space centring."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..extras import later
from ..world import SIDES, HandTwist, Side
from .kinematics import Kinematics
from .planar import planar_pose

if TYPE_CHECKING:
    import pinocchio as pin  # pyright: ignore[reportMissingImports] - lives in a cmeel prefix
else:
    pin = later("pinocchio")

_GAIN = 8.0  # of the position feedback that takes out the drift of integrating joint rates [1/s]
_MAX_LAG = np.array((0.01, 0.06))  # the pose to follow never runs further ahead than this [m, rad]
_CENTRING = 0.4  # pull of the null space towards the ready posture [1/s] ...
# ... of a hand that moves as fast as this: where it stands, the elbow stands too [m/s, rad/s]
_CENTRED_AT = np.array((0.1, 0.5))
_DAMPING = 0.04  # least squares damping at a singularity [m per rad]
_SINGULAR = 0.06  # smallest singular value below which damping sets in
_TURN = 0.15  # what an error in turning counts once joints at their limits leave no exact solution [m/rad]


class TwistTracker:
    """Follows a `HandTwist` with one arm; until it expires the hand's path holds in the map even while the base moves.

    The twist is ramped at the robot's `hand_acceleration`, integrated into a hand pose, and that pose is followed
    with feedback, so a purely linear twist does not turn the hand.
    """

    def __init__(self, kinematics: Kinematics, side: Side) -> None:
        self._kinematics = kinematics
        self._side: Side = side
        self._limits = kinematics.limits[side]
        self._ready = kinematics.robot.ready[SIDES.index(side)]
        self._moved = kinematics.robot.limits
        self._wanted = np.zeros(6)
        self._twist = np.zeros(6)
        self._until = -np.inf
        self._active = False
        self._pose: np.ndarray | None = None  # (4, 4) to follow, in the map; None until the first step
        self._time = 0.0

    def start(self, command: HandTwist, time: float) -> HandTwist:
        """Take a new twist; returns it clipped to the hand's speed limits."""
        wanted = np.array(command.twist_in_map, float)
        for part, limit in zip((slice(0, 3), slice(3, 6)), self._moved.hand_velocity, strict=True):
            wanted[part] *= min(1.0, limit / max(float(np.linalg.norm(wanted[part])), 1e-9))
        if self._pose is None:
            self._time = time
        self._wanted, self._until = wanted, time + command.duration
        self._active = True
        return HandTwist(side=command.side, twist_in_map=wanted.copy(), duration=command.duration)

    @property
    def active(self) -> bool:
        """Whether there is a twist to follow, or what is left of its motion to end."""
        return self._active

    def cancel(self) -> None:
        """Let go: the joints brake by themselves."""
        self._active, self._pose = False, None

    def rates(
        self, time: float, q: np.ndarray, dq: np.ndarray, pose_base_in_map: np.ndarray, twist_base: np.ndarray
    ) -> np.ndarray | None:
        """Joint rates (n,) [rad/s] for the period that ends at `time`, or None when no twist is active."""
        if not self._active:
            return None
        kinematics, dt = self._kinematics, time - self._time
        self._time = time
        base = planar_pose(pose_base_in_map)
        pose_local, jacobian = kinematics.pose_and_jacobian_local(self._side, q)
        pose = base @ pose_local.homogeneous
        goal = self._pose
        if goal is None:
            goal = pose
            self._twist[:3] = pose[:3, :3] @ (jacobian[:3] @ dq)  # start from what the hand is doing
            self._twist[3:] = pose[:3, :3] @ (jacobian[3:] @ dq)
        wanted = self._wanted if time <= self._until + 1e-9 else np.zeros(6)
        for part, limit in zip((slice(0, 3), slice(3, 6)), self._moved.hand_acceleration, strict=True):
            change = wanted[part] - self._twist[part]
            self._twist[part] += change * min(1.0, limit * dt / max(float(np.linalg.norm(change)), 1e-12))
        if time > self._until and np.abs(self._twist).max() < 1e-6:
            self.cancel()
            return None
        self._pose = self._lead(_integrate(goal, self._twist, dt), pose)
        R = pose[:3, :3]
        error = np.concatenate((self._pose[:3, 3] - pose[:3, 3], _rotation_vector(self._pose[:3, :3] @ R.T)))
        velocity = self._twist + _GAIN * error - _carried(pose, base, twist_base)
        local = np.concatenate((R.T @ velocity[:3], R.T @ velocity[3:]))
        return self._solve(jacobian, local, q, dq, dt)

    def _solve(self, J: np.ndarray, velocity: np.ndarray, q: np.ndarray, dq: np.ndarray, dt: float) -> np.ndarray:
        limits = self._limits
        room = 0.5 / max(dt, 1e-6)  # a joint may use half of what is left to its limit in one period
        low = np.maximum(-limits.velocity, (limits.lower - q) * room)
        high = np.minimum(limits.velocity, (limits.upper - q) * room)
        centring = _CENTRING * self._pace() * (self._ready - q)
        free = np.ones(len(q), bool)
        rates = np.zeros(len(q))
        for _ in range(3):
            counts = np.where(np.arange(6) < 3, 1.0, 1.0 if free.sum() > 5 else _TURN)
            Jf = J[:, free] * counts[:, None]
            rest = (velocity - J[:, ~free] @ rates[~free]) * counts
            U, S, Vt = np.linalg.svd(Jf, full_matrices=False)
            damping = _DAMPING**2 * (1.0 - np.minimum(S / _SINGULAR, 1.0) ** 2)
            solved = Vt.T @ (S / (S**2 + damping) * (U.T @ (rest - Jf @ centring[free]))) + centring[free]
            rates[free] = solved
            over = (rates < low - 1e-9) | (rates > high + 1e-9)
            at_limit = over & free & ((q - limits.lower < 0.05) | (limits.upper - q < 0.05))
            if not at_limit.any():
                break
            rates[at_limit] = np.clip(rates[at_limit], low[at_limit], high[at_limit])
            free &= ~at_limit
        scale = np.max(np.abs(rates) / limits.velocity)
        if scale > 1.0:  # slower, in the same direction
            rates = rates / scale
        return np.clip(rates, low, high)

    def _pace(self) -> float:
        """How fast the hand is told to move, from 0 to 1.

        A guard that slows a hand down as a link comes near to something must not see that link go on by itself.
        """
        return min(1.0, float(np.linalg.norm(self._twist.reshape(2, 3), axis=1) @ (1.0 / _CENTRED_AT)))

    def _lead(self, target: np.ndarray, pose: np.ndarray) -> np.ndarray:
        """Keep the pose to follow within `_MAX_LAG` of where the hand is: it must not wind up at a limit."""
        offset = target[:3, 3] - pose[:3, 3]
        turn = _rotation_vector(target[:3, :3] @ pose[:3, :3].T)
        far, angle = float(np.linalg.norm(offset)), float(np.linalg.norm(turn))
        result = target.copy()
        if far > _MAX_LAG[0]:
            result[:3, 3] = pose[:3, 3] + offset * (_MAX_LAG[0] / far)
        if angle > _MAX_LAG[1]:
            result[:3, :3] = _rotation(turn * (_MAX_LAG[1] / angle)) @ pose[:3, :3]
        return result


def _carried(pose: np.ndarray, base: np.ndarray, twist_base: np.ndarray) -> np.ndarray:
    """Velocity (6,) in the map that the moving base gives the hand."""
    velocity = np.zeros(6)
    velocity[:2] = base[:2, :2] @ twist_base[:2]
    x, y = pose[:2, 3] - base[:2, 3]
    velocity[:2] += twist_base[2] * np.array((-y, x))
    velocity[5] = twist_base[2]
    return velocity


def _integrate(pose: np.ndarray, twist: np.ndarray, dt: float) -> np.ndarray:
    result = pose.copy()
    result[:3, 3] += twist[:3] * dt
    result[:3, :3] = _rotation(twist[3:] * dt) @ pose[:3, :3]
    return result


def _rotation(vector: np.ndarray) -> np.ndarray:
    return pin.exp3(np.ascontiguousarray(vector))


def _rotation_vector(R: np.ndarray) -> np.ndarray:
    return pin.log3(np.ascontiguousarray(R))
