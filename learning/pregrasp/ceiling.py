"""What an oracle reaches: with the direct grasp alone, with all primitives, at one pixel and at several."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sim.errors import CaretreeError
from ...sim.pregrasp.numbers import DIRECT
from .dataset import Dataset
from .rate import rate_text, signs


@dataclass(frozen=True, kw_only=True)
class Ceiling:
    """For each state, whether any action of a kind succeeds.

    Attributes:
        direct: (S,) direct grasps at the corner's pixel, six views.
        primitives: (S,) all primitives at that pixel.
        direct_pixels: (S,) direct grasps at several pixels.
        all: (S,) all primitives at several pixels.
    """

    direct: np.ndarray
    primitives: np.ndarray
    direct_pixels: np.ndarray
    all: np.ndarray

    @property
    def hard(self) -> np.ndarray:
        """(S,) states in which no direct grasp at the corner's pixel succeeds."""
        return ~self.direct


def ceiling(data: Dataset) -> Ceiling:
    """The oracle's successes in the states of a dataset.

    Raises:
        CaretreeError: too little was tried to tell what is the most that can be reached.
    """
    if not data.tells_ceiling:
        raise CaretreeError(f"oracle {data.oracle} tells no ceiling; make the states with --oracle all or ceiling")
    count, tried = len(data.seeds), data.attempts

    def any_of(chosen: np.ndarray) -> np.ndarray:
        return np.bincount(tried[chosen & data.success, 0], minlength=count) > 0

    direct, middle = tried[:, 2] == DIRECT, tried[:, 1] == 0
    return Ceiling(
        direct=any_of(direct & middle),
        primitives=any_of(middle),
        direct_pixels=any_of(direct),
        all=any_of(np.ones(len(tried), bool)),
    )


def table(data: Dataset) -> str:
    """The ceiling as Markdown, each rate with its n and Wilson's 95 % interval."""
    found = ceiling(data)
    rows = [
        ("direct grasp, the corner's pixel, best of 6 views", found.direct),
        ("3 primitives, the corner's pixel, best of 18", found.primitives),
    ]
    pixels = int(data.attempts[:, 1].max()) + 1
    if pixels > 1:
        rows += [
            (f"direct grasp, best of {pixels} pixels and 6 views", found.direct_pixels),
            (f"3 primitives, best of {pixels} pixels, {18 * pixels} actions", found.all),
        ]
    lines = ["| oracle | all states | hard states |", "|---|---|---|"]
    for name, won in rows:
        lines.append(f"| {name} | {rate_text(won)} | {rate_text(won[found.hard])} |")
    lines += _single(data) if data.oracle == "all" else []
    sweeps, alone = signs(found.primitives, found.direct), signs(found.all, found.direct_pixels)
    lines += [
        "",
        f"Sweeps win {sweeps[0]} states that direct grasps lose at the corner's pixel (sign test p = {sweeps[2]:.2g})"
        + (f", and {alone[0]} at several pixels (p = {alone[2]:.2g})." if pixels > 1 else "."),
        f"{len(data.seeds)} states, seeds {data.seeds.min()} to {data.seeds.max()}, data {data.digest}.",
    ]
    return "\n".join(lines)


def _single(data: Dataset) -> list[str]:
    """What single attempts come to, as lines; where the oracle stopped at success, they are not as they come."""
    tried, success = data.attempts, data.success
    lines = ["", "| single attempt at the corner's pixel | success |", "|---|---|"]
    for k, name in enumerate(("move left", "direct", "move right")):
        lines.append(f"| {name} | {rate_text(success[(tried[:, 1] == 0) & (tried[:, 2] == k)])} |")
    taken, corner = tried[:, 6], tried[:, 7] == 1
    lines += ["", "| what a single attempt at the corner's pixel takes | direct | sweeps |", "|---|---|---|"]
    kinds = [(tried[:, 1] == 0) & ((tried[:, 2] == DIRECT) == direct) for direct in (True, False)]
    for name, what in (
        ("nothing", taken == 0),
        ("one layer elsewhere", (taken == 1) & ~corner),
        ("several layers with the corner", (taken > 1) & corner),
        ("several layers without it", (taken > 1) & ~corner),
    ):
        lines.append(f"| {name} | {' | '.join(rate_text(what[kind]) for kind in kinds)} |")
    return lines
