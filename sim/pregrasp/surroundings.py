"""What lies around a grasp: the gown that all pictures show, as cells in the frame of the hand that comes for a pixel.

The same cloth before the same fingers gives the same cells, from whatever side and wherever on the gown; so few
attempts teach what fingers take.  Cells are numbered across the fingers' plane (up), along the approach, and along
the closing.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..quantity import Quantities, quantity
from .action import path_to
from .numbers import ACTION, DIRECT, ActionNumbers
from .views import Views


@dataclass(frozen=True, kw_only=True)
class CellNumbers(Quantities):
    """The box of cells; its middle is ahead of the palm."""

    side: float = quantity(0.015, "m", "of a cell", "choice: a pixel of the pictures")
    up: int = quantity(6, "1", "cells across the fingers' plane, half of them above", "choice: twice a finger's width")
    along: int = quantity(8, "1", "cells along the approach", "choice: palm to beyond the fingertips")
    beyond: float = quantity(0.045, "m", "of the fingertips where the cells end", "choice: three cells")
    across: int = quantity(14, "1", "cells along the closing, half to each side", "choice: a sweep to either side")
    full: int = quantity(4, "1", "points that fill a cell", "choice: one of most pictures")
    reach: float = quantity(0.06, "m", "of the voted corner in which grasps are thought of", "choice: fingers' stroke")
    same_place: float = quantity(0.03, "m", "of the best vote whose votes tell the corner", "choice: as the votes'")


CELLS = CellNumbers()
NOBODY = 1e-12  # weight of a place for which nothing votes


def voted_corner(votes: np.ndarray, places: np.ndarray, numbers: CellNumbers = CELLS) -> np.ndarray:
    """(3,) where the pictures agree that the corner is [m].

    Args:
        votes: (n,) as `affordance.votes` counts them.
        places: (n, 3) of the pixels [m].
        numbers: how near is the same place.
    """
    near = np.linalg.norm(places - places[votes.argmax()], axis=1) < numbers.same_place
    weight = votes[near] ** 2 + NOBODY  # where no picture votes, all of that place counts alike
    return weight @ places[near] / weight.sum()


def surroundings(
    views: Views,
    corner: np.ndarray,
    spots: np.ndarray,
    numbers: CellNumbers = CELLS,
    action: ActionNumbers = ACTION,
) -> tuple[np.ndarray, np.ndarray]:
    """(n, up, along, across) filling of the cells, 0 to 1, and (n, 3) the corner in the hand's frame [m]; both float32.

    Args:
        views: the pictures.
        corner: (3,) where it is taken to be [m].
        spots: (n, 3) view, row and column of pixels that show gown.
        numbers: of the cells.
        action: of the primitives.
    """
    cloud = views.places()[0]
    cloud = cloud[np.linalg.norm(cloud - corner, axis=1) < numbers.side * (numbers.up + numbers.across + numbers.along)]
    filling = np.zeros((len(spots), numbers.up, numbers.along, numbers.across), np.float32)
    corners = np.zeros((len(spots), 3), np.float32)
    for k, (view, row, column) in enumerate(spots.tolist()):
        path = path_to(views.place(view, row, column), views.turn(view), DIRECT, action)
        filling[k] = cells_around(cloud, path.turn, path.inside, numbers)
        corners[k] = (corner - path.inside) @ path.turn
    return filling, corners


def cells_around(cloud: np.ndarray, turn: np.ndarray, tip: np.ndarray, numbers: CellNumbers = CELLS) -> np.ndarray:
    """(up, along, across) filling of the cells around a hand, 0 to 1, float32.

    Args:
        cloud: (n, 3) points that show gown [m].
        turn: (3, 3) of the hand: y along the closing direction, z out of the palm.
        tip: (3,) middle between its fingertips [m].
        numbers: of the cells.
    """
    shape = (numbers.up, numbers.across, numbers.along)
    low = -numbers.side / 2 * np.array(shape, float)
    low[2] = numbers.beyond - numbers.side * numbers.along
    cells = np.floor(((cloud - tip) @ turn - low) / numbers.side).astype(int)
    filling = np.zeros(shape)
    np.add.at(filling, tuple(cells[((cells >= 0) & (cells < shape)).all(axis=1)].T), 1.0)
    return (np.minimum(filling, numbers.full) / numbers.full).transpose(0, 2, 1).astype(np.float32)
