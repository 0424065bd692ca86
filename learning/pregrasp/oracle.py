"""Who knows where the corner is and tries everything there: the ceiling of any policy, and its demonstrator."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...sim.pregrasp.action import Action, hand_path
from ...sim.pregrasp.numbers import ACTION, DIRECT, PRIMITIVES, ActionNumbers
from ...sim.pregrasp.views import Views
from .hung_state import HungState
from .roll_out import roll_out

# (row, column) from the pixel in which the corner lies [px]; the first is that pixel itself
PIXELS = ((0, 0), (0, -3), (0, 3), (-2, 0), (2, 0))
NEAREST = 4  # a corner in no pixel of the gown is looked for so far around [px]
DRAWN = 8  # direct grasps that are drawn in a state, and as many sweeps
NEAR = 0.08  # of the corner: where they are drawn [m]


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


def try_until(state: HungState, views: Views, pixels: int = len(PIXELS)) -> list[Attempt]:
    """No more of the oracle's actions than tell its four ceilings; see `ceiling.Ceiling`.

    A kind of action is tried until one succeeds, and not at all where a kind that it includes has succeeded.
    """
    tried: list[Attempt] = []

    def wins(direct: bool, middle: bool) -> bool:
        for pixel, action in choices(state, views, pixels):
            if (action.primitive == DIRECT) == direct and (pixel == 0) == middle:
                tried.append(attempt(state, views, action, pixel))
                if tried[-1].success:
                    return True
        return False

    if not wins(direct=True, middle=True):
        aside = wins(direct=False, middle=True)
        if not wins(direct=True, middle=False) and not aside:
            wins(direct=False, middle=False)
    return tried


def try_drawn(state: HungState, views: Views, count: int = DRAWN) -> list[Attempt]:
    """What comes of some direct grasps and as many sweeps at pixels near the corner that its seed draws."""
    rng = np.random.default_rng([state.seed, 21])
    spots = near_corner(state.vertices[state.wanted], views, NEAR)
    tried: list[Attempt] = []
    for primitives in ((DIRECT,), tuple(k for k in range(len(PRIMITIVES)) if k != DIRECT)):
        for view, row, column in rng.permutation(spots)[:count].tolist():
            action = Action(primitive=int(rng.choice(primitives)), view=view, row=row, column=column)
            tried.append(attempt(state, views, action))
    return tried


def near_corner(corner: np.ndarray, views: Views, radius: float) -> np.ndarray:
    """(n, 3) view, row and column of pixels that show gown within `radius` of a corner (3,) [m]."""
    places, spots = views.places()
    return spots[np.linalg.norm(places - corner, axis=1) < radius]
