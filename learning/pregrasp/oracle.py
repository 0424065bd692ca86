"""Who knows where the corner is and tries everything there: the ceiling of any policy, and its demonstrator."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from .action import Action, hand_path
from .hung_state import HungState
from .numbers import ACTION, PRIMITIVES, ActionNumbers
from .roll_out import roll_out
from .views import Views

# (row, column) from the pixel in which the corner lies [px]; the first is that pixel itself
PIXELS = ((0, 0), (0, -3), (0, 3), (-2, 0), (2, 0))
NEAREST = 4  # a corner in no pixel of the gown is looked for so far around [px]
DIRECT = PRIMITIVES.index("direct")


@dataclass(frozen=True, kw_only=True)
class Attempt:
    """One action that was carried out.

    Attributes:
        action: which.
        pixel: index in `PIXELS`; -1 of an action that no oracle chose.
        layers: between the fingers.
        corner: whether the wanted corner was in what they held.
    """

    action: Action
    pixel: int
    layers: int
    corner: bool

    @property
    def success(self) -> bool:
        """A single layer, at the wanted corner."""
        return self.layers == 1 and self.corner


def corner_pixel(state: HungState, views: Views, view: int) -> tuple[int, int] | None:
    """(row, column) of the gown's pixel nearest to the wanted corner in a view; None where none is near."""
    row, column = views.pixel(view, state.vertices[state.wanted].astype(float))
    rows, columns = np.nonzero(views.depth[view])
    away = np.hypot(rows - row, columns - column)
    best = int(away.argmin()) if len(away) else -1
    return (int(rows[best]), int(columns[best])) if best >= 0 and away[best] <= NEAREST else None


def choices(state: HungState, views: Views, pixels: int = len(PIXELS)) -> Iterator[tuple[int, Action]]:
    """Every action of the oracle in a state, with the index of its pixel; only the first `pixels` of them."""
    height, width = views.depth.shape[1:]
    for view in range(len(views.depth)):
        middle = corner_pixel(state, views, view)
        if middle is None:
            continue
        for n, (down, right) in enumerate(PIXELS[:pixels]):
            row, column = middle[0] + down, middle[1] + right
            if 0 <= row < height and 0 <= column < width and views.depth[view, row, column] > 0:
                for primitive in range(len(PRIMITIVES)):
                    yield n, Action(primitive=primitive, view=view, row=row, column=column)


def attempt(
    state: HungState, views: Views, action: Action, pixel: int = -1, numbers: ActionNumbers = ACTION
) -> Attempt:
    """Carry out an action in the spring engine; one on no pixel of the gown takes nothing."""
    if views.depth[action.view, action.row, action.column] <= 0:
        return Attempt(action=action, pixel=pixel, layers=0, corner=False)
    grasp = roll_out(state, hand_path(views, action, numbers), numbers)
    return Attempt(action=action, pixel=pixel, layers=grasp.layers, corner=grasp.corner)


def try_all(state: HungState, views: Views, pixels: int = len(PIXELS)) -> list[Attempt]:
    """What comes of every action of the oracle; only at the first `pixels` of them."""
    return [attempt(state, views, action, pixel) for pixel, action in choices(state, views, pixels)]
