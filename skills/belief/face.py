"""Whether cloth lies over the person's face, as far as the head's camera sees it from the head of the bed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...perception.estimates import Cover
from ...sim.quantity import Quantities, quantity
from ..core.skill import Skill
from ..geometry.stances import HEADWARD


@dataclass(frozen=True, kw_only=True)
class FaceTuning(Quantities):
    """Where the face is, and what of it is looked at."""

    mouth_and_nose: tuple[float, float] = quantity(
        (0.13, 0.19),
        "m",
        "headward of the line of the shoulders",
        "paper: Winter, fig. 4.1: the crown is 0.31 m from the shoulders, a head 0.23 m long; the nose ends 0.14 to "
        "0.16 m from the crown, the mouth 0.02 m farther",
    )
    chin: tuple[float, float] = quantity(
        (0.13, 0.145), "m", "likewise", "choice: 0.02 m before the mouth, which cloth passes in a quarter of a second"
    )
    height: float = quantity(0.19, "m", "of the face above the mattress", "choice: as high as a lying head is seen")
    half_width: float = quantity(0.02, "m", "of what is looked at, from the midline", "choice: a mouth's")
    points: int = quantity(5, "1", "looked at along and across", "choice: a few pixels apart")


FACE = FaceTuning()


def face_points(
    skill: Skill, middle: np.ndarray, headward: tuple[float, float], tuning: FaceTuning = FACE
) -> np.ndarray:
    """(n, 3) places on the face, in the map [m].

    Args:
        skill: that looks.
        middle: (3,) between the shoulders [m].
        headward: of there, from and to [m].
        tuning: where the face is.
    """
    along = np.linspace(*headward, tuning.points)
    across = np.linspace(-tuning.half_width, tuning.half_width, tuning.points)
    ahead, aside = (values.ravel() for values in np.meshgrid(along, across))
    face = middle + ahead[:, None] * HEADWARD + aside[:, None] * (1.0, 0.0, 0.0)
    face[:, 2] = skill.world.room.bed[1, 2] + tuning.height
    return face


def cover_of(skill: Skill, face: np.ndarray) -> Cover:
    """How much of the face's places (n, 3) [m] shows something else than skin.

    Raises:
        PerceptionFailure: too few of them are in the picture.
        SensorLost: the camera is dead.
    """
    return skill.context.senses.skin_cover(skill.world.look("head"), points_in_map=face)
