"""What the networks see of a clip: small frames with two channels, the share of the pixel covered and its depth.

A depth image has no value outside the gown, and networks need one everywhere.  Each 2 x 2 block of pixels becomes one
pixel with two numbers: how much of the block the gown covers, and the mean over the block of the depth relative to the
gown's usual depth, counting zero where there is no gown.  Both change smoothly when the outline moves by less than a
pixel, which is what a falling gown's small differences consist of.
"""

from __future__ import annotations

import numpy as np

from .dataset import DepthArray

CENTRE = 2.6  # [m] usual distance of the gown from the camera: this depth becomes zero
SCALE = 0.3  # [m] depth that counts as one
BLOCK = 2  # pixels of the clip along one pixel of the frame
CHUNK = 256  # clips at a time, which bounds the memory


def frames_of(depth: np.ndarray | DepthArray) -> np.ndarray:
    """Frames for the networks.

    Args:
        depth: (N, T, H, W) [m], NaN outside the gown; H and W are even.

    Returns:
        (N, T, 2, H / 2, W / 2) float16: covered share in [0, 1], relative depth [1].
    """
    n, t, height, width = depth.shape
    frames = np.empty((n, t, 2, height // BLOCK, width // BLOCK), dtype=np.float16)
    for start in range(0, n, CHUNK):
        part = depth[start : start + CHUNK].reshape(-1, t, height // BLOCK, BLOCK, width // BLOCK, BLOCK)
        seen = np.isfinite(part)
        relative = np.where(seen, (part - CENTRE) / SCALE, 0.0)
        frames[start : start + CHUNK, :, 0] = seen.mean(axis=(3, 5))
        frames[start : start + CHUNK, :, 1] = np.clip(relative, -4.0, 4.0).mean(axis=(3, 5))
    return frames
