"""An action: which view, which pixel, which primitive; and the way of the hand that it means."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .numbers import ACTION, PRIMITIVES, ActionNumbers
from .views import UP, Views, level


@dataclass(frozen=True, kw_only=True)
class Action:
    """One of 3 primitives x 6 views x pixels.

    Attributes:
        primitive: index in `PRIMITIVES`.
        view: index of the view.
        row: of the pixel.
        column: of the pixel.
    """

    primitive: int
    view: int
    row: int
    column: int


@dataclass(frozen=True, kw_only=True)
class HandPath:
    """Straight in, and aside.

    Attributes:
        turn: (3, 3) of the hand: y along the closing direction, z out of the palm.
        start: (3,) of the fingertips before they come in [m].
        inside: (3,) where they begin to sweep [m].
        end: (3,) where they close [m].
    """

    turn: np.ndarray
    start: np.ndarray
    inside: np.ndarray
    end: np.ndarray

    @property
    def pose_at_end(self) -> np.ndarray:
        """(4, 4) of the hand where it closes."""
        pose = np.eye(4)
        pose[:3, :3], pose[:3, 3] = self.turn, self.end
        return pose


def hand_path(views: Views, action: Action, numbers: ActionNumbers = ACTION) -> HandPath:
    """The way of the hand, in the frame of the pictures.

    Args:
        views: the pictures; the pixel must have a depth.
        action: what is to be done.
        numbers: of the primitives.

    Raises:
        ValueError: the pixel has no depth.
    """
    place = views.place(action.view, action.row, action.column)
    return path_to(place, views.turn(action.view), action.primitive, numbers)


def path_to(place: np.ndarray, bearing: float, primitive: int, numbers: ActionNumbers = ACTION) -> HandPath:
    """The way of a hand that goes for a place (3,) [m] by a primitive, from the side of a view's direction [rad]."""
    approach = level(bearing + numbers.yaw)
    across = np.cross(approach, UP)  # to the right of who looks along the approach
    turn = np.column_stack([np.cross(across, approach), across, approach])
    inside = place + numbers.depth * approach
    side = {"move_left": -1.0, "direct": 0.0, "move_right": 1.0}[PRIMITIVES[primitive]]
    return HandPath(
        turn=turn, start=inside - numbers.run_up * approach, inside=inside, end=inside + side * numbers.sweep * across
    )
