"""What the methods see of a clip: small frames with two channels, the share of the pixel covered and its depth.

A depth image has no value outside the gown, and networks need one everywhere.  Small gaps are closed first
(`depth_holes.py`).  Then each 2 x 2 block of pixels becomes one pixel with two numbers: how much of the block the gown
covers, and the mean over the block of the depth relative to the gown's usual depth, counting zero where there is no
gown.  Both change smoothly when the outline moves by less than a pixel, which is what a falling gown's small
differences consist of.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .dataset import DepthArray
from .depth_holes import fill_depth_holes

CENTRE = 2.6  # [m] usual distance of the gown from the camera: this depth becomes zero
SCALE = 0.3  # [m] depth that counts as one
BLOCK = 2  # pixels of the clip along one pixel of the frame
ROUGH = 0.02  # share of closed pixels that tells a camera's clip (2.6 to 5.5 %) from a rendered one (0.1 to 1.6 %)


@dataclass(frozen=True, kw_only=True)
class Seen:
    """What is seen of clips.

    Attributes:
        frames: (N, T, 2, H / 2, W / 2) float16: covered share in [0, 1], relative depth [1].
        rough: (N,) bool, whether a clip has the gaps of a real camera.
    """

    frames: np.ndarray
    rough: np.ndarray


def look_at(depth: np.ndarray | DepthArray) -> Seen:
    """Frames of clips, and what sort of clips they are.

    Args:
        depth: (N, T, H, W) [m], NaN outside the gown; H and W are even.
    """
    n, t, height, width = depth.shape
    frames = np.empty((n, t, 2, height // BLOCK, width // BLOCK), dtype=np.float16)
    rough = np.empty(n, bool)
    for k in range(n):
        whole, closed = fill_depth_holes(depth[k])
        rough[k] = closed > ROUGH
        blocks = whole.reshape(t, height // BLOCK, BLOCK, width // BLOCK, BLOCK)
        there = np.isfinite(blocks)
        relative = np.where(there, (blocks - CENTRE) / SCALE, 0.0)
        frames[k, :, 0] = there.mean(axis=(2, 4))
        frames[k, :, 1] = np.clip(relative, -4.0, 4.0).mean(axis=(2, 4))
    return Seen(frames=frames, rough=rough)


def frames_of(depth: np.ndarray | DepthArray) -> np.ndarray:
    """The frames alone: (N, T, H, W) [m] -> (N, T, 2, H / 2, W / 2) float16."""
    return look_at(depth).frames
