"""Beginning a run with gown and arms somewhere else than at first, as the paper's independent trials do."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from scipy.optimize import least_squares

from ..mechanics.kinematics import Kinematics, kinematics_of
from ..robot.baxter import BAXTER
from ..scene.gown import GownMesh
from ..scene.initial_state import InitialState
from ..scene.person_spec import ARM_AXES, JOINT_LIMITS
from ..world import SIDES, Side, WorldError
from .cloth import ClothBody
from .grip import Grip
from .handle import Handle
from .person import Person

LAID_COLLAR_Y = 0.12  # where the neckline comes to lie, just beyond the fingertips [m]
LAID_CENTRE_X = -0.03  # [m]
_HANG_Y, _HANG_Z = 1.25, 1.28  # where the gown is held before it is laid [m]
_PATH = ((_HANG_Y - 0.35, 1.20), (LAID_COLLAR_Y + 0.25, 1.02), (LAID_COLLAR_Y - 0.05, 0.88))  # neckline's y, z [m]
_SPEED = 0.25  # [m/s]
_PINCHED, _INSIDE = 0.03, 0.008  # fingers that took a corner stood so far apart and had it so deep between them [m]
_FORCE = 30.0  # of the fingers [N]
# Arms that hold a neckline before the chest: hands 0.62 m ahead, 0.74 m apart and 1.36 m high [rad]
_ARM = np.array((1.67, -0.10, -2.02, 2.60, 0.40, 0.18, -0.30))
HOLDING = np.stack((_ARM, _ARM * (-1, 1, -1, 1, -1, 1, -1)))
_AT = 0.01  # such hands are where they should be, in position and each axis' end [m]
HOLDING_AT = (2.7, -0.9, np.pi / 2)  # of the base, back from the rail [m, m, rad]
RAISED = (0.85, 0.58, -1.3, 0.25)  # joints of an arm that was lifted, dressed and let go of [rad]
_RANGE = tuple(zip(*(JOINT_LIMITS[axis] for axis in ARM_AXES), strict=True))  # least and greatest angles [rad]
_OVER_LEGS = 0.22  # height above the mattress at which a gown hung over raised arms turns to lie on the legs [m]
_REST, _FALL = 1.0, 2.0  # until the sleeves are at rest, and until arms that fall are [s]
_DRAWN = np.array(((0.0, -0.10, 0.04), (0.03, 0.12, 0.10)))  # where a strap is drawn to: from here ... to here,
# from the shoulder joint, x outwards [m]
_OVER = np.array(((-0.04, -0.10, 0.10), (-0.08, -0.15, 0.10)))  # where a strap is drawn over the shoulder, likewise:
# from there it is laid down behind it, as a nurse leaves it
_BEHIND = 0.12  # by which it is then lowered [m]
_LOWERING = 1.2  # of the arms [s]


def holding(kinematics: Kinematics) -> np.ndarray:
    """(2, n) angles of arms that hold a neckline before the chest, the hands where Baxter's are [rad].

    Raises:
        WorldError: this robot's hands do not reach there.
    """
    if kinematics.robot is BAXTER:
        return HOLDING
    found = np.empty_like(kinematics.robot.ready)
    for n, side in enumerate(SIDES):
        goal = kinematics_of(BAXTER).pose_hand_in_base(side, HOLDING[n])

        def left(q: np.ndarray, side: Side = side, goal: np.ndarray = goal) -> np.ndarray:
            return (kinematics.pose_hand_in_base(side, q) - goal)[:3].ravel()

        limits = kinematics.limits[side]
        best = least_squares(left, kinematics.robot.ready[n], bounds=(limits.lower, limits.upper))
        if np.abs(best.fun).max() > _AT:
            raise WorldError(
                f"{kinematics.robot.name} cannot begin with the gown in its hands: the {side} one does not reach"
            )
        found[n] = best.x
    return found


def place_by_hand(
    state: InitialState,
    cloth: ClothBody,
    person: Person,
    handles: list[Handle],
    step: Callable[[], None],
    time_step: float,
    *,
    seed: int,
) -> None:
    """Bring the gown to where a state on the person has it.

    Args:
        state: laid on the legs, worn or dressed.
        cloth: the gown, held by nothing.
        person: on the bed.
        handles: two handles that hold nothing.
        step: passes one physics step.
        time_step: its length [s].
        seed: of the run, which decides how far the sleeves are up.
    """
    if state == InitialState.GOWN_ON_PERSON:
        lay_by_hand(cloth, handles, step, time_step)
        return
    put_on = dress_by_hand if state == InitialState.GOWN_DRESSED else put_on_by_hand
    put_on(cloth, person, handles, step, time_step, np.random.default_rng([seed, 4]).uniform(size=2).tolist())


def lay_by_hand(cloth: ClothBody, handles: list[Handle], step: Callable[[], None], time_step: float) -> None:
    """Hang the gown by its collar corners over the foot of the bed and lay it on the person's legs.

    The outside faces up, the neckline lies across the body just beyond the fingertips of arms at rest.
    The gown is carried by two handles, under the same physics as in a run.

    Args:
        cloth: the gown, held by nothing.
        handles: two handles that hold nothing.
        step: passes one physics step.
        time_step: its length [s].
    """
    mesh = cloth.mesh
    cloth.place(mesh.vertices + (LAID_CENTRE_X, _HANG_Y, _HANG_Z))
    vertices = cloth.vertices()
    poses, pins = [], []
    for handle, corner in zip(handles, mesh.corners, strict=True):
        pose = np.eye(4)
        pose[:3, 3] = vertices[corner]
        near = np.argsort(np.linalg.norm(vertices - vertices[corner], axis=1))[:3]
        handle.reset(pose)
        pins.append(cloth.pin(near, handle.body, handle.link))
        poses.append(pose)

    def carry(y: float, z: float, duration: float) -> None:
        starts = [pose[1:3, 3].copy() for pose in poses]
        count = round(duration / time_step)
        for k in range(1, count + 1):
            for handle, pose, start in zip(handles, poses, starts, strict=True):
                pose[1:3, 3] = start + (np.array((y, z)) - start) * k / count
                handle.follow(pose)
            step()

    carry(_HANG_Y, _HANG_Z, 1.0)
    y0 = _HANG_Y
    for y, z in _PATH:
        carry(y, z, abs(y - y0) / _SPEED + 0.1)
        y0 = y
    for group in pins:
        cloth.unpin(group)
    for _ in range(round(0.8 / time_step)):
        step()


def put_on_by_hand(
    cloth: ClothBody,
    person: Person,
    handles: list[Handle],
    step: Callable[[], None],
    time_step: float,
    drawn: Sequence[float],
    raised: tuple[float, float, float, float] = RAISED,
) -> None:
    """Raise the person's arms, hang the sleeves over the hands and draw both up by their straps, some less than others.

    The arms stay up and spread, as after dressing; those that fall lie in the end.  How far up them the sleeves come to
    rest once the straps are let go of is up to the physics.

    Args:
        cloth: the gown, held by nothing.
        person: the manikin.
        handles: two handles that hold nothing.
        step: passes one physics step.
        time_step: its length [s].
        drawn: how far the left and the right strap are drawn, 0 for beyond the shoulder to 1 for well before it.
        raised: joints of both arms [rad].
    """
    pins, starts = _take_straps(cloth, person, handles, raised)
    ends = _off_shoulders(person, [_DRAWN[0] + share * (_DRAWN[1] - _DRAWN[0]) for share in drawn])
    count = round(np.linalg.norm(ends[0] - starts[0]) / _SPEED / time_step)
    for k in range(count + round(0.5 / time_step)):
        for handle, start, end in zip(handles, starts, ends, strict=True):
            pose = np.eye(4)
            pose[:3, 3] = start + (end - start) * min(1.0, (k + 1) / count)
            handle.follow(pose)
        if k % 5 == 0:
            person.resist()
        step()
    _let_go(cloth, person, pins, step, time_step)


def dress_by_hand(
    cloth: ClothBody,
    person: Person,
    handles: list[Handle],
    step: Callable[[], None],
    time_step: float,
    over: Sequence[float],
) -> None:
    """As `put_on_by_hand`, but draw both straps over the shoulders, lay the arms down, and only then let the straps go.

    Args:
        cloth: the gown, held by nothing.
        person: the manikin.
        handles: two handles that hold nothing.
        step: passes one physics step.
        time_step: its length [s].
        over: how far the left and the right strap are drawn over the shoulder, 0 to 1.
    """
    pins, starts = _take_straps(cloth, person, handles, RAISED)
    ends = _off_shoulders(person, [_OVER[0] + share * (_OVER[1] - _OVER[0]) for share in over])
    behind = [end - (0.0, 0.0, _BEHIND) for end in ends]
    drawing = max(float(np.linalg.norm(end - start)) for start, end in zip(starts, ends, strict=True)) / _SPEED

    def carry(froms: list[np.ndarray], tos: list[np.ndarray], duration: float, lower: bool = False) -> None:
        count = round(duration / time_step)
        for k in range(1, count + 1):
            for handle, start, end in zip(handles, froms, tos, strict=True):
                pose = np.eye(4)
                pose[:3, 3] = start + (end - start) * k / count
                handle.follow(pose)
            if lower:
                for side in SIDES:
                    way = np.subtract(person.spec.pose[side], RAISED)
                    person.bend_arm(side, tuple((RAISED + way * k / count).tolist()))
            elif k % 5 == 0:
                person.resist()
            step()

    carry(starts, ends, drawing)
    carry(ends, ends, _LOWERING, lower=True)
    carry(ends, behind, _BEHIND / _SPEED)
    _let_go(cloth, person, pins, step, time_step)


def _take_straps(
    cloth: ClothBody, person: Person, handles: list[Handle], raised: tuple[float, float, float, float]
) -> tuple[list[list[int]], list[np.ndarray]]:
    """Raise both arms, hang the sleeves over the hands, and take both straps: what holds them, and where [m]."""
    mesh = cloth.mesh
    person.brace(True)
    for side in SIDES:
        person.bend_arm(side, raised)
    cloth.place(_over_hands(mesh, person.arms(), person.bed_top + _OVER_LEGS))
    vertices = cloth.vertices()
    pins, starts = [], []
    for handle, side in zip(handles, SIDES, strict=True):
        loop = mesh.vertices[mesh.loops[f"armhole_{side}"]]
        top = np.array((loop[:, 0].mean(), 0.0, loop[:, 2].max()))
        near = np.argsort(np.linalg.norm(mesh.vertices - top, axis=1))[:4]
        pose = np.eye(4)
        pose[:3, 3] = vertices[near].mean(axis=0)
        handle.reset(pose)
        pins.append(cloth.pin(near, handle.body, handle.link))
        starts.append(pose[:3, 3].copy())
    return pins, starts


def _let_go(
    cloth: ClothBody, person: Person, pins: list[list[int]], step: Callable[[], None], time_step: float
) -> None:
    """Let both straps go, and the arms carry themselves, until all is at rest."""
    for group in pins:
        cloth.unpin(group)
    person.brace(False)
    for k in range(round((_FALL if person.spec.falls else _REST) / time_step)):
        if k % 5 == 0:
            person.resist()
        step()


def _off_shoulders(person: Person, offsets: Sequence[np.ndarray]) -> list[np.ndarray]:
    """Places (3,) in the map, given from the left and the right shoulder with x outwards [m]."""
    shoulders = person.arms()[:, 0]
    return [
        shoulder + offset * (np.sign(shoulder[0] - person.bed_xy[0]), 1, 1)
        for shoulder, offset in zip(shoulders, offsets, strict=True)
    ]


def put_arms(person: Person, arms: np.ndarray, unless_within: float = 0.0) -> None:
    """Bend the person's arms to where they were recorded, as near as their joints come.

    Args:
        person: the manikin.
        arms: (2, 4, 3) left and right shoulder, elbow, wrist, fingertip in the map frame [m].
        unless_within: an arm that is so near already stays as it is, and its friction goes on holding it [m].
    """
    for n, side in enumerate(SIDES):
        if np.abs(person.arms()[n] - arms[n]).max() < unless_within:
            continue

        def missed(angles: np.ndarray, n: int = n, side: Side = side) -> np.ndarray:
            person.bend_arm(side, tuple(angles.tolist()))
            return (person.arms()[n] - arms[n]).ravel()

        # the step is much longer than what the engine rounds to
        start = np.clip(person.spec.pose[side], _RANGE[0], _RANGE[1])
        found = least_squares(missed, start, bounds=_RANGE, diff_step=1e-3)
        person.bend_arm(side, tuple(found.x.tolist()))


def _over_hands(mesh: GownMesh, arms: np.ndarray, over_legs: float) -> np.ndarray:
    """(V, 3) the gown hung upright before the raised hands, which point into its armholes, its lower part lying."""
    holes = [mesh.vertices[mesh.loops[f"armhole_{side}"]].mean(axis=0) for side in SIDES]
    ways = arms[:, 3] - arms[:, 1]
    out = ways.mean(axis=0) * (0, 1, 1)
    out /= np.linalg.norm(out)  # where the gown's outside faces
    down = np.array((0.0, out[2], -out[1]))
    spot = np.mean(
        [
            arm[2] + way * (abs(hole[0]) - abs(arm[2, 0] - arms[:, 2, 0].mean())) / abs(way[0])
            for arm, way, hole in zip(arms, ways, holes, strict=True)
        ],
        axis=0,
    )
    top = spot - down * -holes[0][2]
    straight = (top[2] - over_legs) / -down[2]  # length of the part that hangs
    depth = -mesh.vertices[:, 2]
    placed = top + np.minimum(depth, straight)[:, None] * down + np.outer(np.maximum(depth - straight, 0), (0, 1, 0))
    placed = placed + np.outer(mesh.vertices[:, 0], (1, 0, 0)) + np.outer(mesh.vertices[:, 1], out)
    for way in ways:  # sleeves lean along the arms
        mine = np.sign(mesh.vertices[:, 0]) == np.sign(way[0])
        placed[mine, 0] += mesh.vertices[mine, 1] * way[0] / (way @ out)
    return placed


def hold_in_hands(
    cloth: ClothBody, grips: list[Grip], hands: np.ndarray, step: Callable[[], None], time_step: float
) -> None:
    """Hang the gown by its collar corners between the robot's closed fingers, outside to the robot.

    Args:
        cloth: the gown, held by nothing.
        grips: of the left and the right hand.
        hands: (2, 4, 4) their poses in the map.
        step: passes one physics step.
        time_step: its length [s].
    """
    mesh = cloth.mesh
    left, right = hands[0, :3, 3], hands[1, :3, 3]  # the robot's left hand holds the wearer's right corner
    across = (left - right) / np.linalg.norm(left - right)
    outside = np.cross((0.0, 0.0, 1.0), across)  # towards the robot
    span = np.ptp(mesh.vertices[list(mesh.corners), 0])
    local = mesh.vertices * (np.linalg.norm(left - right) / span, 1.0, 1.0)
    turn = np.column_stack((across, outside, (0.0, 0.0, 1.0)))
    cloth.place(local @ turn.T + (left + right) / 2 - _INSIDE * (hands[0, :3, 2] + hands[1, :3, 2]) / 2)
    vertices = cloth.vertices()
    for grip, pose in zip(grips, hands, strict=True):
        grip.on_command(0.0, _PINCHED)
        grip.take_cloth(vertices, pose)
    for _ in range(round(1.5 / time_step)):
        for grip, pose in zip(grips, hands, strict=True):
            grip.handle.follow(pose)
        step()
    for grip in grips * 20:  # readings are smoothed
        grip.watch(cloth.vertices(), _FORCE)
