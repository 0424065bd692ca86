"""Timing of joint motions: as fast as velocity, acceleration and the hand's speed limit allow (toppra)."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from ...sim.mechanics.collision import CollisionChecker
from ...sim.mechanics.kinematics import Kinematics
from ...sim.mechanics.path_timing import toppra
from ...sim.quantity import Quantities, quantity
from ...sim.world import SIDES, JointTrajectory, Side
from .errors import MotionBlocked

# a limit [m/s], or limits (k,) for places (k, 3) of a hand in the map
HandSpeed = float | Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True, kw_only=True)
class TrajectoryTuning(Quantities):
    """Numbers of timing a joint motion."""

    sample_period: float = quantity(0.02, "s", "between two samples of a trajectory", "choice: some in every tick")
    limit_margin: float = quantity(
        0.95,
        "1",
        "share of the limits that is used",
        "choice: between the points where toppra checks them a motion overshoots by a few percent",
    )
    grid_step: float = quantity(0.02, "rad", "between the points where toppra checks the limits", "choice: fine enough")
    grid_intervals: tuple[int, int] = quantity(
        (40, 200), "1", "least and greatest number of intervals between them", "choice: bounds the time of computing"
    )
    checked_samples: int = quantity(
        60, "1", "samples of a motion that are tested for contact, about", "choice: bounds the time of computing"
    )


TRAJECTORY = TrajectoryTuning()


def plan_joint_motion(
    kinematics: Kinematics,
    waypoints: Mapping[Side, np.ndarray],
    pose_base_in_map: np.ndarray | None = None,
    *,
    speed_scale: float = 1.0,
    hand_speed: HandSpeed | None = None,
    checker: CollisionChecker | None = None,
    other_arm: np.ndarray | None = None,
    tuning: TrajectoryTuning = TRAJECTORY,
) -> JointTrajectory:
    """Time a smooth motion of one or both arms through waypoints, from rest to rest.

    Args:
        kinematics: the robot.
        waypoints: by side, (k, n) joint angles with the current ones first [rad]; both sides need the same k.
        pose_base_in_map: (3,) where the base stands; needed with `checker` or a `hand_speed` that depends on place.
        speed_scale: share of the velocity limits to use; accelerations scale with its square.
        hand_speed: greatest speed of each hand [m/s], or for each of a hand's positions (k, 3) in the map that (k,).
        checker: when given, every sample is tested.
        other_arm: (n,) angles of the arm that does not move, for `checker`; the ready posture when omitted.
        tuning: numbers of the timing.

    Returns:
        One trajectory with n or 2 n joints, sampled evenly.

    Raises:
        MotionBlocked: a sample collides, or no timing exists.
        ValueError: waypoints that do not fit together.
    """
    sides: list[Side] = [side for side in SIDES if side in waypoints]
    paths = [np.atleast_2d(np.asarray(waypoints[side], float)) for side in sides]
    robot = kinematics.robot
    if not paths or any(path.shape != (len(paths[0]), robot.dof) for path in paths):
        shapes = ", ".join(f"{side} {np.shape(waypoints[side])}" for side in sides)
        raise ValueError(f"waypoints are (k, {robot.dof}) for each side with the same k, got {shapes or 'none'}")
    if not 0.0 < speed_scale <= 1.0:
        raise ValueError(f"speed_scale must be over 0 and at most 1, got {speed_scale}")
    base = np.zeros(3) if pose_base_in_map is None else np.asarray(pose_base_in_map, float)
    points = _distinct(np.hstack(paths))
    joints = tuple(name for side in sides for name in robot.joints_of(side))
    if len(points) == 1:  # already there
        times = np.array((0.0, tuning.sample_period))
        return JointTrajectory(joints=joints, times=times, positions=np.repeat(points, 2, 0))
    times, samples = _retime(kinematics, sides, points, base, speed_scale, hand_speed, tuning)
    if checker is not None:
        check_motion(checker, sides, samples, base, other_arm, tuning=tuning)
    return JointTrajectory(joints=joints, times=times, positions=samples)


def check_motion(
    checker: CollisionChecker,
    sides: list[Side],
    samples: np.ndarray,
    pose_base_in_map: np.ndarray,
    other_arm: np.ndarray | None = None,
    *,
    tuning: TrajectoryTuning = TRAJECTORY,
) -> None:
    """Test a motion for contacts.

    What touches at the first sample, where velocity control has brought the arms, may touch until it comes free.

    Args:
        checker: of the arms against the robot and what stands around it.
        sides: that move.
        samples: (k, n or 2 n) joint angles of those arms [rad].
        pose_base_in_map: (3,) where the base stands.
        other_arm: (n,) angles of the arm that does not move [rad]; the ready posture when omitted.
        tuning: how many samples are tested.

    Raises:
        MotionBlocked: names the first pair that would touch.
    """
    robot = checker.robot
    arms = robot.ready.copy()
    if other_arm is not None and len(sides) == 1:
        arms[1 - SIDES.index(sides[0])] = other_arm
    step = max(1, len(samples) // tuning.checked_samples)
    chosen = np.unique(np.append(np.arange(0, len(samples), step), len(samples) - 1))
    postures = np.repeat(arms[None], len(chosen), axis=0)
    for n, side in enumerate(sides):
        postures[:, SIDES.index(side)] = samples[chosen, robot.dof * n : robot.dof * (n + 1)]
    given, leaving = standing_contacts(checker, sides, pose_base_in_map, postures[0]), set[tuple[str, str]]()
    free_along = checker.free_along(pose_base_in_map, postures)
    for k, posture, free in zip(chosen, postures, free_along, strict=True):
        hits = [] if free else checker.collisions(pose_base_in_map, posture)
        touching = [hit for hit in hits if hit not in given]
        leaving = set(touching) if k == 0 else leaving & set(touching)
        if not leaving.issuperset(touching) or (touching and k == chosen[-1]):
            a, b = touching[0]
            raise MotionBlocked(f"the motion would bring {a.replace('_', ' ')} against {b.replace('_', ' ')}")


def standing_contacts(
    checker: CollisionChecker, moving: list[Side], pose_base_in_map: np.ndarray, arms: np.ndarray
) -> set[tuple[str, str]]:
    """Contacts, as pairs of names, of the arm that does not move; they do not forbid the other one to move.

    Args:
        checker: of the arms against the robot and what stands around it.
        moving: sides that move.
        pose_base_in_map: (3,) where the base stands.
        arms: (2, n) joint angles of both arms [rad].
    """
    if len(moving) == len(SIDES):
        return set()
    return {
        hit
        for hit in checker.collisions(pose_base_in_map, arms)
        if not any(name.startswith(side) for side in moving for name in hit)
    }


def free_postures(
    checker: CollisionChecker,
    moving: Side | list[Side],
    pose_base_in_map: np.ndarray,
    arms: np.ndarray,
    *,
    leaving: bool = False,
) -> Callable[[np.ndarray], bool]:
    """A test of postures, (n,) of one arm or (2 n,) of both [rad]: whether they make no new contact.

    Args:
        checker: of the arms against the robot and what stands around it.
        moving: side or sides of the arms that move.
        pose_base_in_map: (3,) where the base stands.
        arms: (2, n) joint angles of both arms, of which those that do not move stay [rad].
        leaving: for a motion that begins at `arms`: what touches there may stay as near, and come no nearer.
    """
    sides: list[Side] = moving if isinstance(moving, list) else [moving]
    rows, given = [SIDES.index(side) for side in sides], standing_contacts(checker, sides, pose_base_in_map, arms)
    begins = checker.contacts(pose_base_in_map, arms) if leaving else None

    def accept(q: np.ndarray) -> bool:
        trial = np.array(arms, float)
        trial[rows] = q.reshape(-1, trial.shape[1])
        if begins:
            return checker.free(pose_base_in_map, trial, leaving=begins)
        if given:
            return given.issuperset(checker.collisions(pose_base_in_map, trial))
        return checker.free(pose_base_in_map, trial)

    return accept


def _distinct(points: np.ndarray) -> np.ndarray:
    """Waypoints without repetitions, which a spline cannot pass."""
    keep = np.append(True, np.abs(np.diff(points, axis=0)).max(axis=1) > 1e-6)
    return points[keep]


def _retime(
    kinematics: Kinematics,
    sides: list[Side],
    points: np.ndarray,
    base: np.ndarray,
    scale: float,
    hand_speed: HandSpeed | None,
    tuning: TrajectoryTuning,
) -> tuple[np.ndarray, np.ndarray]:
    """Times (k,) [s] and samples (k, n) [rad] of the fastest motion through points (m, n)."""
    timing = toppra()
    timing.setup_logging("ERROR")
    length = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1)))
    path = timing.SplineInterpolator(length, points)
    limits = [kinematics.limits[side] for side in sides]
    constraints = list(_joint_constraints(kinematics, tuple(sides), scale, tuning.limit_margin))
    if hand_speed is not None:
        constraints.append(_hand_speed_constraint(kinematics, sides, base, hand_speed, tuning.limit_margin))
    grid = np.linspace(0.0, length[-1], int(np.clip(length[-1] / tuning.grid_step, *tuning.grid_intervals)) + 1)
    problem = timing.algorithm.TOPPRA(constraints, path, gridpoints=grid, solver_wrapper="seidel")
    trajectory: Any = problem.compute_trajectory(0.0, 0.0)
    if trajectory is None:
        raise MotionBlocked("no timing of this joint path keeps the velocity and acceleration limits")
    duration = float(trajectory.duration)
    times = np.linspace(0.0, duration, max(2, int(np.ceil(duration / tuning.sample_period)) + 1))
    samples = trajectory(times)
    lower = np.concatenate([limit.lower for limit in limits])
    upper = np.concatenate([limit.upper for limit in limits])
    return times, np.clip(samples, lower, upper)


@lru_cache(maxsize=64)
def _joint_constraints(kinematics: Kinematics, sides: tuple[Side, ...], scale: float, margin: float) -> tuple[Any, ...]:
    """Toppra's constraints of the joints' rates; it writes a description of each, which takes longer than their use."""
    constraint = toppra().constraint
    limits = [kinematics.limits[side] for side in sides]
    velocity = scale * np.concatenate([limit.velocity for limit in limits])
    acceleration = margin * scale**2 * np.concatenate([limit.acceleration for limit in limits])
    return (
        constraint.JointVelocityConstraint(np.stack((-velocity, velocity), axis=1)),
        constraint.JointAccelerationConstraint(
            np.stack((-acceleration, acceleration), axis=1), constraint.DiscretizationType.Interpolation
        ),
    )


def _hand_speed_constraint(
    kinematics: Kinematics, sides: list[Side], base: np.ndarray, hand_speed: HandSpeed, margin: float
) -> Any:
    """A toppra constraint: path speed such that no hand exceeds its limit there."""
    from toppra.constraint import ConstraintType, DiscretizationType, LinearConstraint

    count = kinematics.robot.dof

    class HandSpeedConstraint(LinearConstraint):
        """sdot^2 <= (limit / |d hand / d s|)^2 at every grid point."""

        def __init__(self) -> None:
            super().__init__()
            self.dof = count * len(sides)
            self.discretization_type = DiscretizationType.Collocation
            self._format_string = "    hand speed limit"
            self.constraint_type = ConstraintType.CanonicalLinear

        def compute_constraint_params(self, path: Any, gridpoints: np.ndarray, *_: Any) -> tuple:
            bounds = np.full((len(gridpoints), 2), (0.0, 1e6))
            angles, slopes = path(gridpoints), path(gridpoints, 1)
            for k, side in enumerate(sides):
                mine = slice(count * k, count * (k + 1))
                limit = hand_speed
                if callable(limit):
                    limit = limit(kinematics.places_of_hand_in_map(side, angles[:, mine], base))
                moved = kinematics.velocities_of_hand_in_base(side, angles[:, mine], slopes[:, mine])
                pace = margin * limit / np.maximum(np.sqrt(np.vecdot(moved, moved)), 1e-6)
                # one by one, as numpy rounds a square otherwise in the last bit
                bounds[:, 1] = np.minimum(bounds[:, 1], [each**2 for each in pace.tolist()])
            return None, None, None, None, None, None, bounds

    return HandSpeedConstraint()
