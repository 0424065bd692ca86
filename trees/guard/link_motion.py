"""Where commands bring the robot's links, so that all of them are kept from the person, not only the fingertips."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ...sim.abilities import HandKinematics
from ...sim.mechanics.capsules import RobotCapsules
from ...sim.mechanics.kinematics import Kinematics
from ...sim.mechanics.robot_model import RobotModel
from ...sim.world import SIDES, JointTrajectory, Observation, Side
from .hand_speed import sampled

_DAMPING = 0.02  # [m] of the step from a hand's motion to its joints', so that it stays small at a stretched arm
_DAMPED = _DAMPING**2 * np.eye(6)


class LinkMotion:
    """The links of a robot as capsules, now and after a command.

    Args:
        robot: what it is made of.
        kinematics: of the robot; of another than its own only the points between the fingertips are known.

    Attributes:
        names: (r,) of the capsules.
        radii: (r,) [m].
        known: the robot's own kinematics; None where the links are not known, and only the points between the
            fingertips are.
    """

    def __init__(self, robot: RobotModel, kinematics: HandKinematics) -> None:
        self._robot = robot
        self._kinematics: Any = kinematics
        self.known = kinematics if isinstance(kinematics, Kinematics) else None
        self._links = None if self.known is None else RobotCapsules(self.known)
        if self._links is not None:
            self.names, self.radii = self._links.names, self._links.radii
        else:
            self.names, self.radii = tuple(f"{side}_hand" for side in SIDES), np.zeros(2)
        self._seen: Observation | None = None
        self._seen_ends = np.zeros((0, 2, 3))
        self._went: tuple[JointTrajectory, Observation, tuple[np.ndarray, np.ndarray]] | None = None
        self._postures: tuple[JointTrajectory, Observation, tuple[np.ndarray, np.ndarray]] | None = None
        self._turned: tuple[Observation, tuple[Side, float, bytes], np.ndarray] | None = None
        self._rows = {side: np.array([name.startswith(side) for name in self.names]) for side in SIDES}

    def rows(self, side: Side) -> np.ndarray:
        """(r,) bool: the capsules of one arm."""
        return self._rows[side]

    def ends(self, seen: Observation, arm_positions: np.ndarray | None = None) -> np.ndarray:
        """Ends (r, 2, 3) of all capsules in the map [m], with other angles (2, n) [rad] when given; read-only."""
        if arm_positions is None:  # asked for several times within one tick
            if seen is not self._seen:
                self._seen, self._seen_ends = seen, self._placed(seen, seen.arm_positions)
            return self._seen_ends
        return self._placed(seen, arm_positions)

    def _placed(self, seen: Observation, arms: np.ndarray) -> np.ndarray:
        if self._links is not None:
            return self._links.ends(seen.pose_base_in_map, arms, seen.head_pan, seen.gripper_opening)
        base, place = seen.pose_base_in_map, self._kinematics.pose_hand_in_map
        points = np.array([place(side, arms[n], base)[:3, 3] for n, side in enumerate(SIDES)])
        return np.stack((points, points), axis=1)

    def after_twist(self, seen: Observation, side: Side, twist_in_map: np.ndarray, duration: float) -> np.ndarray:
        """(r, 2, 3) ends once a hand has moved with a twist (6,) for `duration` [s], the base at rest; read-only."""
        asked = side, duration, twist_in_map.tobytes()
        if self._turned is not None and self._turned[0] is seen and self._turned[1] == asked:
            return self._turned[2]  # asked for by what keeps clear, and for the speed of what it has let pass
        n, arms = SIDES.index(side), np.array(seen.arm_positions, float)
        jacobian = self._kinematics.jacobian_hand_in_map(side, arms[n], seen.pose_base_in_map)
        square = jacobian @ jacobian.T + _DAMPED
        arms[n] += duration * jacobian.T @ np.linalg.solve(square, twist_in_map)
        ends = self.ends(seen, arms)
        self._turned = seen, asked, ends
        return ends

    def after_base(self, seen: Observation, velocity: np.ndarray, duration: float) -> np.ndarray:
        """(r, 2, 3) ends once the base has moved with a velocity (3,) in its frame for `duration` [s]."""
        ends = self.ends(seen)
        x, y, yaw = seen.pose_base_in_map.tolist()
        turn = float(velocity[2]) * duration
        c, s = math.cos(turn), math.sin(turn)
        rotation = np.array(((c, -s, 0.0), (s, c, 0.0), (0.0, 0.0, 1.0)))
        c, s = math.cos(yaw), math.sin(yaw)
        heading = np.array(((c, -s), (s, c)))
        foot, moved = np.array((x, y, 0.0)), np.append(heading @ velocity[:2], 0.0) * duration
        return (ends - foot) @ rotation.T + foot + moved

    def along(self, trajectory: JointTrajectory, seen: Observation) -> tuple[np.ndarray, np.ndarray]:
        """Times (k,) [s] and ends (k, r, 2, 3) [m] along a trajectory, the base at rest; read-only."""
        if self._went is not None and self._went[0] is trajectory and self._went[1] is seen:
            return self._went[2]  # asked for once for the speed, once for the person
        times, arms = self.postures(trajectory, seen)
        if self._links is None:
            ends = np.array([self._placed(seen, each) for each in arms])
        else:
            ends = self._links.ends_along(seen.pose_base_in_map, arms, seen.head_pan, seen.gripper_opening)
        way = times, ends
        self._went = trajectory, seen, way
        return way

    def hand_path(
        self, trajectory: JointTrajectory, side: Side, seen: Observation
    ) -> tuple[np.ndarray, np.ndarray] | None:
        """Times (k,) [s] and places (k, 3) of a hand in the map [m]; None where a trajectory does not move that arm."""
        if not set(self._robot.joints_of(side)) & set(trajectory.joints):
            return None
        times, arms = self.postures(trajectory, seen)
        angles, base = arms[:, SIDES.index(side)], seen.pose_base_in_map
        if self.known is not None:
            return times, self.known.places_of_hand_in_map(side, angles, base)
        return times, np.array([self._kinematics.pose_hand_in_map(side, q, base)[:3, 3] for q in angles])

    def postures(self, trajectory: JointTrajectory, seen: Observation) -> tuple[np.ndarray, np.ndarray]:
        """Times (k,) [s] and angles (k, 2, n) [rad] of both arms on a trajectory, read-only; other joints rest."""
        if self._postures is not None and self._postures[0] is trajectory and self._postures[1] is seen:
            return self._postures[2]  # asked for once by `along`, once for the robot's own links
        times, positions = sampled(trajectory)
        arms = np.tile(np.asarray(seen.arm_positions, float), (len(times), 1, 1))
        for column, joint in enumerate(trajectory.joints):
            if (place := self._robot.place_of(joint)) is not None:
                arms[:, place[0], place[1]] = positions[:, column]
        self._postures = trajectory, seen, (times, arms)
        return times, arms
