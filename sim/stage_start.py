"""Starting a run at a later stage, as the paper's independent trials do: somebody lays the gown by hand first."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .cloth import Cloth
from .grip import Grip
from .handle import Handle

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
HOLDING_AT = (2.7, -0.9, np.pi / 2)  # of the base, back from the rail [m, m, rad]


def lay_by_hand(cloth: Cloth, handles: list[Handle], step: Callable[[], None], time_step: float) -> None:
    """Hang the gown by its collar corners over the foot of the bed and lay it on the person's legs.

    The outside faces up, the neckline lies across the body just beyond the fingertips of arms at rest, as
    after stage B.  The gown is carried by two handles, under the same physics as in a run.

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



def hold_in_hands(cloth: Cloth, grips: list[Grip], hands: np.ndarray, step: Callable[[], None],
                  time_step: float) -> None:
    """Hang the gown by its collar corners between the robot's closed fingers, outside to the robot, as after stage A.

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
