"""How a room and a gown may look, as data, and which of it no training may ever see.

taped      the gown of `appearance.py`: tapes of three colours, printed outside, in the room of that file
plain      one colour without tapes; the inside is paler, or is like the outside
printed    that, with a pattern outside
random     any of the three, on skin of any tone, in a room and under light of any colour
"""

from __future__ import annotations

import colorsys
from dataclasses import replace

import numpy as np

from ..errors import CaretreeError
from .appearance import Appearance, Colour, draw_appearance
from .raster import Print

TAPED, PLAIN, PRINTED, RANDOM = LOOKS = ("taped", "plain", "printed", "random")

# Red, green, blue.  Those of HELD_OUT are kept from every training: `held_out` of `draw_look` draws them alone.
FABRICS: dict[str, Colour] = {
    "white": (238, 238, 234),
    "sky": (150, 186, 222),
    "mint": (168, 214, 190),
    "teal": (62, 142, 148),
    "navy": (44, 60, 110),
    "lilac": (190, 172, 214),
    "rose": (226, 170, 182),
    "wine": (128, 44, 62),
    "sand": (212, 196, 166),
    "lemon": (236, 222, 140),
    "grey": (150, 152, 156),
    "olive": (118, 128, 84),
    "royal": (58, 92, 190),
    "surgical_green": (70, 150, 112),
    "peach": (240, 190, 150),
    "aubergine": (92, 58, 108),
}
PRINTS = ("dots", "stripes", "checks", "diamonds")
SHEETS: dict[str, Colour] = {
    "white": (209, 208, 203),
    "cream": (222, 212, 186),
    "sky": (170, 196, 222),
    "green": (150, 190, 160),
    "grey": (140, 142, 146),
    "rose": (222, 186, 190),
    "blue": (86, 116, 172),
    "yellow": (226, 214, 150),
}
WALLS: dict[str, Colour] = {
    "white": (237, 236, 228),
    "cream": (232, 220, 190),
    "mint": (196, 220, 204),
    "blue": (176, 198, 220),
    "grey": (168, 170, 174),
    "peach": (236, 204, 178),
    "lilac": (206, 196, 222),
}
FLOORS: dict[str, Colour] = {
    "oak": (184, 174, 143),
    "grey": (140, 142, 146),
    "green": (120, 142, 124),
    "blue": (106, 124, 150),
    "brown": (122, 92, 70),
    "white": (206, 206, 202),
}
HELD_OUT: dict[str, tuple[str, ...]] = {
    "fabrics": ("teal", "lemon", "lilac", "wine"),
    "prints": ("diamonds",),
    "sheets": ("blue", "yellow"),
    "walls": ("peach", "lilac"),
    "floors": ("brown", "blue"),
}
# The Monk skin tone scale, 1 to 10 (Google, 2022, CC BY 4.0).
SKINS: tuple[Colour, ...] = (
    (246, 237, 228), (243, 231, 219), (247, 234, 208), (234, 218, 186), (215, 189, 150),
    (160, 126, 86), (130, 92, 67), (96, 65, 52), (58, 49, 42), (41, 36, 32),
)  # fmt: skip
LIGHTS: dict[str, tuple[float, float, float]] = {  # of a camera whose white balance stays at daylight
    "neutral": (1.0, 1.0, 1.0),
    "warm": (1.0, 0.84, 0.64),
    "cool": (0.80, 0.91, 1.0),
}


def allowed(table: str, *, held_out: bool) -> list[str]:
    """Names in one of the tables of `HELD_OUT`: those for training, or those that are kept from it."""
    names = {"fabrics": FABRICS, "prints": PRINTS, "sheets": SHEETS, "walls": WALLS, "floors": FLOORS}[table]
    return [name for name in names if (name in HELD_OUT[table]) == held_out]


def draw_look(
    look: str,
    rng: np.random.Generator,
    *,
    held_out: bool = False,
    skin: int | None = None,
    light: str | None = None,
) -> Appearance:
    """Draw an appearance; `taped` is exactly what `draw_appearance` gives.

    Args:
        look: one of `LOOKS`.
        rng: of all that is drawn.
        held_out: from what is kept from training, instead of from the rest.
        skin: tone of the Monk scale, 1 to 10; None leaves it to the look.
        light: name in `LIGHTS`; None leaves it to the look.

    Raises:
        CaretreeError: no such look.
    """
    if look not in LOOKS:
        raise CaretreeError(f"unknown look '{look}'; there are {', '.join(LOOKS)}")
    appearance = draw_appearance(rng)
    gown = look
    if look == RANDOM:
        gown = str(rng.choice((TAPED, PLAIN, PRINTED), p=(0.1, 0.45, 0.45)))
        appearance = _any_room(appearance, rng, held_out)
    if gown != TAPED:
        appearance = _without_tapes(appearance, rng, held_out, printed=gown == PRINTED)
    elif look == RANDOM:
        appearance = _any_tapes(appearance, rng, held_out)
    if skin is not None:
        appearance = _tinted(appearance, {"skin": SKINS[skin - 1]})
    if light is not None:
        return _lit(appearance, LIGHTS[light])
    if look == RANDOM:
        other = LIGHTS[str(rng.choice(list(LIGHTS)))]
        return _lit(appearance, tuple(1 + float(rng.uniform(0, 1)) * (np.array(other) - 1)))
    return appearance


def _tinted(appearance: Appearance, colours: dict[str, Colour]) -> Appearance:
    return replace(appearance, colours={**appearance.colours, **colours})


def _lit(appearance: Appearance, tint: tuple[float, ...]) -> Appearance:
    """The same under coloured light: every colour is multiplied by it."""
    red, green, blue = tint
    colours = {name: (r * red, g * green, b * blue) for name, (r, g, b) in appearance.colours.items()}
    return replace(appearance, colours=colours, tint=(red, green, blue))


def _varied(colour: Colour, rng: np.random.Generator, by: float = 0.12) -> Colour:
    """A colour of nearly the same hue, a little lighter or darker, stronger or paler."""
    h, s, v = colorsys.rgb_to_hsv(*(channel / 255 for channel in colour))
    h, s, v = (h + rng.uniform(-by, by) / 6) % 1, s * rng.uniform(1 - by, 1 + by), v * rng.uniform(1 - by, 1 + by / 2)
    red, green, blue = colorsys.hsv_to_rgb(h, min(s, 1.0), min(v, 1.0))
    return 255 * red, 255 * green, 255 * blue


def _from(table: dict[str, Colour], name: str, rng: np.random.Generator, held_out: bool) -> Colour:
    return _varied(table[str(rng.choice(allowed(name, held_out=held_out)))], rng)


def _without_tapes(appearance: Appearance, rng: np.random.Generator, held_out: bool, *, printed: bool) -> Appearance:
    """A gown of one fabric: bindings are of it too, and the inside is paler by an amount that may be nothing."""
    outside = np.array(_from(FABRICS, "fabrics", rng, held_out))
    paler = rng.uniform(0.0, 0.55) * (rng.random() > 0.15)
    inside = outside + paler * (np.array((244.0, 244.0, 240.0)) - outside)
    seam = rng.uniform(0.88, 1.02)  # a binding is two layers of the fabric, seen a little darker
    colours = {"gown_outside": outside, "gown_inside": inside}
    colours |= {name: np.minimum(outside * seam, 255.0) for name in ("collar", "armhole", "cuff")}
    plain = {name: (float(r), float(g), float(b)) for name, (r, g, b) in colours.items()}
    ink = (1.0, 1.0, 1.0)
    pattern, pitch = "dots", 0.035
    if printed:
        pattern = str(rng.choice(allowed("prints", held_out=held_out)))
        pitch = float(rng.uniform(0.02, 0.08))
        marks = np.array(_from(FABRICS, "fabrics", rng, held_out)) / np.maximum(outside, 25.0)
        strength = rng.uniform(0.35, 1.0)
        red, green, blue = np.clip(1 + strength * (marks - 1), 0.15, 1.6)
        ink = float(red), float(green), float(blue)
    return replace(_tinted(appearance, plain), on_cloth=Print(pattern=pattern, pitch=pitch, ink=ink))


def _any_tapes(appearance: Appearance, rng: np.random.Generator, held_out: bool) -> Appearance:
    """A taped gown of any colours."""
    outside = np.array(_from(FABRICS, "fabrics", rng, held_out))
    inside = outside + rng.uniform(0.2, 0.6) * (np.array((244.0, 244.0, 240.0)) - outside)
    tapes = {name: _from(FABRICS, "fabrics", rng, held_out) for name in ("collar", "armhole", "cuff")}
    both = {"gown_outside": outside, "gown_inside": inside}
    return _tinted(appearance, {name: (float(r), float(g), float(b)) for name, (r, g, b) in both.items()} | tapes)


def _any_room(appearance: Appearance, rng: np.random.Generator, held_out: bool) -> Appearance:
    """Skin, sheets, walls and floor of any colour."""
    colours = {
        "skin": _varied(SKINS[rng.integers(len(SKINS))], rng, 0.06),
        "sheet": _from(SHEETS, "sheets", rng, held_out),
        "wall": _from(WALLS, "walls", rng, held_out),
        "floor": _from(FLOORS, "floors", rng, held_out),
        "shorts": _from(FABRICS, "fabrics", rng, held_out),
    }
    return _tinted(appearance, colours)
