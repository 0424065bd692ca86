"""A pre-grasp action carried out in the spring engine: approach, sweep among cloth that gives way, close, count."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...sim.bullet.grip import cloth_between
from ...sim.bullet.handle import FOLLOWS
from ...sim.pregrasp.action import HandPath
from ...sim.pregrasp.numbers import ACTION, ActionNumbers
from ...sim.robot.hand_boxes import boxes_of
from ...sim.spring.fingers import near_boxes, push_aside
from .gowns import held_sheet
from .hung_state import HungState
from .numbers import HANG

REACH = 0.03  # triangles this near to a box are looked at ... [m]
LOOK = 4  # ... for so many steps


@dataclass(frozen=True, kw_only=True)
class Grasp:
    """What the fingers have when they close.

    Attributes:
        layers: between them.
        corner: whether the wanted corner is in what they hold.
        vertices: (V, 3) of the gown then [m].
        hand: (4, 4) of the hand then.
    """

    layers: int
    corner: bool
    vertices: np.ndarray
    hand: np.ndarray

    @property
    def success(self) -> bool:
        """A single layer, at the wanted corner."""
        return self.layers == 1 and self.corner


def grasp_of(state: HungState, vertices: np.ndarray, path: HandPath, opening: float) -> Grasp:
    """What closing the fingers at the end of a path takes of the cloth (V, 3) [m]."""
    hand = path.pose_at_end
    pinched = cloth_between(vertices, state.faces, hand, opening)
    return Grasp(layers=pinched.layers, corner=state.wanted in pinched.vertices, vertices=vertices, hand=hand)


def waypoints(path: HandPath, dt: float, numbers: ActionNumbers = ACTION) -> np.ndarray:
    """(n, 3) of the fingertips after each step of `dt` [s], from the start to where they close [m]."""
    parts = []
    for a, b, speed in (
        (path.start, path.inside, numbers.approach_speed),
        (path.inside, path.end, numbers.sweep_speed),
    ):
        steps = int(np.ceil(np.linalg.norm(b - a) / speed / dt))
        parts.append(a + (b - a) * (np.arange(1, steps + 1) / max(steps, 1))[:, None])
    return np.concatenate(parts)


def roll_out(state: HungState, path: HandPath, numbers: ActionNumbers = ACTION) -> Grasp:
    """Carry out an action; the same state and path give the same grasp.

    The hand is a little behind its path, as the handle is in PyBullet, and closes where it then is.  Stays meet the
    fingers too.

    Args:
        state: the gown, at rest.
        path: of the hand.
        numbers: of the primitives.
    """
    sheet = held_sheet(state.gown, state.held, state.vertices, state.deep)
    faces, dt = np.ascontiguousarray(sheet.mesh.sewn), HANG.step
    room = np.empty((3 * len(faces), 2), np.int64)
    before, count = path.start, 0
    speeds = np.zeros((3, 6))
    for k, target in enumerate(waypoints(path, dt, numbers)):
        tip = before + FOLLOWS * (target - before)
        boxes = boxes_of(path.turn, before, numbers.opening)
        speeds[:, :3] = (tip - before) / dt
        if k % LOOK == 0:
            count = near_boxes(sheet.x, faces, boxes, REACH, room)
        sheet.free_step()
        sheet.keep_apart(k % LOOK == 0)
        if count:
            push_aside(
                *(sheet.x, sheet.v, sheet.loose, faces, room[:count], boxes, speeds),
                *(numbers.friction, numbers.margin, dt, 3),
            )
        sheet.move_on()
        before = tip
    return grasp_of(state, sheet.x, replace(path, end=before), numbers.opening)
