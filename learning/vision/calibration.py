"""How sure the network may say it is: fitted on pictures that the weights were not trained on."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import torch  # pyright: ignore[reportMissingImports] - in the extra `learn`

from .dataset import CELL, SIZE, image_of
from .labels import ABSENT, JOINTS, KEY_POINTS, SHOWN
from .network import SeeingNetwork

NEAR = 2 * CELL  # of a key point, within which it counts as found [px]
TEMPERATURES = np.geomspace(0.5, 3.0, 40)


def calibrate(network: SeeingNetwork, data: dict[str, np.ndarray]) -> dict[str, object]:
    """Numbers that make confidences honest.

    Args:
        network: trained.
        data: arrays of `load_dataset`, of pictures that it has not seen.

    Returns:
        `temperature` of the surfaces' scores, and `calibration`: kind of key point -> scale and shift of the score of
        its peak, whose logistic is the chance that the peak is right.
    """
    scores: dict[str, list[tuple[float, bool]]] = {name.split("_")[0]: [] for name in KEY_POINTS}
    losses = np.zeros(len(TEMPERATURES))
    for surface, heat, row in _seen(network, data):
        truth = row["surface"].ravel()[::7].astype(int)  # a seventh of the pixels says the same
        logits = surface.reshape(len(surface), -1)[:, ::7]
        for k, temperature in enumerate(TEMPERATURES):
            warm = logits / temperature
            top = warm.max(axis=0)
            mine = np.take_along_axis(warm, truth[None], 0)[0]
            losses[k] += float((np.log(np.exp(warm - top).sum(axis=0)) + top - mine).mean())
        for k, name in enumerate(KEY_POINTS):
            kind = name.split("_")[0]
            v, u = divmod(int(heat[k].argmax()), heat[k].shape[1])
            peak = np.array((u, v)) * CELL + (CELL - 1) / 2
            away = np.linalg.norm(peak - row["points"][k, :2])
            there = row["seen"][k] != ABSENT if kind in JOINTS else row["seen"][k] == SHOWN
            scores[kind].append((peak_score(heat[k], v, u), bool(there and away < NEAR)))
    return {
        "temperature": float(TEMPERATURES[losses.argmin()]),
        "calibration": {kind: logistic(*np.array(rows, float).T) for kind, rows in scores.items()},
    }


def peak_score(heat: np.ndarray, row: int, column: int) -> float:
    """How likely a key point is in the cell of a peak or beside it rather than anywhere else or nowhere: the log odds.

    Args:
        heat: (h, w) scores, beside 0 for nowhere.
        row: of the peak.
        column: of the peak.
    """
    top = max(float(heat.max()), 0.0)
    chance = np.exp(heat.astype(float) - top)
    here = float(chance[max(row - 1, 0) : row + 2, max(column - 1, 0) : column + 2].sum())
    return float(np.log(here + 1e-9) - np.log(chance.sum() + np.exp(-top) - here + 1e-9))


def _seen(
    network: SeeingNetwork, data: dict[str, np.ndarray]
) -> Iterator[tuple[np.ndarray, np.ndarray, dict[str, np.ndarray]]]:
    """Maps of surfaces and key points of every picture, and the picture's own arrays."""
    network.eval()
    for i in range(len(data["surface"])):
        row = {key: array[i] for key, array in data.items()}
        image = image_of(row)
        assert image.shape[1:] == SIZE[::-1]
        with torch.no_grad():
            surface, _, heat, _ = network(torch.from_numpy(image)[None])
        yield surface[0].float().numpy(), heat[0].float().numpy(), row


def logistic(score: np.ndarray, right: np.ndarray, steps: int = 30) -> tuple[float, float]:
    """Scale and shift of scores (n,) whose logistic fits how often they were right (n,), by Newton's method.

    A weak pull towards scale 1 and shift 0 keeps the answer finite where all or none were right.
    """
    x = np.column_stack([score, np.ones_like(score)])
    weights, prior = np.array((1.0, 0.0)), np.array((1.0, 0.0))
    for _ in range(steps):
        chance = 1.0 / (1.0 + np.exp(-np.clip(x @ weights, -30, 30)))
        slope = x.T @ (right - chance) - 0.5 * (weights - prior)
        bend = (x * (chance * (1 - chance))[:, None]).T @ x + 0.5 * np.eye(2)
        weights = weights + np.linalg.solve(bend, slope)
    return float(weights[0]), float(weights[1])
