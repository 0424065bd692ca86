"""See that a gown was taken askew, and lay it even."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from ...perception.errors import PerceptionFailure
from ...sim.quantity import Quantities, quantity
from ...sim.world import SIDES, SensorLost
from ..motion.errors import MotionError
from .hands import cloth_load, hand_now
from .head import look_towards
from .held_neckline import NEAR_HAND, NEAR_SLEEVE, HeldNeckline


@dataclass(frozen=True, kw_only=True)
class DrawAcrossTuning(Quantities):
    """When a gown lies askew, and how far it is drawn."""

    overhang: float = quantity(
        0.04,
        "m",
        "by which the armholes' outer edges are farther apart than the hands",
        "measured: median of nine gowns, from -0.03 to 0.11",
    )
    hidden_offset: float = quantity(
        0.02,
        "m",
        "from the middle of what shows of the near armhole outwards to its whole",
        "choice: how it was found is not recorded; the rest of the near armhole is hidden",
    )
    min_askew: float = quantity(
        0.03,
        "m",
        "by which the far side is longer before the gown is drawn across",
        "choice: less is within the error of what is seen",
    )
    max_shift: float = quantity(0.12, "m", "of the hands towards the near side", "choice: within the arms' reach")
    slack_load: float = quantity(
        0.5, "N", "pull of the neckline on a hand below which it is slack", "choice: above the noise"
    )
    narrowing: float = quantity(
        0.03,
        "m",
        "by which the hands come together at once to slacken the neckline",
        "choice: small, so that it hangs through no more than needed",
    )
    max_narrowings: int = quantity(
        5, "1", "times that they do so", "choice: a gown that still pulls then is let go of as it is"
    )


def draw_across(neckline: HeldNeckline, y: float, z: float, tuning: DrawAcrossTuning) -> Iterator[None]:
    """Look at the near armhole; where the far side is longer, draw the neckline across and slacken it.

    The far side would fall over the edge of the bed, draw the gown after it, and catch on the person's hand there.
    Laid down before it is let go of, the gown stays where the hands bring it: drawn by twice of what it was askew, its
    far armhole came to 0.20 and 0.30 m from the midline, and the near one over the edge (138, 191).
    The far armhole hides behind the hand that holds it, so what is askew is told by the near one alone.

    Args:
        neckline: in both hands.
        y: where it is along the bed in the map [m].
        z: its height [m].
        tuning: when, and how far.
    """
    skill = neckline.skill
    near = hand_now(skill, NEAR_HAND)[:3, 3]
    yield from look_towards(skill, near)
    try:
        seen = skill.context.senses.sleeve_opening(skill.world.look("head"), side=NEAR_SLEEVE, near_in_map=near)
    except (PerceptionFailure, SensorLost):
        return  # it stays as it was taken
    shown = float(np.median(seen.armhole_points_in_map[:, 0]))
    askew = shown + tuning.hidden_offset - neckline.middle - (neckline.apart + tuning.overhang) / 2
    if askew < -tuning.min_askew:
        neckline.middle += min(-askew, tuning.max_shift)
        with suppress(MotionError):  # then it stays where it is
            yield from neckline.to(y, z)
            yield from _slacken(neckline, y, z, tuning)


def _slacken(neckline: HeldNeckline, y: float, z: float, tuning: DrawAcrossTuning) -> Iterator[None]:
    """Bring the hands together until the neckline between them is slack.

    A stretched neckline that is let go of at one end draws the gown to the other side again.  Only a gown that was
    askew is slackened: sleeves that do not hang over the edges of the bed may fold inwards.
    """
    for _ in range(tuning.max_narrowings):
        near, far = (float(cloth_load(neckline.skill, side)[0]) for side in SIDES)
        if (far - near) / 2 < tuning.slack_load:
            return
        neckline.apart -= tuning.narrowing
        yield from neckline.to(y, z)
