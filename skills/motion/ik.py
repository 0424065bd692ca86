"""Inverse kinematics of one hand by damped least squares with joint limits, from several seeds.

A hand pose has six degrees of freedom, but most grasps of cloth need five: where the fingertips are and from
where they approach.  `free` names the hand axis about which the solver may turn as it likes.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

import numpy as np
import pinocchio as pin  # pyright: ignore[reportMissingImports] - lives in a cmeel prefix

from ...sim.robot import model
from ...sim.robot.kinematics import Kinematics, planar_pose
from ...sim.world import SIDES, Side
from .errors import Unreachable

FreeAxis = Literal["none", "approach", "closing", "any"]
POSITION_TOLERANCE = 1e-3  # [m]
ROTATION_TOLERANCE = 5e-3  # [rad]
_STEP = 0.25  # greatest change of a joint in one iteration [rad]


def solve_ik(
    kinematics: Kinematics,
    side: Side,
    pose_hand_in_map: np.ndarray,
    pose_base_in_map: np.ndarray,
    q_seed: np.ndarray,
    *,
    free: FreeAxis = "none",
    seeds: int = 12,
    iterations: int = 60,
    accept=None,
) -> np.ndarray:
    """Joint angles that bring a hand to a pose, near `q_seed` when possible.

    Args:
        kinematics: the robot.
        side: which hand.
        pose_hand_in_map: (4, 4) wanted pose.
        pose_base_in_map: (3,) where the base stands.
        q_seed: (7,) start of the search, usually where the arm is [rad].
        free: hand axis about which the orientation does not matter: `none`, `approach` (z), `closing` (y),
            or `any` (position only).
        seeds: how many starting points to try before giving up.
        iterations: steps from each starting point.
        accept: optional predicate on (7,) angles, for instance a collision check; a solution it refuses is skipped.

    Returns:
        (7,) angles within the limits; the hand is within 1 mm and 0.3 degrees.

    Raises:
        Unreachable: no starting point led there; carries the best residual.
    """
    target = pin.SE3(np.linalg.inv(planar_pose(pose_base_in_map)) @ np.asarray(pose_hand_in_map, float))
    best, refused = (np.inf, np.inf, np.asarray(q_seed, float)), 0
    ready = model.READY[SIDES.index(side)]
    for n, start in enumerate(_starts(kinematics, side, np.asarray(q_seed, float), seeds)):
        q, position, rotation = _descend(kinematics, side, target, start, ready if n else start, free, iterations)
        if position <= POSITION_TOLERANCE and rotation <= ROTATION_TOLERANCE:
            if accept is None or accept(q):
                return q
            refused += 1
        elif position + 0.2 * rotation < best[0] + 0.2 * best[1]:
            best = (position, rotation, q)
    where = np.round(np.asarray(pose_hand_in_map)[:3, 3], 3).tolist()
    if refused:
        raise Unreachable(f"the {side} hand reaches {where} m only in {refused} refused postures", 0.0, 0.0, best[2])
    stand = np.round(pose_base_in_map, 2).tolist()
    raise Unreachable(
        f"the {side} hand cannot reach {where} m from base pose {stand}: {best[0] * 1000:.0f} mm and "
        f"{np.rad2deg(best[1]):.1f} degrees are left",
        *best,
    )


def solve_dual_ik(
    kinematics: Kinematics,
    poses_hand_in_map: np.ndarray,
    pose_base_in_map: np.ndarray,
    q_seed: np.ndarray,
    *,
    free: FreeAxis = "none",
    accept=None,
) -> np.ndarray:
    """Both hands at once: poses (2, 4, 4), seed (2, 7); returns (2, 7).

    `accept` is asked about pairs (2, 7), so that a check of one arm against the other can refuse.

    Raises:
        Unreachable: one of the hands does not get there.
    """
    seed = np.asarray(q_seed, float)
    left = solve_ik(kinematics, SIDES[0], poses_hand_in_map[0], pose_base_in_map, seed[0], free=free)
    pair_ok = None if accept is None else lambda q: accept(np.stack((left, q)))
    right = solve_ik(kinematics, SIDES[1], poses_hand_in_map[1], pose_base_in_map, seed[1], free=free, accept=pair_ok)
    return np.stack((left, right))


def hand_pose(position: np.ndarray, approach: np.ndarray, closing: np.ndarray | None = None) -> np.ndarray:
    """Hand pose (4, 4) at `position` with z along `approach` and y as near `closing` as that allows.

    Without `closing` (when the turn about the approach is free) some horizontal direction is taken.

    Raises:
        ValueError: approach is zero, or closing is parallel to it.
    """
    z = np.asarray(approach, float)
    if np.linalg.norm(z) < 1e-9:
        raise ValueError("approach must be a non-zero direction, got a zero vector")
    z = z / np.linalg.norm(z)
    if closing is None:
        closing = np.cross((0.0, 0.0, 1.0), z) if abs(z[2]) < 0.99 else np.array((0.0, 1.0, 0.0))
    y = np.asarray(closing, float) - np.dot(closing, z) * z
    if np.linalg.norm(y) < 1e-6:
        raise ValueError(f"closing {np.round(closing, 3)} must not be parallel to approach {np.round(z, 3)}")
    y = y / np.linalg.norm(y)
    pose = np.eye(4)
    pose[:3, :3] = np.column_stack((np.cross(y, z), y, z))
    pose[:3, 3] = position
    return pose


def _starts(kinematics: Kinematics, side: Side, q_seed: np.ndarray, count: int) -> Iterator[np.ndarray]:
    """The seed, the ready posture and its elbow variants, then seeded random postures around the middle."""
    limits = kinematics.limits[side]
    ready = model.READY[SIDES.index(side)]
    yield limits.clip(q_seed)
    yield ready
    generator = np.random.default_rng(7)  # the same tries every time: a run must be reproducible
    for n in range(count - 2):
        random = generator.uniform(limits.lower, limits.upper)
        yield limits.clip(0.5 * (ready + random) if n % 2 else random)


def _descend(
    kinematics: Kinematics,
    side: Side,
    target: pin.SE3,
    q: np.ndarray,
    posture: np.ndarray,
    free: FreeAxis,
    iterations: int,
) -> tuple[np.ndarray, float, float]:
    """Levenberg-Marquardt with clamping, drifting to `posture` where the task leaves it free.

    Returns the best angles met and what is left there in [m] and [rad].
    """
    limits = kinematics.limits[side]
    rows = _task_rows(free)
    weight = np.array((1.0, 1.0, 1.0, 0.3, 0.3, 0.3))[rows]  # 1 rad counts as 0.3 m
    q = q.copy()
    last = np.inf
    damping = 1e-3
    result = (q, np.inf, np.inf)
    for step in range(iterations):
        pose, jacobian = kinematics.pose_and_jacobian_local(side, q)
        error = _error(pose, target, free)
        position, rotation = float(np.linalg.norm(error[:3])), float(np.linalg.norm(error[3:]))
        if position + 0.3 * rotation < result[1] + 0.3 * result[2]:
            result = (q.copy(), position, rotation)
        if position < 0.1 * POSITION_TOLERANCE and rotation < 0.1 * ROTATION_TOLERANCE:
            break
        e = weight * error[rows]
        size = float(e @ e)
        damping = max(damping * 0.3, 1e-6) if size < last else min(damping * 4.0, 0.1)
        if step > 25 and size > 0.98 * last and size > 0.01:
            break  # stuck far away: another seed is cheaper
        last = size
        J = weight[:, None] * jacobian[rows]
        # Joints at a limit that the step would push further are taken out of the solve.
        free_joints = np.ones(7, bool)
        step_q = np.zeros(7)
        for _ in range(3):
            Jf = J[:, free_joints]
            A = Jf @ Jf.T + damping * np.eye(len(rows))
            drift = 0.1 * (posture - q)[free_joints]  # in the null space
            step_q = np.zeros(7)
            step_q[free_joints] = drift + Jf.T @ np.linalg.solve(A, e - Jf @ drift)
            blocked = ((q <= limits.lower) & (step_q < 0)) | ((q >= limits.upper) & (step_q > 0))
            if not blocked.any():
                break
            free_joints &= ~blocked
        q = limits.clip(q + step_q * min(1.0, _STEP / max(float(np.abs(step_q).max()), 1e-9)))
    return result


def _task_rows(free: FreeAxis) -> list[int]:
    rows = {"none": [0, 1, 2, 3, 4, 5], "approach": [0, 1, 2, 3, 4], "closing": [0, 1, 2, 3, 5], "any": [0, 1, 2]}
    if free not in rows:
        raise ValueError(f"free must be one of {', '.join(rows)}, got {free!r}")
    return rows[free]


def _error(pose: pin.SE3, target: pin.SE3, free: FreeAxis) -> np.ndarray:
    """What is left (6,), along the hand's axes; the free axis carries none."""
    R = pose.rotation
    error = np.zeros(6)
    error[:3] = R.T @ (target.translation - pose.translation)
    if free == "none":
        error[3:] = pin.log3(R.T @ target.rotation)
    elif free != "any":
        k = 2 if free == "approach" else 1
        axis = np.eye(3)[k]
        wanted = R.T @ target.rotation[:, k]
        cross, cosine = np.cross(axis, wanted), float(wanted[k])
        sine = float(np.linalg.norm(cross))
        if sine > 1e-9:
            error[3:] = cross / sine * np.arctan2(sine, cosine)
        elif cosine < 0.0:  # exactly opposite: turn about any other axis
            error[3] = np.pi
    return error
