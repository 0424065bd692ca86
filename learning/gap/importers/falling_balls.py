"""Balls dropped from a bridge, filmed at 15 Hz: one set per ball, first drop to fit, second held out."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from .setting import write_set

OUNCE, CENTIMETRE = 0.028349523, 0.01
KNOWN = {
    "Baseball": "baseball",
    "Blue Basketball": "bluebasketball",
    "Green Basketball": "greenbasketball",
    "Bowling Ball": "heavyBowling",
    "Golf Ball": "golfball",
    "Tennis Ball": "tennisball",
    "Whiffle Ball 1": "wiffleball1",
    "Whiffle Ball 2": "wiffleball2",
    "Yellow Whiffle Ball": "yellowWiffle",
    "Orange Whiffle Ball": "orangeWiffle",
}  # the list has two bowling balls; which was dropped is not said


def sizes(path: Path) -> dict[str, tuple[float, float]]:
    """Ball -> (mass [kg], diameter [m]) from the list of ounces and circumferences; unknown ones are left out."""
    out = {}
    for line in path.read_text().splitlines()[1:]:
        parts = line.split()
        if len(parts) == 3 and re.fullmatch(r"[\d.]+", parts[1]):
            out[parts[0]] = (float(parts[1]) * OUNCE, float(parts[2]) * CENTIMETRE / np.pi)
    return out


def write(files: dict[str, Path], out: Path) -> list[Path]:
    """One folder per ball."""
    import openpyxl

    known = sizes(files["balls.txt"])
    with files["Ball_drops_data.xls"].open("rb") as file:  # an xlsx in spite of its name
        book = openpyxl.load_workbook(file, read_only=True, data_only=True)
        written = []
        for sheet in book.worksheets:
            rows = np.array(
                [
                    [float(str(c)) for c in row[:3]]
                    for row in sheet.iter_rows(min_row=2, values_only=True)
                    if row[0] is not None and all(isinstance(c, int | float) for c in row[:3])
                ]
            )
            header: dict = {"system": "fall"}
            if KNOWN.get(sheet.title) in known and sheet.title != "Bowling Ball":
                mass, diameter = known[KNOWN[sheet.title]]
                header |= {"mass": round(mass, 5), "diameter": round(float(diameter), 5)}
            episodes = []
            for number, role in ((1, "fit"), (2, "heldout")):
                drop = rows[rows[:, 0] == number]
                episodes.append((f"drop_{number}", role, {"t": drop[:, 1] - drop[0, 1], "h": drop[:, 2]}))
            written.append(write_set(out / sheet.title.lower().replace(" ", "_"), header, episodes))
    return written
