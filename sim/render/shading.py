"""Shadows of the lamp, put on a picture that is drawn already; for people's eyes alone.

A second picture is drawn from the lamp: what the lamp does not see lies in shadow.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..compiled import njit
from .camera import looking_at
from .raster import Light, Picture, Triangles, rasterise

LAMP_DISTANCE = 40.0  # so far that its rays are nearly parallel [m]
LAMP_SIZE = 480  # of the picture from the lamp [px]
LAMP_SPAN = 5.6  # width of what the lamp shines on [m]
SHONE_ON = np.array((0.7, 0.2, 0.6))  # its middle [m]
BIAS = 0.03  # a surface does not shade itself [m]
SHADOW = 0.36  # share of the light that a shadow takes


@dataclass(frozen=True)
class ShadowMap:
    """What the lamp sees: depth (n, n) [m], and the lamp's camera."""

    depth: np.ndarray
    pose_lamp_in_map: np.ndarray
    intrinsics: tuple[float, float, float, float]


def shadow_map(triangles: Triangles, light: Light, casting: np.ndarray) -> ShadowMap:
    """Draw the scene from the lamp.

    Args:
        triangles: the scene.
        light: its lamp.
        casting: (m,) bool, faces that throw a shadow.
    """
    pose = looking_at(SHONE_ON + LAMP_DISTANCE * light.direction_in_map, SHONE_ON)
    focal = LAMP_SIZE * LAMP_DISTANCE / LAMP_SPAN
    intrinsics = (focal, focal, (LAMP_SIZE - 1) / 2, (LAMP_SIZE - 1) / 2)
    chosen = Triangles(
        vertices=triangles.vertices,
        faces=triangles.faces[casting],
        front=triangles.front[casting],
        back=triangles.back[casting],
        ids=triangles.ids[casting],
        uv=triangles.uv,
        printed=triangles.printed[casting],
    )
    return ShadowMap(
        rasterise(chosen, light, intrinsics, pose, (LAMP_SIZE, LAMP_SIZE), closed=True).depth, pose, intrinsics
    )


def shaded(
    picture: Picture,
    pose_camera_in_map: np.ndarray,
    intrinsics: tuple[float, float, float, float],
    shadows: ShadowMap,
) -> np.ndarray:
    """The picture's colours (H, W, 3) uint8 with shadows."""
    camera_to_lamp = np.linalg.inv(shadows.pose_lamp_in_map) @ pose_camera_in_map
    rgb = picture.rgb.copy()
    _shade(rgb, picture.depth, np.array(intrinsics), camera_to_lamp, shadows.depth, np.array(shadows.intrinsics))
    return rgb


@njit(nogil=True)
def _shade(rgb, depth, lens, turn, lamp, lamp_lens):
    """Darken `rgb` in place."""
    height, width = depth.shape
    size = lamp.shape[0]
    fx, fy, cx, cy = lens[0], lens[1], lens[2], lens[3]
    for y in range(height):
        for x in range(width):
            z = depth[y, x]
            if z <= 0:
                continue
            px, py = (x - cx) / fx * z, (y - cy) / fy * z
            lx = turn[0, 0] * px + turn[0, 1] * py + turn[0, 2] * z + turn[0, 3]
            ly = turn[1, 0] * px + turn[1, 1] * py + turn[1, 2] * z + turn[1, 3]
            lz = turn[2, 0] * px + turn[2, 1] * py + turn[2, 2] * z + turn[2, 3]
            u = int(lamp_lens[0] * lx / lz + lamp_lens[2] + 0.5)
            v = int(lamp_lens[1] * ly / lz + lamp_lens[3] + 0.5)
            dark = 0
            if 1 <= u < size - 1 and 1 <= v < size - 1:
                for dv in (-1, 0, 1):
                    for du in (-1, 0, 1):
                        seen = lamp[v + dv, u + du]
                        if 0 < seen < lz - BIAS:
                            dark += 1
            if dark == 0:
                continue
            left = 1.0 - SHADOW * dark / 9
            for d in range(3):
                rgb[y, x, d] = int(rgb[y, x, d] * left)
