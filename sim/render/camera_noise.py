"""The noise of an RGB-D camera, on a picture that is drawn without."""

from __future__ import annotations

from functools import cache

import numpy as np
from scipy.special import ndtri

from ..compiled import njit
from .raster import Picture

QUANTILES = 1 << 12  # of the normal distribution, from which noise is taken
NOT_BACK, BACK_FROM = 0.05, 0.20  # cosine below which no light comes back (3 degrees), and from which all does (12)


def add_sensor_noise(
    picture: Picture, rng: np.random.Generator, depth_sigma: float = 0.002, rgb_sigma: float = 2.0
) -> tuple[np.ndarray, np.ndarray]:
    """What a consumer RGB-D camera would have delivered of `picture`.

    Normal numbers are looked up among 4,096 quantiles, by 12 of the 64 random bits that each pixel has: ten times as
    fast as drawing them.

    Args:
        picture: the noiseless picture.
        rng: the only source of randomness.
        depth_sigma: standard deviation of the depth at 1 m [m]; it grows with the square of the distance.
        rgb_sigma: standard deviation of each colour channel, 0-255.

    Returns:
        rgb (H, W, 3) uint8 and depth (H, W) float32 [m], with holes (0) where the surface is seen at a
        grazing angle.
    """
    bits = rng.integers(0, 1 << 64, picture.depth.shape, dtype=np.uint64)
    normal = _quantiles()
    return _noisy(picture.rgb, picture.depth, picture.cosine, bits, normal, float(depth_sigma), float(rgb_sigma))


@cache
def _quantiles() -> np.ndarray:
    """(QUANTILES,) float32, the standard normal distribution's, in the middle of equal chances."""
    return ndtri((np.arange(QUANTILES) + 0.5) / QUANTILES).astype(np.float32)


@njit(nogil=True)
def _noisy(rgb, depth, cosine, bits, normal, depth_sigma, rgb_sigma):
    """Colours and depth with noise: 12 of a pixel's bits for each colour and the depth, 16 for whether it returns."""
    height, width = depth.shape
    noisy_rgb, noisy_depth = np.empty_like(rgb), np.zeros_like(depth)
    for y in range(height):
        for x in range(width):
            left = bits[y, x]
            for d in range(3):
                value = rgb[y, x, d] + rgb_sigma * normal[left & np.uint64(0xFFF)]
                noisy_rgb[y, x, d] = int(min(max(value, 0.0), 255.0))
                left >>= np.uint64(12)
            z = depth[y, x]
            lost = (BACK_FROM - cosine[y, x]) / (BACK_FROM - NOT_BACK)  # chance, 1 and more is sure
            if z > 0 and (left >> np.uint64(12)) >= lost * 65536.0:
                noisy_depth[y, x] = z + depth_sigma * z * z * normal[left & np.uint64(0xFFF)]
    return noisy_rgb, noisy_depth
