"""One file per published data set, each turning its files into measurement sets."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from . import dfki_double_pendulum, emps, falling_balls, knit_uniaxial, so101_sage, unisa

Importer = Callable[[dict[str, Path], Path], list[Path]]

IMPORTERS: dict[str, Importer] = {
    "emps": emps.write,
    "unisa_ur10": unisa.write_ur10,
    "unisa_panda": unisa.write_panda,
    "falling_balls": falling_balls.write,
    "knit_uniaxial": knit_uniaxial.write,
    "dfki_double_pendulum": dfki_double_pendulum.write,
    "so101_sage": so101_sage.write,
}
