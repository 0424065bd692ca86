"""What a consumer depth camera makes of a picture: depth in steps, pixels that fly at edges, pixels without depth."""

from __future__ import annotations

import numpy as np

from ..scene import difficulties


def disturbed_depth(
    depth: np.ndarray, rng: np.random.Generator, sizes: difficulties.DepthNoise = difficulties.SIZES.depth_noise
) -> np.ndarray:
    """The depth that is delivered.

    Args:
        depth: (H, W) [m], 0 where there is none.
        rng: of this difficulty alone.
        sizes: of steps, edges and shares.

    Returns:
        (H, W) float32 [m]; 0 where there is none.
    """
    beyond = _across_edge(depth, sizes.edge)
    edge = beyond > 0
    flying, between, lost = rng.random((3, *depth.shape), dtype=np.float32)
    mixed = np.where(edge & (flying < sizes.flying), depth + between * (beyond - depth), depth)
    # equal steps of disparity d = 1 / (step * z): their depth grows with its square
    with np.errstate(divide="ignore"):
        disparity = np.round(1.0 / (sizes.step * mixed))
        stepped = 1.0 / (sizes.step * disparity)
    stepped[lost < np.where(edge, sizes.edge_dropout, sizes.dropout)] = 0.0
    return np.where(mixed > 0, stepped, 0.0).astype(np.float32)


def _across_edge(depth: np.ndarray, edge: float) -> np.ndarray:
    """(H, W) depth of the neighbour that is furthest away in depth, if it is by more than `edge` [m]; else 0."""
    beyond, widest = np.zeros_like(depth), np.full_like(depth, edge)
    rows = np.s_[:-1, :], np.s_[1:, :]
    columns = np.s_[:, :-1], np.s_[:, 1:]
    for here, there in (rows, rows[::-1], columns, columns[::-1]):
        gap = np.where((depth[here] > 0) & (depth[there] > 0), np.abs(depth[here] - depth[there]), 0.0)
        wider = gap > widest[here]
        beyond[here] = np.where(wider, depth[there], beyond[here])
        widest[here] = np.where(wider, gap, widest[here])
    return beyond
