"""What the training of `SeeingNetwork` minimises, on batches drawn by seed and step."""

from __future__ import annotations

import numpy as np
import torch  # pyright: ignore[reportMissingImports] - in the extra `learn`
from torch.nn import functional  # pyright: ignore[reportMissingImports] - in the extra `learn`

from ..physics.networks.training import Objective
from .dataset import CELL, NO_PLACE, SHEET_UNIT, SIZE, image_of
from .labels import ABSENT, HIDDEN, JOINTS, KEY_POINTS, SHOWN
from .network import SeeingNetwork
from .sheet_nodes import SHEET_NODES, node_weights

BATCH = 8
SPREAD = 0.8  # of a key point's peak [cells]
UNDER = 0.25  # the most that covers an arm which is wanted behind cloth; what is farther behind asks nothing [m]
NO_BED = 0.15  # of the pictures, which are shown as if no bed were known
CUT_OUT = 0.5  # of the pictures, of which a part is shown in their place, as a longer lens would show it
LEAST_PART = 0.6  # of their width and height
_RARE = torch.tensor([1.0, 1.0, 1.0, 2.0, 2.0, 2.0, 1.0])  # weight of each surface: bindings are narrow
_MIRRORED = [KEY_POINTS.index(_other) for _other in (
    name.replace("left", "?").replace("right", "left").replace("?", "right") for name in KEY_POINTS
)]  # fmt: skip
_JOINTS = [k for k, name in enumerate(KEY_POINTS) if name.split("_")[0] in JOINTS]


class Seeing(Objective):
    """Loss of a batch of `load_dataset`'s pictures.

    Args:
        data: arrays of `load_dataset`.
        seed: of the first weights.
    """

    def __init__(self, data: dict[str, np.ndarray], seed: int) -> None:
        torch.manual_seed(seed)
        network = SeeingNetwork()
        self.network = network.to(memory_format=torch.channels_last)  # pyright: ignore[reportCallIssue] - its stubs lack it
        self._data = data

    def batch(self, rng: np.random.Generator) -> dict[str, torch.Tensor]:
        """Draw pictures, some of them mirrored, cut out or in other light."""
        rows = [self._one(int(i), rng) for i in rng.integers(len(self._data["surface"]), size=BATCH)]
        return {key: torch.from_numpy(np.stack([row[key] for row in rows])) for key in rows[0]}

    def _one(self, index: int, rng: np.random.Generator) -> dict[str, np.ndarray]:
        row = {key: array[index] for key, array in self._data.items()}
        image = image_of(row)
        image[:3] = np.clip(image[:3] * rng.uniform(0.7, 1.25) * rng.uniform(0.9, 1.1, (3, 1, 1)), 0, 255)
        if rng.random() < NO_BED:
            image[5:] = 0.0
        sheet = np.where(row["sheet"] == NO_PLACE, np.nan, row["sheet"] * np.float32(SHEET_UNIT)).astype(np.float32)
        surface, points, seen = row["surface"].astype(np.int64), row["points"].copy(), row["seen"]
        if rng.random() < CUT_OUT:
            image, surface, sheet, points, seen = _cut_out(image, surface, sheet, points, seen, rng)
        if rng.random() < 0.5:  # the gown and the body are their own mirror images, left for right
            image, surface, sheet = image[:, :, ::-1].copy(), surface[:, ::-1].copy(), sheet[:, :, ::-1].copy()
            sheet[0] *= -1
            image[5] *= -1
            points[:, 0] = SIZE[0] - 1 - points[:, 0]
            points, seen = points[_MIRRORED], seen[_MIRRORED]
        heat, asked = _heat(points, seen, image[3])
        return {
            "image": image, "surface": surface, "sheet": np.concatenate(node_weights(sheet)),
            "heat": heat, "asked": asked, "deep": points[:, 2],
        }  # fmt: skip

    def loss(self, rng: np.random.Generator) -> torch.Tensor:
        """Loss of one batch drawn with `rng`."""
        batch = self.batch(rng)
        image = batch["image"].contiguous(memory_format=torch.channels_last)
        with torch.autocast("cpu", torch.bfloat16):
            surface, sheet, heat, offset = self.network(image)
        surface, sheet, heat, offset = surface.float(), sheet.float(), heat.float(), offset.float()
        of_surface = functional.cross_entropy(surface, batch["surface"], weight=_RARE)
        place = _sheet_loss(sheet, batch["sheet"])
        peak = _peak_loss(heat, batch["heat"], batch["asked"])
        goal = batch["heat"] / batch["heat"].amax(dim=(2, 3), keepdim=True).clamp(min=1e-6)
        depth = batch["image"][:, 3, CELL // 2 :: CELL, CELL // 2 :: CELL][:, None]
        solid = batch["surface"][:, CELL // 2 :: CELL, CELL // 2 :: CELL][:, None] > 0
        near = (goal > 0.4) & (depth > 0) & solid
        short = batch["deep"][:, :, None, None] - depth
        deep = functional.smooth_l1_loss(offset[near], torch.clamp(short.expand_as(offset)[near], -0.3, 0.3), beta=0.03)
        return of_surface + 0.3 * place + 0.3 * peak + 2.0 * torch.nan_to_num(deep)


def _cut_out(
    image: np.ndarray,
    surface: np.ndarray,
    sheet: np.ndarray,
    points: np.ndarray,
    seen: np.ndarray,
    rng: np.random.Generator,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """A part of a picture, as large as the whole one was, and its labels; key points beside it are absent.

    What distance, height and bed say of a pixel stays true, so that the network learns to go by these.

    Args:
        image: (8, 192, 256) of `dataset.image_of`.
        surface: (192, 256).
        sheet: (2, 48, 64) of its cells' middles [m].
        points: (K, 3) u, v [px] and depth [m].
        seen: (K,) `ABSENT`, `HIDDEN` or `SHOWN`.
        rng: draws the part.
    """
    part = rng.uniform(LEAST_PART, 1.0)
    size = np.array(SIZE)
    low = rng.uniform(0.0, 1.0 - part, 2) * size
    columns, rows = ((low[k] + (np.arange(size[k]) + 0.5) * part).astype(int) for k in range(2))
    cells = [each[CELL // 2 :: CELL] // CELL for each in (rows, columns)]
    there = points.copy()
    there[:, :2] = (points[:, :2] + 0.5 - low) / part - 0.5
    inside = ((there[:, :2] > -0.5) & (there[:, :2] < size - 0.5)).all(axis=1)
    pixels = np.ix_(rows, columns)
    return (
        np.ascontiguousarray(image[:, pixels[0], pixels[1]]), surface[pixels],
        sheet[:, cells[0][:, None], cells[1]], there, np.where(inside, seen, ABSENT),
    )  # fmt: skip


def _sheet_loss(scores: torch.Tensor, weights: torch.Tensor) -> torch.Tensor:
    """Cross entropy of the nodes (n, S, h, w), summed over the axes, mean over the gown's pixels."""
    sizes = [len(axis) for axis in SHEET_NODES]
    gown = weights[:, : sizes[0]].sum(dim=1)
    apart = [
        -(goal * functional.log_softmax(mine, 1)).sum(dim=1)
        for mine, goal in zip(scores.split(sizes, 1), weights.split(sizes, 1), strict=True)
    ]
    return (torch.stack(apart).sum(dim=0) * gown).sum() / gown.sum().clamp(min=1.0)


def _peak_loss(heat: torch.Tensor, goal: torch.Tensor, asked: torch.Tensor) -> torch.Tensor:
    """Cross entropy of where each key point is, (n, K, h, w): in one of the cells, or nowhere, whose score is 0.

    All cells compete: with a yes or no for each of 3,072 cells, of which nine or none are yes, the network was never
    sure of any, and a sixth of the corners were within 8 pixels after 3,700 steps.
    """
    flat = torch.cat([torch.zeros_like(heat[:, :, :1, 0]), heat.flatten(2)], 2)
    wanted = goal.flatten(2)
    wanted = torch.cat([1.0 - wanted.sum(dim=2, keepdim=True), wanted], 2)
    apart = -(wanted * functional.log_softmax(flat, 2)).sum(dim=2)
    return (apart * asked).sum() / asked.sum().clamp(min=1.0)


def _heat(points: np.ndarray, seen: np.ndarray, depth: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(K, 48, 64) wanted chance of each key point's being in a cell, and (K,) 1 where it is asked for at all.

    A point of the gown has to be seen; a joint of an arm is wanted under cloth too, and is not asked for behind more.

    Args:
        points: (K, 3) u, v [px] and depth [m].
        seen: (K,) `ABSENT`, `HIDDEN` or `SHOWN`.
        depth: (192, 256) of the picture [m], 0 where there is none.
    """
    width, height = SIZE[0] // CELL, SIZE[1] // CELL
    wanted, asked = seen == SHOWN, np.ones(len(seen), np.float32)
    for k in _JOINTS:
        if seen[k] == HIDDEN:
            u, v = np.clip(np.round(points[k, :2]).astype(int), 0, (SIZE[0] - 1, SIZE[1] - 1))
            wanted[k] = points[k, 2] - depth[v, u] < UNDER
            asked[k] = wanted[k]
    u, v = (points[:, k, None] / CELL - (CELL - 1) / 2 / CELL for k in range(2))
    across = np.exp(-((np.arange(width) - u) ** 2) / (2 * SPREAD**2))
    down = np.exp(-((np.arange(height) - v) ** 2) / (2 * SPREAD**2))
    peaks = down[:, :, None] * across[:, None, :] * wanted[:, None, None]
    return (peaks / np.maximum(peaks.sum(axis=(1, 2), keepdims=True), 1e-6)).astype(np.float32), asked
