"""What a real depth camera adds: noise, holes, pixels lost at the edges."""

from __future__ import annotations

import numpy as np

SIGMA = 0.002  # of the depth at 1 m; grows with the square of the distance, as in sim/render/raster.py [m]
EDGE_LOSS = 0.3  # share of the gown's outline that returns nothing
HOLES = 3.0  # mean number of holes a frame
HOLE_RADIUS = (0.7, 2.5)  # [px]


def disturb(
    depth: np.ndarray,
    rng: np.random.Generator,
    sigma: float = SIGMA,
    edge_loss: float = EDGE_LOSS,
    holes: float = HOLES,
) -> np.ndarray:
    """A clip's depth (frames, H, W) [m] as a consumer camera would have delivered it.

    Args:
        depth: clean, NaN where there is no gown.
        rng: the only source of randomness.
        sigma: standard deviation of the depth at 1 m [m].
        edge_loss: chance that a pixel on the gown's outline is lost.
        holes: mean number of round holes a frame, centred on the gown.

    Returns:
        The same shape, float32; at least one pixel of every frame is left.
    """
    out = depth + sigma * np.nan_to_num(depth) ** 2 * rng.standard_normal(depth.shape)
    rows, columns = np.mgrid[: depth.shape[1], : depth.shape[2]]
    for k in range(len(out)):
        seen = np.isfinite(depth[k])
        inside = seen.copy()
        inside[1:-1, 1:-1] &= seen[:-2, 1:-1] & seen[2:, 1:-1] & seen[1:-1, :-2] & seen[1:-1, 2:]
        lost = (seen & ~inside) & (rng.random(seen.shape) < edge_loss)
        places = np.argwhere(seen)
        for _ in range(rng.poisson(holes)):
            row, column = places[rng.integers(len(places))]
            lost |= (rows - row) ** 2 + (columns - column) ** 2 <= rng.uniform(*HOLE_RADIUS) ** 2
        if (seen & ~lost).any():
            out[k][lost] = np.nan
    return out.astype(np.float32)
