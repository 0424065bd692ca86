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
    sector, at = _round_arm(armhole, arm_in_map, tuning)
    counts = np.bincount(sector, minlength=tuning.sectors)
    sums = np.bincount(sector, at, minlength=tuning.sectors)
    shows = counts >= tuning.min_sector_points
    if np.count_nonzero(shows) < tuning.min_sectors:
        raise PerceptionFailure(Problem.NOTHING_SEEN, f"armhole round the {side} arm")
    cuff_counts = np.bincount(_round_arm(cuff, arm_in_map, tuning)[0], minlength=tuning.sectors)
    return SleeveProfile(
        stamp=frame.stamp,
        confidence=min(1.0, np.count_nonzero(shows) / tuning.full_sectors),
        side=side,
        armhole_at=np.where(shows, sums / np.maximum(counts, 1), np.nan),
        cuff_shows=cuff_counts >= tuning.min_sector_points,
    )


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
    return float(np.clip(base + rim_features(profiles) @ np.array(changes), 0.0, 1.0))


def rim_features(profiles: Sequence[SleeveProfile]) -> np.ndarray:
    """(2,) one minus the mean of an armhole's rim over all directions round its arm, and the share of them that shows.

    Args:
        profiles: one of each picture, at least one.
    """
    pictures = np.array([profile.armhole_at for profile in profiles])
    shows = np.count_nonzero(~np.isnan(pictures), axis=0)
    sectors = np.flatnonzero(shows)
    at = np.nansum(pictures[:, sectors], axis=0) / shows[sectors]
    rim = np.interp(np.arange(len(shows)), sectors, at, period=len(shows))
    return np.array((1.0 - rim.mean(), len(sectors) / len(shows)))


def round_arm(profiles: Sequence[SleeveProfile]) -> float:
    """Share of the way round an arm beyond the widest gap in which no picture shows its cuff.

    A cuff beside an arm lies within half of the directions off its axis, however well it shows.

    Args:
        profiles: one of each picture, at least one.
    """
    shows = np.flatnonzero(np.any([profile.cuff_shows for profile in profiles], axis=0))
    sectors = len(profiles[0].cuff_shows)
    if len(shows) == 0:
        return 0.0
    gaps = np.diff(shows, append=shows[0] + sectors) - 1
    return 1.0 - float(gaps.max()) / sectors
