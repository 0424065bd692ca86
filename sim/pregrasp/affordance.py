"""What a policy is given of the pictures, and the best action of its maps.

The network looks at one picture at a time, and gives four logits a pixel: of success of the three primitives, and of
the wanted corner being there.  From a single picture one end of the gown looks much like another; the corner, though,
is in one place of the hand's frame, so the pictures vote on where that is:

    value of an action = logit of its success + `AGREEING` * log(votes for the place of its pixel)

Pixels of a picture, and nowhere, whose logit is 0, compete for its one vote.
"""

from __future__ import annotations

import numpy as np

from .action import Action
from .numbers import DIRECT, POLICY, PRIMITIVES, PolicyNumbers
from .views import Views

CHANNELS = 5
GOWN, GREY, COLUMN = 1, 2, 4  # the channels of gown or background, of brightness, and of the column
CORNER = len(PRIMITIVES)  # the map that tells where the corner is


def seen(views: Views) -> np.ndarray:
    """(6, 5, H, W) float32: how much nearer than the hand's vertical [dm], gown or not, brightness, row and column."""
    mask = (views.depth > 0).astype(np.float32)
    near = mask * (views.numbers.distance - views.depth) * 10.0
    grey = mask * (views.rgb.astype(np.float32).mean(axis=-1) / 128.0 - 1.0)
    height, width = mask.shape[1:]
    rows, columns = np.mgrid[-1 : 1 : height * 1j, -1 : 1 : width * 1j].astype(np.float32)
    return np.stack([near, mask, grey, np.broadcast_to(rows, mask.shape), np.broadcast_to(columns, mask.shape)], 1)


def votes(maps: np.ndarray, views: Views, numbers: PolicyNumbers = POLICY) -> np.ndarray:
    """(n,) share of the views that see the corner at the place of each pixel of the gown, in the order of `places`.

    Args:
        maps: (6, 4, H, W) of the network.
        views: the pictures.
        numbers: how near is the same place.
    """
    places, spots = views.places()
    logits = maps[:, CORNER][tuple(spots.T)].astype(float)
    top = np.maximum([logits[spots[:, 0] == k].max(initial=0.0) for k in range(len(maps))], 0.0)
    chance = np.exp(logits - top[spots[:, 0]])
    chance /= (np.exp(-top) + np.bincount(spots[:, 0], chance, len(maps)))[spots[:, 0]]
    told = chance > numbers.least_vote
    away = np.linalg.norm(places[:, None] - places[told], axis=2)
    return np.exp(-(away**2) / (2 * numbers.same_place**2)) @ chance[told] / len(maps)


def values_of(maps: np.ndarray, views: Views, numbers: PolicyNumbers = POLICY) -> np.ndarray:
    """(6, 3, H, W) value of each action, -inf where no gown shows.

    Args:
        maps: (6, 4, H, W) of the network.
        views: the pictures.
        numbers: what votes count.
    """
    values = np.full((len(maps), len(PRIMITIVES), *maps.shape[2:]), -np.inf)
    spots = views.places()[1]
    agreed = numbers.agreeing * np.log(votes(maps, views, numbers) + numbers.least_vote)
    view, row, column = spots.T
    values[view, :, row, column] = maps[view, : len(PRIMITIVES), row, column] + agreed[:, None]
    return values


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
