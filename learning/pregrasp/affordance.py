"""What a policy is given of the pictures, and the best action of its maps."""

from __future__ import annotations

import numpy as np

from .action import Action
from .numbers import PRIMITIVES
from .oracle import DIRECT
from .views import Views

CHANNELS = 5
GOWN = 1  # the channel that tells gown from background


def seen(views: Views) -> np.ndarray:
    """(6, 5, H, W) float32: how much nearer than the hand's vertical [dm], gown or not, brightness, row and column."""
    mask = (views.depth > 0).astype(np.float32)
    near = mask * (views.numbers.distance - views.depth) * 10.0
    grey = mask * (views.rgb.astype(np.float32).mean(axis=-1) / 128.0 - 1.0)
    height, width = mask.shape[1:]
    rows, columns = np.mgrid[-1 : 1 : height * 1j, -1 : 1 : width * 1j].astype(np.float32)
    return np.stack([near, mask, grey, np.broadcast_to(rows, mask.shape), np.broadcast_to(columns, mask.shape)], 1)


def best_action(values: np.ndarray, views: Views, grasp_only: bool = False) -> Action:
    """The action of the highest value on the gown.

    Args:
        values: (6, 3, H, W), of each view and primitive.
        views: the pictures.
        grasp_only: whether only the direct grasp counts.
    """
    allowed = np.where((views.depth > 0)[:, None], values, -np.inf)
    if grasp_only:
        allowed[:, [k for k in range(len(PRIMITIVES)) if k != DIRECT]] = -np.inf
    view, primitive, row, column = (int(k) for k in np.unravel_index(int(allowed.argmax()), allowed.shape))
    return Action(primitive=primitive, view=view, row=row, column=column)


def any_action(rng: np.random.Generator, views: Views, grasp_only: bool = False) -> Action:
    """Any action on the gown: what an explorer does."""
    spots = np.argwhere(views.depth > 0)
    view, row, column = (int(k) for k in spots[rng.integers(len(spots))])
    primitive = DIRECT if grasp_only else int(rng.integers(len(PRIMITIVES)))
    return Action(primitive=primitive, view=view, row=row, column=column)
