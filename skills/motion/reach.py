"""Motions of the hands to poses: along a straight line, or any way that is free."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from ...sim.mechanics.collision import CollisionChecker
from ...sim.mechanics.kinematics import Kinematics
from ...sim.quantity import Quantities, quantity
from ...sim.world import SIDES, JointTrajectory, Side
from .errors import MotionBlocked, Unreachable
from .ik import FreeAxis, solve_ik
from .rrt import connect, segment_free
from .trajectory import HandSpeed, free_postures, plan_joint_motion


@dataclass(frozen=True, kw_only=True)
class ReachTuning(Quantities):
    """Numbers of planning motions of the hands."""

    line_step: float = quantity(0.02, "m", "longest step along a straight line", "choice: the spline then keeps to it")
    line_turn: float = quantity(0.1, "rad", "greatest turn of the hand in such a step", "choice: about the same effort")
    max_joint_step: float = quantity(
        0.5, "rad", "greatest change of a joint in such a step", "choice: more means that the arm folds over"
    )
    spacings: tuple[float, float, float] = quantity(
        (0.25, 0.1, 0.04),
        "rad",
        "between the points of a path round an obstacle, tried in turn",
        "choice: a spline through wide-spaced points is quicker, and may cut a corner",
    )
    long_way: float = quantity(
        12.0,
        "s",
        "that a motion round an obstacle takes, from which other ways are looked for",
        "measured: of 430 motions in five runs five took longer, one of them 58 s, as the arm swung round beside the "
        "person (134)",
    )
    ways: int = quantity(3, "1", "round an obstacle, of which the quickest is gone", "choice: bounds the computing")


REACH = ReachTuning()


def plan_hand_line(
    kinematics: Kinematics,
    goals: Mapping[Side, np.ndarray],
    arm_positions: np.ndarray,
    pose_base_in_map: np.ndarray,
    *,
    free: FreeAxis = "none",
    speed_scale: float = 1.0,
    hand_speed: HandSpeed | None = None,
    checker: CollisionChecker | None = None,
    tuning: ReachTuning = REACH,
) -> JointTrajectory:
    """Move one or both hands along straight lines, turning evenly on the way.

    Args:
        kinematics: the robot.
        goals: by side, pose (4, 4) in the map.
        arm_positions: (2, n) where the arms are now [rad].
        pose_base_in_map: (3,) where the base stands.
        free: hand axis about which the orientation does not matter (see `solve_ik`).
        speed_scale: share of the joint limits to use.
        hand_speed: limit on the hands' speed (see `plan_joint_motion`).
        checker: tests the whole motion when given.
        tuning: numbers of the planner.

    Raises:
        Unreachable: a point of a line is out of reach, or the arm would have to fold over on the way.
        MotionBlocked: the motion would hit something.
    """

    def evenly(side: Side, share: float, pose: np.ndarray, before: np.ndarray) -> np.ndarray:
        return solve_ik(kinematics, side, pose, pose_base_in_map, before, free=free, seeds=1)

    waypoints = _along_lines(kinematics, goals, np.asarray(arm_positions, float), pose_base_in_map, evenly, tuning)
    return plan_joint_motion(
        kinematics,
        waypoints,
        pose_base_in_map,
        speed_scale=speed_scale,
        hand_speed=hand_speed,
        checker=checker,
        other_arm=_resting(arm_positions, goals),
    )


def plan_straight_reach(
    kinematics: Kinematics,
    goals: Mapping[Side, np.ndarray],
    arm_positions: np.ndarray,
    pose_base_in_map: np.ndarray,
    *,
    free: FreeAxis = "none",
    speed_scale: float = 1.0,
    hand_speed: HandSpeed | None = None,
    checker: CollisionChecker | None = None,
    tuning: ReachTuning = REACH,
) -> JointTrajectory:
    """Move one or both hands along straight lines, turning on the way as the joints would have it.

    It begins and ends in the postures of the straight joint motion, and between them leaves it as little as the line
    asks for.  So it gets to poses that evenly turning hands do not get to, and keeps off the detours of `plan_reach`,
    whose hands swung 0.1 to 0.3 m aside and stretched the cloth that they held (122, 134).

    Arguments and errors are those of `plan_hand_line`.
    """
    arms = np.asarray(arm_positions, float)
    target = _end_postures(kinematics, goals, arms, pose_base_in_map, free, checker)

    def as_the_joints_turn(side: Side, share: float, pose: np.ndarray, before: np.ndarray) -> np.ndarray:
        n = SIDES.index(side)
        if share == 1.0:
            return target[n]
        between = (1.0 - share) * arms[n] + share * target[n]
        return solve_ik(kinematics, side, pose, pose_base_in_map, between, free="any", seeds=1)

    waypoints = _along_lines(kinematics, goals, arms, pose_base_in_map, as_the_joints_turn, tuning)
    return plan_joint_motion(
        kinematics,
        waypoints,
        pose_base_in_map,
        speed_scale=speed_scale,
        hand_speed=hand_speed,
        checker=checker,
        other_arm=_resting(arms, goals),
    )


def plan_reach(
    kinematics: Kinematics,
    goals: Mapping[Side, np.ndarray],
    arm_positions: np.ndarray,
    pose_base_in_map: np.ndarray,
    *,
    free: FreeAxis = "none",
    speed_scale: float = 1.0,
    hand_speed: HandSpeed | None = None,
    checker: CollisionChecker | None = None,
    tuning: ReachTuning = REACH,
) -> JointTrajectory:
    """Bring one or both hands to poses by any free joint motion: the straight one, or round what blocks it.

    Arguments and errors are those of `plan_hand_line`; the way there is not a line.
    """
    arms = np.asarray(arm_positions, float)
    sides: list[Side] = [side for side in SIDES if side in goals]
    target = _end_postures(kinematics, goals, arms, pose_base_in_map, free, checker)
    return plan_arms(
        kinematics,
        target,
        arms,
        pose_base_in_map,
        sides=tuple(sides),
        speed_scale=speed_scale,
        hand_speed=hand_speed,
        checker=checker,
        tuning=tuning,
    )


def plan_arms(
    kinematics: Kinematics,
    target: np.ndarray,
    arm_positions: np.ndarray,
    pose_base_in_map: np.ndarray,
    *,
    sides: tuple[Side, ...] = SIDES,
    speed_scale: float = 1.0,
    hand_speed: HandSpeed | None = None,
    checker: CollisionChecker | None = None,
    tuning: ReachTuning = REACH,
) -> JointTrajectory:
    """Move the arms on `sides` to joint angles: straight in joint space when that is free, else round what blocks it.

    Args:
        kinematics: the robot.
        target: (2, n) where the arms are to go [rad]; only the rows of `sides` count.
        arm_positions: (2, n) where the arms are now [rad].
        pose_base_in_map: (3,) where the base stands.
        sides: that move.
        speed_scale: share of the joint limits to use.
        hand_speed: limit on the hands' speed (see `plan_joint_motion`).
        checker: tests the whole motion when given.
        tuning: numbers of the planner.

    Raises:
        MotionBlocked: no free way was found.
    """
    moving: list[Side] = [side for side in SIDES if side in sides]
    index = [SIDES.index(side) for side in moving]
    other = None if len(moving) == 2 else arm_positions[1 - index[0]]
    start, goal = np.concatenate([arm_positions[n] for n in index]), np.concatenate([target[n] for n in index])

    dof = kinematics.robot.dof

    def timed(points: np.ndarray) -> JointTrajectory:
        waypoints: dict[Side, np.ndarray] = {side: points[:, dof * n : dof * (n + 1)] for n, side in enumerate(moving)}
        return plan_joint_motion(
            kinematics,
            waypoints,
            pose_base_in_map,
            speed_scale=speed_scale,
            hand_speed=hand_speed,
            checker=checker,
            other_arm=other,
        )

    if checker is None:
        return timed(np.stack((start, goal)))
    free = free_postures(checker, moving, pose_base_in_map, arm_positions)
    leaving = free_postures(checker, moving, pose_base_in_map, arm_positions, leaving=True)
    if segment_free(start, goal, free):
        return timed(np.stack((start, goal)))
    limits = [kinematics.limits[side] for side in moving]
    lower, upper = (
        np.concatenate(ends) for ends in zip(*((limit.lower, limit.upper) for limit in limits), strict=True)
    )

    def round_it(seed: int) -> JointTrajectory:
        corners = connect(start, goal, lower, upper, free, leaving=leaving, seed=seed)
        *wide, narrow = tuning.spacings
        for spacing in wide:
            try:
                return timed(_subdivide(corners, spacing))
            except MotionBlocked:
                continue
        return timed(_subdivide(corners, narrow))

    try:
        way = round_it(0)
    except MotionBlocked as problem:
        hits = checker.collisions(pose_base_in_map, arm_positions)
        if not hits:
            raise
        raise MotionBlocked(f"{problem}: {hits[0][0]} is at {hits[0][1]}".replace("_", " ")) from problem
    for seed in range(1, tuning.ways) if way.times[-1] > tuning.long_way else ():
        with suppress(MotionBlocked):
            way = min(way, round_it(seed), key=lambda each: each.times[-1])
    return way


def _along_lines(
    kinematics: Kinematics,
    goals: Mapping[Side, np.ndarray],
    arms: np.ndarray,
    pose_base_in_map: np.ndarray,
    posture: Callable[[Side, float, np.ndarray, np.ndarray], np.ndarray],
    tuning: ReachTuning,
) -> dict[Side, np.ndarray]:
    """Joint angles (k, n) by side that bring hands along straight lines, from where they are.

    Args:
        kinematics: the robot.
        goals: by side, pose (4, 4) in the map.
        arms: (2, n) where the arms are now [rad].
        pose_base_in_map: (3,) where the base stands.
        posture: by side, share of the line, pose (4, 4) there, and angles (n,) at the point before.
        tuning: how near to each other the points are.

    Raises:
        Unreachable: a point of a line is out of reach, or the arm would have to fold over on the way.
    """
    goals = {side: np.asarray(goals[side], float) for side in SIDES if side in goals}
    starts = {side: kinematics.pose_hand_in_map(side, arms[SIDES.index(side)], pose_base_in_map) for side in goals}
    count = max(_line_points(starts[side], goal, tuning) for side, goal in goals.items())
    shares = np.linspace(0.0, 1.0, count + 1)[1:]
    waypoints: dict[Side, np.ndarray] = {}
    for side, goal in goals.items():
        path = [arms[SIDES.index(side)]]
        for share, pose in zip(shares, _line(starts[side], goal, shares), strict=True):
            q = posture(side, share, pose, path[-1])
            if np.abs(q - path[-1]).max() > tuning.max_joint_step:
                raise Unreachable(
                    f"the {side} arm would fold over {share:.0%} along the straight line to "
                    f"{np.round(goal[:3, 3], 3).tolist()} m",
                    0.0,
                    0.0,
                    q,
                )
            path.append(q)
        waypoints[side] = np.array(path)
    return waypoints


def _resting(arms: np.ndarray, goals: Mapping[Side, np.ndarray]) -> np.ndarray | None:
    """Joint angles (n,) of the arm that has no goal, None where both have one."""
    return next((arms[n] for n, side in enumerate(SIDES) if side not in goals), None)


def _end_postures(
    kinematics: Kinematics,
    goals: Mapping[Side, np.ndarray],
    arms: np.ndarray,
    pose_base_in_map: np.ndarray,
    free: FreeAxis,
    checker: CollisionChecker | None,
) -> np.ndarray:
    """Joint angles (2, n) with the hands that have goals there, free of contact; the other arm as it is."""
    target = arms.copy()
    for side in SIDES:
        if side in goals:
            accept = None if checker is None else free_postures(checker, side, pose_base_in_map, target)
            n = SIDES.index(side)
            target[n] = solve_ik(kinematics, side, goals[side], pose_base_in_map, arms[n], free=free, accept=accept)
    return target


def _subdivide(points: np.ndarray, spacing: float) -> np.ndarray:
    """More points along a polyline (k, n), so that a spline through them keeps close to it."""
    lengths = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1)))
    marks = np.linspace(0.0, lengths[-1], max(2, int(np.ceil(lengths[-1] / spacing)) + 1))
    return np.column_stack([np.interp(marks, lengths, column) for column in points.T])


def _line_points(start: np.ndarray, goal: np.ndarray, tuning: ReachTuning) -> int:
    """Steps of a straight line between two poses (4, 4)."""
    angle = math.acos(np.clip((np.trace(start[:3, :3].T @ goal[:3, :3]) - 1.0) / 2.0, -1.0, 1.0))
    distance = np.linalg.norm(goal[:3, 3] - start[:3, 3])
    return max(1, int(np.ceil(max(distance / tuning.line_step, angle / tuning.line_turn))))


def _line(start: np.ndarray, goal: np.ndarray, shares: np.ndarray) -> Iterator[np.ndarray]:
    """Poses (4, 4) after shares (k,) of a straight line between two poses, turning evenly."""
    from scipy.spatial.transform import Rotation

    turn = Rotation.from_matrix(goal[:3, :3] @ start[:3, :3].T).as_rotvec()
    turns = Rotation.from_rotvec(shares[:, None] * turn).as_matrix()
    for share, turned in zip(shares, turns, strict=True):
        pose = np.eye(4)
        pose[:3, :3] = turned @ start[:3, :3]
        pose[:3, 3] = (1.0 - share) * start[:3, 3] + share * goal[:3, 3]
        yield pose
