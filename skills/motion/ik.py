"""Inverse kinematics of one hand by damped least squares with joint limits, from several seeds.

A hand pose has six degrees of freedom, but most grasps of cloth need five: where the fingertips are and from
where they approach.  `free` names the hand axis about which the solver may turn as it likes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from ...sim.mechanics.kinematics import Kinematics
from ...sim.mechanics.planar import planar_pose
from ...sim.quantity import Quantities, quantity
from ...sim.vector import cross, length
from ...sim.world import SIDES, Side
from .errors import Unreachable
from .ik_step import next_posture

if TYPE_CHECKING:
    import pinocchio as pin  # pyright: ignore[reportMissingImports] - lives in a cmeel prefix

FreeAxis = Literal["none", "approach", "closing", "any"]

_TRIED = "choice: reaches the success rates that tests/skills/motion/test_ik.py asks for"


@dataclass(frozen=True, kw_only=True)
class IkTuning(Quantities):
    """Numbers of the search for joint angles."""

    position_tolerance: float = quantity(
        1e-3, "m", "error of the hand at which it is there", "choice: grasps need less"
    )
    rotation_tolerance: float = quantity(5e-3, "rad", "error of its turn at which it is there", "choice: 0.3 degrees")
    seeds: int = quantity(12, "1", "starting points that are tried", _TRIED)
    iterations: int = quantity(60, "1", "steps from each starting point", _TRIED)
    max_step: float = quantity(0.25, "rad", "greatest change of a joint in one iteration", _TRIED)
    rotation_weight: float = quantity(0.3, "m/rad", "what an error of turning counts, in position", _TRIED)
    rotation_rank: float = quantity(
        0.2,
        "m/rad",
        "the same, where the best of several failed descents is told",
        "choice: only for the message",
    )
    stop_below: float = quantity(
        0.1, "1", "share of the tolerances at which a descent ends early", "choice: more accuracy is of no use"
    )
    damping: float = quantity(1e-3, "1", "of the first step", _TRIED)
    damping_range: tuple[float, float] = quantity((1e-6, 0.1), "1", "least and greatest damping", _TRIED)
    damping_factors: tuple[float, float] = quantity(
        (0.3, 4.0), "1", "of the damping after a step that made the error smaller, and after another one", _TRIED
    )
    stuck_after: int = quantity(25, "1", "iterations after which a descent that stands still is given up", _TRIED)
    stuck_ratio: float = quantity(0.98, "1", "of two errors in a row from which it stands still", _TRIED)
    stuck_error: float = quantity(
        0.01, "m^2", "squared error above which it is given up", "choice: nearer ones may still arrive"
    )
    posture_gain: float = quantity(0.1, "1", "of the drift to a comfortable posture in the null space", _TRIED)
    active_set_rounds: int = quantity(
        3, "1", "solves in one iteration while joints at their limits are taken out", "choice: more are hardly needed"
    )
    random_seed: int = quantity(
        7, "1", "of the random starting points", "choice: the same tries every time, as a run must be reproducible"
    )


IK = IkTuning()
_AXES = np.eye(3)


def solve_ik(
    kinematics: Kinematics,
    side: Side,
    pose_hand_in_map: np.ndarray,
    pose_base_in_map: np.ndarray,
    q_seed: np.ndarray,
    *,
    free: FreeAxis = "none",
    seeds: int = IK.seeds,
    iterations: int = IK.iterations,
    accept: Callable[[np.ndarray], bool] | None = None,
    tuning: IkTuning = IK,
) -> np.ndarray:
    """Joint angles that bring a hand to a pose, near `q_seed` when possible.

    Args:
        kinematics: the robot.
        side: which hand.
        pose_hand_in_map: (4, 4) wanted pose.
        pose_base_in_map: (3,) where the base stands.
        q_seed: (n,) start of the search, usually where the arm is [rad].
        free: hand axis about which the orientation does not matter: `none`, `approach` (z), `closing` (y),
            or `any` (position only).
        seeds: how many starting points to try before giving up.
        iterations: steps from each starting point.
        accept: optional predicate on (n,) angles, for instance a collision check; a solution it refuses is skipped.
        tuning: numbers of the search.

    Returns:
        (n,) angles within the limits; the hand is within 1 mm and 0.3 degrees.

    Raises:
        Unreachable: no starting point led there; carries the best residual.
    """
    import pinocchio as pin  # pyright: ignore[reportMissingImports] - lives in a cmeel prefix

    target = pin.SE3(np.linalg.inv(planar_pose(pose_base_in_map)) @ np.asarray(pose_hand_in_map, float))
    best, refused = (np.inf, np.inf, np.asarray(q_seed, float)), 0
    ready = kinematics.robot.ready[SIDES.index(side)]
    for n, start in enumerate(_starts(kinematics, side, np.asarray(q_seed, float), seeds, tuning)):
        posture = ready if n else start
        q, position, rotation = _descend(kinematics, side, target, start, posture, free, iterations, tuning)
        if position <= tuning.position_tolerance and rotation <= tuning.rotation_tolerance:
            if accept is None or accept(q):
                return q
            refused += 1
        elif position + tuning.rotation_rank * rotation < best[0] + tuning.rotation_rank * best[1]:
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


def half_turned(pose: np.ndarray) -> np.ndarray:
    """A hand pose (4, 4) after half a turn about its approach: it grasps the same, as the fingers are alike."""
    return pose @ np.diag((-1.0, -1.0, 1.0, 1.0))


def _starts(
    kinematics: Kinematics, side: Side, q_seed: np.ndarray, count: int, tuning: IkTuning
) -> Iterator[np.ndarray]:
    """The seed, the ready posture and its elbow variants, then seeded random postures around the middle."""
    limits = kinematics.limits[side]
    ready = kinematics.robot.ready[SIDES.index(side)]
    yield limits.clip(q_seed)
    yield ready
    generator = np.random.default_rng(tuning.random_seed)
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
    tuning: IkTuning,
) -> tuple[np.ndarray, float, float]:
    """Levenberg-Marquardt with clamping, drifting to `posture` where the task leaves it free.

    Returns the best angles met and what is left there in [m] and [rad].
    """
    limits = kinematics.limits[side]
    rows = _task_rows(free)
    turn, (shrink, grow), (least, most) = tuning.rotation_weight, tuning.damping_factors, tuning.damping_range
    weight = np.array((1.0, 1.0, 1.0, turn, turn, turn))[rows]
    q = q.copy()
    last = np.inf
    damping = tuning.damping
    result = (q, np.inf, np.inf)
    for step in range(iterations):
        pose, jacobian = kinematics.pose_and_jacobian_local(side, q)
        error = _error(pose, target, free)
        position, rotation = length(error[:3]), length(error[3:])
        if position + turn * rotation < result[1] + turn * result[2]:
            result = (q.copy(), position, rotation)
        share = tuning.stop_below
        if position < share * tuning.position_tolerance and rotation < share * tuning.rotation_tolerance:
            break
        e = weight * error[rows]
        size = float(e @ e)
        damping = max(damping * shrink, least) if size < last else min(damping * grow, most)
        if step > tuning.stuck_after and size > tuning.stuck_ratio * last and size > tuning.stuck_error:
            break  # stuck far away: another seed is cheaper
        last = size
        q = next_posture(
            jacobian,
            rows,
            weight,
            e,
            tuning.posture_gain * (posture - q),
            damping,
            q,
            limits.lower,
            limits.upper,
            tuning.active_set_rounds,
            tuning.max_step,
        )
    return result


def _task_rows(free: FreeAxis) -> np.ndarray:
    rows = {"none": [0, 1, 2, 3, 4, 5], "approach": [0, 1, 2, 3, 4], "closing": [0, 1, 2, 3, 5], "any": [0, 1, 2]}
    if free not in rows:
        raise ValueError(f"free must be one of {', '.join(rows)}, got {free!r}")
    return np.array(rows[free])


def _error(pose: pin.SE3, target: pin.SE3, free: FreeAxis) -> np.ndarray:
    """What is left (6,), along the hand's axes; the free axis carries none."""
    import pinocchio as pin  # pyright: ignore[reportMissingImports] - lives in a cmeel prefix

    R = pose.rotation
    error = np.zeros(6)
    error[:3] = R.T @ (target.translation - pose.translation)
    if free == "none":
        error[3:] = pin.log3(R.T @ target.rotation)
    elif free != "any":
        k = 2 if free == "approach" else 1
        axis = _AXES[k]
        wanted = R.T @ target.rotation[:, k]
        product, cosine = cross(axis, wanted), float(wanted[k])
        sine = length(product)
        if sine > 1e-9:
            error[3:] = product / sine * math.atan2(sine, cosine)
        elif cosine < 0.0:  # exactly opposite: turn about any other axis
            error[3] = np.pi
    return error
