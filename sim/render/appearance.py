"""Colours and light of the simulated room, varied with the seed.

Assumption, written down because perception rests on it: as on many hospital gowns, the binding tapes
contrast with the fabric (navy around the neck, magenta around the armholes, green at the cuffs; none shares its hue
with skin, bed or robot) and the fabric is printed outside and plain inside.  Hue, brightness and light vary from
run to run.
"""

from __future__ import annotations

import colorsys
from dataclasses import dataclass

import numpy as np

from ..scene.gown import ARMHOLE, COLLAR, CUFF, FABRIC, GownMesh
from .raster import DOTS, Light, Print

Colour = tuple[float, float, float]  # red, green, blue, 0-255

_NOMINAL: dict[str, tuple[float, float, float]] = {  # hue [degrees], saturation, value
    "gown_outside": (208, 0.46, 0.86),
    "gown_inside": (208, 0.19, 0.94),
    "collar": (228, 0.78, 0.36),
    "armhole": (325, 0.74, 0.82),
    "cuff": (140, 0.72, 0.58),
    "skin": (22, 0.42, 0.84),
    "shorts": (60, 0.08, 0.25),
    "sheet": (60, 0.03, 0.82),
    "bed_frame": (40, 0.03, 0.55),
    "floor": (40, 0.22, 0.72),
    "wall": (50, 0.04, 0.93),
    "rail": (0, 0.0, 0.22),
    "robot": (0, 0.72, 0.55),
    "robot_grey": (0, 0.0, 0.30),
}


@dataclass(frozen=True, kw_only=True)
class Appearance:
    """What the cameras of one run see.

    Attributes:
        colours: name -> red, green, blue.
        light: lamp and ambient light.
        on_cloth: what is printed on the gown's outside.
        tint: colour of the light, which `colours` hold already: a factor of red, green and blue.
    """

    colours: dict[str, Colour]
    light: Light
    on_cloth: Print = DOTS
    tint: tuple[float, float, float] = (1.0, 1.0, 1.0)


def draw_appearance(rng: np.random.Generator) -> Appearance:
    """Draw hue within 8 degrees, brightness within 8 % (skin 40 %), intensity in 0.7-1.2 and a lamp on the ceiling."""
    colours: dict[str, Colour] = {}
    for name, (hue, saturation, value) in _NOMINAL.items():
        h = (hue + rng.uniform(-8, 8)) % 360 / 360
        darkest = 0.60 if name == "skin" else 0.92  # people differ more than laundry does
        saturation, value = saturation * rng.uniform(0.92, 1.08), value * rng.uniform(darkest, 1.06)
        red, green, blue = colorsys.hsv_to_rgb(h, saturation, value)
        colours[name] = (255 * red, 255 * green, 255 * blue)
    lamp = np.array((rng.uniform(-0.8, 0.8), rng.uniform(-0.8, 0.8), 1.0))
    return Appearance(
        colours=colours,
        light=Light(direction_in_map=lamp / np.linalg.norm(lamp), intensity=float(rng.uniform(0.7, 1.2))),
    )


def gown_colours(mesh: GownMesh, appearance: Appearance) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Front colours (F, 3), back colours (F, 3), print coordinates (V, 2) and printed faces (F,) of a gown."""
    by_label = {COLLAR: "collar", ARMHOLE: "armhole", CUFF: "cuff"}
    front = np.empty((len(mesh.faces), 3))
    back = np.empty((len(mesh.faces), 3))
    for label in (FABRIC, COLLAR, ARMHOLE, CUFF):
        mine = mesh.labels == label
        front[mine] = appearance.colours[by_label.get(label, "gown_outside")]
        back[mine] = appearance.colours[by_label.get(label, "gown_inside")]
    # sleeves stand along y in the rest shape: x + y keeps the print from being stretched there
    uv = np.column_stack([mesh.vertices[:, 0] + mesh.vertices[:, 1], mesh.vertices[:, 2]])
    return front, back, uv, mesh.labels == FABRIC
