"""How fast commands move the hands, and how much slower a trajectory must run near the person."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...sim.abilities import HandKinematics
from ...sim.mechanics.robot_model import RobotModel
from ...sim.world import SIDES, JointTrajectory, Observation, Side
from ...skills.geometry.person_zone import PersonZone

# hand_positions(side, joint_positions (k, n) [rad], base_pose (3,)) -> (k, 3) in the map [m]
HandPositions = Callable[[Side, np.ndarray, np.ndarray], np.ndarray]
SAMPLE = 0.05  # [s] between the places where a trajectory is checked
SAMPLES_MAX = 2000
REACH = 1.4  # [m] shoulder to fingertips: bounds a hand's speed when no kinematics are known


def hand_positions_from(kinematics: HandKinematics | None) -> HandPositions | None:
    """Where a robot's model puts its hands; None where no model is known."""
    if kinematics is None:
        return None

    def positions(side: Side, joint_positions: np.ndarray, base_pose: np.ndarray) -> np.ndarray:
        return np.array([kinematics.pose_hand_in_map(side, q, base_pose)[:3, 3] for q in joint_positions])

    return positions


def sampled(trajectory: JointTrajectory) -> tuple[np.ndarray, np.ndarray]:
    """Times (m,) and positions (m, n) at the knots and at most `SAMPLE` apart between them."""
    times = np.asarray(trajectory.times, float)
    count = int(min(np.ceil(times[-1] / SAMPLE), SAMPLES_MAX))
    fine = np.union1d(times, np.linspace(0.0, times[-1], count + 1))
    columns = np.asarray(trajectory.positions, float).T
    return fine, np.stack([np.interp(fine, times, column) for column in columns], axis=1)


def hand_path(
    robot: RobotModel, trajectory: JointTrajectory, side: Side, observation: Observation, hand_positions: HandPositions
) -> tuple[np.ndarray, np.ndarray] | None:
    """Times (m,) and hand positions (m, 3) of one side, or None when the trajectory does not move that arm."""
    names = robot.joints_of(side)
    if not set(names) & set(trajectory.joints):
        return None
    times, positions = sampled(trajectory)
    q = np.tile(observation.arm_positions[SIDES.index(side)], (len(times), 1))
    for column, joint in enumerate(trajectory.joints):
        if joint in names:
            q[:, names.index(joint)] = positions[:, column]
    return times, np.asarray(hand_positions(side, q, observation.pose_base_in_map), float)


def near_speed(times: np.ndarray, ends: np.ndarray, radii: np.ndarray, zone: PersonZone, near: float) -> float:
    """Highest speed of links while either end of a step is near the person [m/s]; 0 when never.

    Args:
        times: (k,) [s].
        ends: (k, r, 2, 3) of the links' axes [m].
        radii: (r,) of the links [m].
        zone: where the person is.
        near: closer than this counts [m].
    """
    if len(times) < 2:
        return 0.0
    count, links = ends.shape[:2]
    speed = np.linalg.norm(np.diff(ends, axis=0), axis=3).max(axis=2) / np.maximum(np.diff(times), 1e-9)[:, None]
    gap = zone.link_distance(ends.reshape(-1, 2, 3), np.tile(radii, count)).reshape(count, links)
    close = gap < near
    return float(speed[close[:-1] | close[1:]].max(initial=0.0))


def near_speed_bound(
    trajectory: JointTrajectory, side: Side, observation: Observation, zone: PersonZone, near: float
) -> float:
    """Upper bound of `near_speed` without kinematics: joint speeds times the arm's reach [m/s]."""
    columns = [n for n, joint in enumerate(trajectory.joints) if joint.startswith(f"{side}_")]
    if not columns or len(trajectory.times) < 2:
        return 0.0
    positions = np.asarray(trajectory.positions, float)[:, columns]
    hand = observation.pose_hand_in_map[SIDES.index(side), :3, 3]
    travel = REACH * np.abs(np.diff(positions, axis=0)).sum(axis=1)
    if zone.distance(hand)[0] - travel.sum() >= near:
        return 0.0
    return float((travel / np.maximum(np.diff(np.asarray(trajectory.times, float)), 1e-9)).max())


def stretched(trajectory: JointTrajectory, factor: float) -> JointTrajectory:
    """The same path, `factor` times slower."""
    return JointTrajectory(
        joints=trajectory.joints, times=np.asarray(trajectory.times, float) * factor, positions=trajectory.positions
    )
