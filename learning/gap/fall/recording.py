"""A recorded height as a drop: cut where it stops falling, with the ballast it carried."""

from __future__ import annotations

import numpy as np

from ..errors import GapError
from ..measurement import Episode, MeasurementSet, require_columns
from .drop import GRAVITY
from .fit import RELEASE, Drop

MOST_ROWS = 500  # of one drop
BEGUN = 0.02  # of a fall, by which the body is surely on its way
STILL = 1.5  # times `RELEASE`, as a body that falls slowly seems to begin late


def drop_of(measured: MeasurementSet, episode: Episode) -> Drop:
    """One episode of a set as a drop.

    Raises:
        GapError: no heights, heights no fall could make, or a mass that is none.
    """
    factor = _ballast(measured, episode)
    require_columns(episode, ["h"])
    t, h = episode.t - episode.t[0], episode.columns["h"]
    step = float(np.median(np.diff(t)))
    if step > 0.5:
        raise GapError(f"{episode.file}: column 't' steps by {step:g}, it must be in seconds (row 3)")
    jump = np.abs(np.diff(h))
    row = int(np.argmax(jump))
    if jump[row] > 50.0 * max(step, 0.02) * 5.0:
        raise GapError(
            f"{episode.file}: column 'h', row {row + 3} jumps by {jump[row]:g} in {step:g} s, "
            "it must be a height in metres"
        )
    lowest = int(np.argmin(h))
    if lowest < len(h) - 2 and h[-1] - h[lowest] > 0.03 * np.ptp(h):  # it bounced: only the fall is modelled
        t, h = t[:lowest], h[:lowest]
    if len(t) < 12 or h[0] - h[-1] < 0.05:
        raise GapError(f"{episode.file}: column 'h' does not fall (rows 2 to {len(episode.t) + 1})")
    way = h[0] - h.min()
    begun = int(np.argmax(h < h[0] - BEGUN * way))
    still = float(t[begun]) - float(np.sqrt(2.0 * BEGUN * way / GRAVITY))
    if still > STILL * RELEASE:
        raise GapError(
            f"{episode.file}: column 'h' stands still for {still:.2g} s (until about row {begun + 2}), a drop's log "
            f"begins at the release, or at most {RELEASE:g} s before it"
        )
    k = -(-len(t) // MOST_ROWS)  # a drop is smooth: means over a few milliseconds lose nothing of it
    whole = len(t) // k * k
    t, h = (x[:whole].reshape(-1, k).mean(axis=1) for x in (t, h))
    return Drop(name=episode.name, t=t, h=h, factor=factor)


def _ballast(measured: MeasurementSet, episode: Episode) -> float:
    """Mass of the body in this episode over that of the set's."""
    plain, mass = measured.number("mass"), measured.number("mass", episode)
    if mass is None:
        return 1.0
    if plain is None:
        raise GapError(
            f"{measured.folder / 'measurement.yaml'}: {episode.file.name} states a mass and the set states none, "
            "the mass of the body without ballast is needed"
        )
    return mass / plain
