"""Draw a gown of which more hangs over one edge of the bed to the other side, as both hands feel it."""

from __future__ import annotations

from collections.abc import Generator, Iterator
from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import SIDES
from ..core.skill import Skill
from ..motion.errors import MotionError
from .hands import cloth_load
from .held_neckline import HeldNeckline


@dataclass(frozen=True, kw_only=True)
class EvenOutTuning(Quantities):
    """How a gown is weighed across the bed, and how far it is drawn."""

    sway: float = quantity(
        0.06,
        "m",
        "of the hands across the bed and back, to either side, by which the gown is weighed",
        "choice: more than friction holds; from what it pulls after either, friction cancels",
    )
    rest: float = quantity(0.5, "s", "before the pull is read", "choice: the cloth stops swinging")
    samples: int = quantity(6, "1", "readings of the force sensors whose mean counts", "choice: a third of a second")
    uneven_load: float = quantity(
        0.15,
        "N",
        "of the gown across the bed, from which one side would draw all of it over the edge",
        "measured: 0.31 to 0.62 N in four gowns that slid by 0.15 to 0.25 m as they were let go of (126, 135, 174, "
        "188); 0.00 to 0.33 N in six that stayed, 0.09 N in one that slid by 0.1 m (121 to 145)",
    )
    shift: float = quantity(
        0.15,
        "m/N",
        "by which the hands go to the other side for it",
        "measured: let go of in the air, the gown went half of 0.3 m/N back; all four then stayed within 0.10 m of the "
        "middle",
    )
    max_shift: float = quantity(
        0.06, "m", "by which they do so at most", "measured: by 0.12 m, of a gown that stayed there, too far (154, 156)"
    )


def even_out(neckline: HeldNeckline, y: float, z: float, tuning: EvenOutTuning) -> Iterator[None]:
    """Sway the gown to and fro; where it pulls to one side, draw it to the other one.

    Let go of, what hung over one edge drew all of it along, by 0.15 to 0.25 m within two seconds, and the first sleeve
    was out of reach of its hand from then on (126, 135, 174, 188).  No camera sees the edges below the robot's arms;
    the hands feel it, once friction is left out, which pulls back from either way.

    Args:
        neckline: in both hands.
        y: where it is along the bed in the map [m].
        z: its height [m].
        tuning: how it is weighed and drawn.
    """
    middle, pulls = neckline.middle, []
    try:
        for sway in (tuning.sway, -tuning.sway):
            for neckline.middle in (middle + sway, middle):
                yield from neckline.to(y, z)
            pulls.append((yield from _pull(neckline.skill, tuning)))
        if abs(pull := float(np.mean(pulls))) > tuning.uneven_load:
            neckline.skill.note(
                f"{abs(pull):.1f} N more of the gown hang over the {'near' if pull > 0 else 'far'} edge"
            )
            neckline.middle = middle + float(np.clip(-tuning.shift * pull, -tuning.max_shift, tuning.max_shift))
            yield from neckline.to(y, z)
    except MotionError:
        return  # it stays where it is


def _pull(skill: Skill, tuning: EvenOutTuning) -> Generator[None, None, float]:
    """How hard the gown pulls both hands together towards the near side [N]."""
    yield from skill.wait(tuning.rest)
    readings = []
    for _ in range(tuning.samples):
        readings.append(sum(float(cloth_load(skill, side)[0]) for side in SIDES))
        yield
    return float(np.mean(readings))
