"""How a worn sleeve sits on its arm, by where its tapes show round the arm, in several pictures.

An armhole is a loop round the arm that slants and sags.  Where a membrane across it would meet the arm's axis is near
the mean of its rim over all directions round that axis.  No picture shows all of the rim: each gives the part that it
shows, and what none of them shows lies between the parts beside it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame, Side
from ..errors import PerceptionFailure, Problem
from ..estimates import SleeveProfile
from ..image.surfaces import Surface
from .arm_frame import arm_frame
from .cuff_round_arm import tape_near


@dataclass(frozen=True, kw_only=True)
class SleeveProfileTuning(Quantities):
    """Numbers of how a sleeve sits, by all that shows of it."""

    line: tuple[float, float] = quantity(
        (-1.0, 2.0), "1", "ends of the line beside which tape counts: 0 shoulder, 1 elbow", "choice: all of a sleeve"
    )
    sectors: int = quantity(24, "1", "round the arm's axis that are told apart", "choice: 15 degrees each")
    min_sector_points: int = quantity(3, "1", "of the tape in one of them", "choice: fewer are noise")
    min_sectors: int = quantity(3, "1", "in which it has to show", "choice: fewer tell no loop")
    from_mean: tuple[float, float, float] = quantity(
        (0.062, 0.914, 0.086),
        "1",
        "of how far up an armhole is, and its change with one minus the mean of its rim, and with the share that shows",
        "measured: least squares over 141 states of eleven development seeds, and again over 293 of 12 above 0.55 "
        "(benchmarks/armhole_closely.py): from the head of the bed and both places beside the shoulder, on seeds left "
        "out, 0.026 root mean square, 0.10 at worst; by the rim itself, all of it, 0.021.  Told 0.3 too low were 97 "
        "states of one more seed, whose right sleeve lay across the elbow (128)",
    )
    gathered: tuple[float, float] = quantity(
        (0.30, 0.5),
        "1",
        "of the upper arm between armhole and cuff, on average round the arm, below which a sleeve is gathered, and by "
        "how much lower its armhole is told for what is missing",
        "measured: 181 of 182 states of worn sleeves of seven seeds show 0.32 to 0.73; the left one of 178, which was "
        "turned in with its cuff over its armhole, -0.01 to 0.03, and was told 0.13 too high on average (12 states)",
    )
    full_sectors: int = quantity(12, "1", "that make it certain", "choice: half of the way round")


DEFAULT = SleeveProfileTuning()


def sleeve_profile(
    frame: Frame, side: Side, arm_in_map: np.ndarray, tuning: SleeveProfileTuning = DEFAULT
) -> SleeveProfile:
    """Where the tapes of a sleeve show round its arm.

    Args:
        frame: of any camera.
        side: of the person.
        arm_in_map: (4, 3) shoulder, elbow, wrist, fingertip [m].
        tuning: numbers of the search.

    Raises:
        PerceptionFailure: too little of its armhole is seen.
    """
    line = arm_in_map[0] + np.outer(tuning.line, arm_in_map[1] - arm_in_map[0])
    armhole, cuff = (tape_near(frame, tape, line) for tape in (Surface.ARMHOLE, Surface.CUFF))
    armhole_at, cuff_at = (_in_sectors(points, arm_in_map, tuning) for points in (armhole, cuff))
    shows = np.count_nonzero(~np.isnan(armhole_at))
    if shows < tuning.min_sectors:
        raise PerceptionFailure(Problem.NOTHING_SEEN, f"armhole round the {side} arm")
    return SleeveProfile(
        stamp=frame.stamp,
        confidence=min(1.0, shows / tuning.full_sectors),
        side=side,
        armhole_at=armhole_at,
        cuff_at=cuff_at,
    )


def _in_sectors(points: np.ndarray, arm_in_map: np.ndarray, tuning: SleeveProfileTuning) -> np.ndarray:
    """(n,) share of the upper arm at which points (m, 3) [m] lie in each sector, NaN where there are too few."""
    sector, at = _round_arm(points, arm_in_map, tuning)
    counts, sums = (np.bincount(sector, weights, tuning.sectors) for weights in (None, at))
    return np.where(counts >= tuning.min_sector_points, sums / np.maximum(counts, 1), np.nan)


def _round_arm(
    points: np.ndarray, arm_in_map: np.ndarray, tuning: SleeveProfileTuning
) -> tuple[np.ndarray, np.ndarray]:
    """Sectors (n,) round an arm (4, 3) in which points (n, 3) lie, and the share of the upper arm at each [m]."""
    shoulder, upper = arm_in_map[0], arm_in_map[1] - arm_in_map[0]
    along, up, outwards = arm_frame(arm_in_map)
    off = points - shoulder
    sector = (np.arctan2(off @ outwards, off @ up) / (2.0 * np.pi) % 1.0 * tuning.sectors).astype(int)
    # an angle just below a full turn may round up to one
    return sector % tuning.sectors, off @ along / np.linalg.norm(upper)


def reach_of(profiles: Sequence[SleeveProfile], tuning: SleeveProfileTuning = DEFAULT) -> float:
    """How far up the upper arm an armhole is, 0 elbow, 1 shoulder, by what several pictures show of it.

    Args:
        profiles: one of each picture, at least one.
        tuning: numbers of the rule.
    """
    base, *changes = tuning.from_mean
    apart, lower = tuning.gathered
    missing = max(0.0, apart - between_tapes(profiles))
    return float(np.clip(base + rim_features(profiles) @ np.array(changes) - lower * missing, 0.0, 1.0))


def between_tapes(profiles: Sequence[SleeveProfile]) -> float:
    """Share of the upper arm between an armhole and its cuff, on average round the arm; infinite without a cuff.

    Args:
        profiles: one of each picture, at least one.
    """
    cuff, shown = _rim([profile.cuff_at for profile in profiles])
    return float(np.mean(cuff - _rim([profile.armhole_at for profile in profiles])[0])) if shown else np.inf


def rim_features(profiles: Sequence[SleeveProfile]) -> np.ndarray:
    """(2,) one minus the mean of an armhole's rim over all directions round its arm, and the share of them that shows.

    Args:
        profiles: one of each picture, at least one.
    """
    rim, shown = _rim([profile.armhole_at for profile in profiles])
    return np.array((1.0 - rim.mean(), shown))


def _rim(in_sectors: Sequence[np.ndarray]) -> tuple[np.ndarray, float]:
    """A tape in all sectors (n,), by several pictures (n,) of it, and the share of them that shows."""
    pictures = np.array(in_sectors)
    shows = np.count_nonzero(~np.isnan(pictures), axis=0)
    sectors = np.flatnonzero(shows)
    if len(sectors) == 0:
        return pictures[0], 0.0
    at = np.nansum(pictures[:, sectors], axis=0) / shows[sectors]
    return np.interp(np.arange(len(shows)), sectors, at, period=len(shows)), len(sectors) / len(shows)


def round_arm(profiles: Sequence[SleeveProfile]) -> float:
    """Share of the way round an arm beyond the widest gap in which no picture shows its cuff.

    A cuff beside an arm lies within half of the directions off its axis, however well it shows.

    Args:
        profiles: one of each picture, at least one.
    """
    shows = np.flatnonzero(~np.all(np.isnan([profile.cuff_at for profile in profiles]), axis=0))
    sectors = len(profiles[0].cuff_at)
    if len(shows) == 0:
        return 0.0
    gaps = np.diff(shows, append=shows[0] + sectors) - 1
    return 1.0 - float(gaps.max()) / sectors
