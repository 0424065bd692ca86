"""From a Cartesian velocity of a hand to joint rates: damped least squares with null-space centring."""

from __future__ import annotations

import numpy as np

from ..compiled import njit
from ..world import SIDES, HandTwist, Side
from .damped_rates import damped_rates
from .kinematics import Kinematics
from .planar import planar_pose
from .twist_law import lead, pace, ramp, swing, swing_allowed

_CENTRING = 0.4  # pull of the null space towards the ready posture at full pace [1/s]
_STILL = np.zeros(6)


class TwistTracker:
    """Follows a `HandTwist` with one arm; until it expires the hand's path holds in the map even while the base moves.

    The twist is ramped at the robot's `hand_acceleration`, integrated into a hand pose, and that pose is followed
    with feedback, so a purely linear twist does not turn the hand.
    """

    def __init__(self, kinematics: Kinematics, side: Side) -> None:
        self._kinematics = kinematics
        self._side: Side = side
        limits, ready = kinematics.limits[side], kinematics.robot.ready[SIDES.index(side)]
        moved = kinematics.robot.limits
        self._joints = np.stack((limits.lower, limits.upper, limits.velocity, ready))  # (4, n)
        self._speed, self._acceleration = moved.hand_velocity, moved.hand_acceleration
        self._wanted = np.zeros(6)
        self._twist = np.zeros(6)
        self._until = -np.inf
        self._active = False
        self._pose: np.ndarray | None = None  # (4, 4) to follow, in the map; None until the first step
        self._time = 0.0

    def start(self, command: HandTwist, time: float) -> HandTwist:
        """Take a new twist; returns it clipped to the hand's speed limits."""
        wanted = np.array(command.twist_in_map, float)
        for part, limit in zip((slice(0, 3), slice(3, 6)), self._speed, strict=True):
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
        dt, self._time = time - self._time, time
        hand_in_base, jacobian, places = self._kinematics.hand_and_joints(self._side, q)
        base = planar_pose(pose_base_in_map)
        hand = base @ hand_in_base
        if self._pose is None:
            self._pose = hand.copy()
            self._twist[:3] = hand[:3, :3] @ (jacobian[:3] @ dq)  # start from what the hand is doing
            self._twist[3:] = hand[:3, :3] @ (jacobian[3:] @ dq)
        wanted = self._wanted if time <= self._until + 1e-9 else _STILL
        fastest = ramp(self._twist, wanted, self._acceleration[0] * dt, self._acceleration[1] * dt)
        if time > self._until and fastest < 1e-6:
            self.cancel()
            return None
        rates = np.empty(len(q))
        behind = (places - hand_in_base[:3, 3]) @ hand_in_base[:3, :3]
        _follow(self._pose, self._twist, dt, base, twist_base, hand, jacobian, behind, q, self._joints, rates)
        return rates


@njit()
def _follow(
    goal: np.ndarray,
    twist: np.ndarray,
    dt: float,
    base: np.ndarray,
    twist_base: np.ndarray,
    hand: np.ndarray,
    jacobian: np.ndarray,
    places: np.ndarray,
    q: np.ndarray,
    joints: np.ndarray,
    rates: np.ndarray,
) -> None:
    """Put the joint rates (n,) in place that follow the pose; see `lead`, `pace`, `damped_rates` and `swing`.

    One call, as it is made at every step, and an array that a compiled function returns costs as much as the call.
    """
    velocity = lead(goal, twist, dt, base, twist_base, hand)
    rates[:] = damped_rates(jacobian, velocity, q, joints, _CENTRING * pace(twist), dt)
    fastest = swing(jacobian, places, rates)
    allowed = swing_allowed(twist, base, twist_base, hand)
    if fastest > allowed:
        rates *= allowed / fastest
