"""Facts about the gown that perception and skills assume: the one place for its lengths and its colours.

A gown for adults that opens at the back.  Its neckline is bound with navy tape, from one shoulder seam to the other.
On either side a strap continues the tape above the armhole; on the person the strap is the shoulder seam.  Each armhole
is bound with magenta tape, each cuff with green; the fabric is printed outside and plain inside.
"""

from __future__ import annotations

from dataclasses import dataclass

from ...sim.quantity import Quantities, quantity

_BAND = "hue from, hue to, saturation from, saturation to, lowest value: "
_BAND_UNIT = "degree, degree, 1, 1, 1"
_BAND_SOURCE = "choice: room for 10 degrees of hue, for light from dim to bright and for the camera's noise"


@dataclass(frozen=True, kw_only=True)
class GownFacts(Quantities):
    """What is known of a gown before it is seen."""

    neckline_length: float = quantity(
        0.84,
        "m",
        "of the neckline's tape from corner to corner, stretched by the gown's weight",
        "design: an adult's gown, within 3 cm",
    )
    hung_neckline_length: float = quantity(
        0.80,
        "m",
        "from the hook through the air to both corners, where the gown hangs by the middle of its neckline",
        "design: the neckline of an adult's gown as it hangs, within 4 cm",
    )
    neckline_middle: float = quantity(
        0.028,
        "m",
        "from half the length of the neckline's tape to its middle, to the wearer's right",
        "design: of 16 points of its edge the ninth is the middle, half a cell of the gown's cut beyond the half",
    )
    strap_width: float = quantity(
        0.055, "m", "of the neckline's tape and of the strap that continues it", "design: one cell of the gown's cut"
    )
    strap_half_length: float = quantity(
        0.082, "m", "from the end of the neckline's tape to the middle of the strap", "design: half an armhole's width"
    )
    armhole_half_width: float = quantity(
        0.08, "m", "of an armhole that lies flat, along the strap", "design: an adult's armhole, rounded"
    )
    armhole_drop: float = quantity(
        0.34,
        "m",
        "farthest that a part of the armhole hangs from the strap it is held by",
        "choice: how it was found is not recorded; a flat armhole is 0.22 m deep, and stretches as it hangs",
    )
    outside_colour: tuple[float, float, float, float, float] = quantity(
        (188.0, 230.0, 0.32, 0.60, 0.08), _BAND_UNIT, _BAND + "printed fabric", _BAND_SOURCE
    )
    inside_colour: tuple[float, float, float, float, float] = quantity(
        (188.0, 230.0, 0.125, 0.32, 0.26), _BAND_UNIT, _BAND + "plain fabric", _BAND_SOURCE
    )
    neckline_colour: tuple[float, float, float, float, float] = quantity(
        (212.0, 250.0, 0.60, 1.00, 0.04), _BAND_UNIT, _BAND + "navy tape", _BAND_SOURCE
    )
    armhole_colour: tuple[float, float, float, float, float] = quantity(
        (300.0, 346.0, 0.50, 1.00, 0.10), _BAND_UNIT, _BAND + "magenta tape", _BAND_SOURCE
    )
    cuff_colour: tuple[float, float, float, float, float] = quantity(
        (115.0, 165.0, 0.48, 1.00, 0.10), _BAND_UNIT, _BAND + "green tape", _BAND_SOURCE
    )


GOWN = GownFacts()
