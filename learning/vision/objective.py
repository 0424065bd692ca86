"""What the training of `SeeingNetwork` minimises, on batches drawn by seed and step."""

from __future__ import annotations

import numpy as np
import torch  # pyright: ignore[reportMissingImports] - in the extra `learn`
from torch.nn import functional  # pyright: ignore[reportMissingImports] - in the extra `learn`

from ..physics.networks.training import Objective
from .dataset import CELL, NO_PLACE, SHEET_UNIT, SIZE
from .labels import ABSENT, JOINTS, KEY_POINTS, SHOWN
from .network import SeeingNetwork

BATCH = 8
SPREAD = 1.2  # of a key point's peak [cells]
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
        self.network = SeeingNetwork().to(memory_format=torch.channels_last)
        self._data = data

    def batch(self, rng: np.random.Generator) -> dict[str, torch.Tensor]:
        """Draw pictures, some of them mirrored or in other light."""
        rows = [self._one(int(i), rng) for i in rng.integers(len(self._data["surface"]), size=BATCH)]
        return {key: torch.from_numpy(np.stack([row[key] for row in rows])) for key in rows[0]}

    def _one(self, index: int, rng: np.random.Generator) -> dict[str, np.ndarray]:
        row = {key: array[index] for key, array in self._data.items()}
        rgb = row["rgb"].astype(np.float32) * rng.uniform(0.7, 1.25) * rng.uniform(0.9, 1.1, (3, 1, 1))
        image = np.concatenate([
            np.clip(rgb, 0, 255), row["depth"][None] * np.float32(1e-3), row["level"][None] * np.float32(1e-3)
        ]).astype(np.float32)  # fmt: skip
        sheet = np.where(row["sheet"] == NO_PLACE, np.nan, row["sheet"] * np.float32(SHEET_UNIT)).astype(np.float32)
        surface, points, seen = row["surface"].astype(np.int64), row["points"].copy(), row["seen"]
        if rng.random() < 0.5:  # the gown and the body are their own mirror images, left for right
            image, surface, sheet = image[:, :, ::-1].copy(), surface[:, ::-1].copy(), sheet[:, :, ::-1].copy()
            sheet[0] *= -1
            points[:, 0] = SIZE[0] - 1 - points[:, 0]
            points, seen = points[_MIRRORED], seen[_MIRRORED]
        return {"image": image, "surface": surface, "sheet": sheet, "heat": _heat(points, seen), "deep": points[:, 2]}

    def loss(self, rng: np.random.Generator) -> torch.Tensor:
        """Loss of one batch drawn with `rng`."""
        batch = self.batch(rng)
        image = batch["image"].contiguous(memory_format=torch.channels_last)
        with torch.autocast("cpu", torch.bfloat16):
            surface, sheet, heat, offset = self.network(image)
        surface, sheet, heat, offset = surface.float(), sheet.float(), heat.float(), offset.float()
        of_surface = functional.cross_entropy(surface, batch["surface"], weight=_RARE)
        there = ~torch.isnan(batch["sheet"])
        place = functional.smooth_l1_loss(sheet[there], batch["sheet"][there], beta=0.05)
        goal, chance = batch["heat"], torch.sigmoid(heat)
        apart = functional.binary_cross_entropy_with_logits(heat, goal, reduction="none")
        peak = (apart * (goal - chance).abs().detach() ** 2).sum() / BATCH / len(KEY_POINTS)
        depth = batch["image"][:, 3, CELL // 2 :: CELL, CELL // 2 :: CELL][:, None]
        solid = batch["surface"][:, CELL // 2 :: CELL, CELL // 2 :: CELL][:, None] > 0
        near = (goal > 0.4) & (depth > 0) & solid
        short = batch["deep"][:, :, None, None] - depth
        deep = functional.smooth_l1_loss(offset[near], torch.clamp(short.expand_as(offset)[near], -0.3, 0.3), beta=0.03)
        return of_surface + 4.0 * torch.nan_to_num(place) + 0.15 * peak + 2.0 * torch.nan_to_num(deep)


def _heat(points: np.ndarray, seen: np.ndarray) -> np.ndarray:
    """(K, 48, 64) wanted chance of each key point's being in a cell.

    A point of the gown has to be seen; a joint of an arm is wanted behind cloth too.
    """
    width, height = SIZE[0] // CELL, SIZE[1] // CELL
    wanted = seen == SHOWN
    wanted[_JOINTS] = seen[_JOINTS] != ABSENT
    u, v = (points[:, k, None] / CELL - (CELL - 1) / 2 / CELL for k in range(2))
    across = np.exp(-((np.arange(width) - u) ** 2) / (2 * SPREAD**2))
    down = np.exp(-((np.arange(height) - v) ** 2) / (2 * SPREAD**2))
    return (down[:, :, None] * across[:, None, :] * wanted[:, None, None]).astype(np.float32)
