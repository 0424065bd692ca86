"""The body of a person who lies on the bed, judged by the head: middle, size, shoulders, flanks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sim.world import Frame, Side
from ..estimates import Head
from .head import DEFAULT as HEAD_DEFAULT
from .head import HeadTuning, head_seen
from .person_facts import PERSON
from .skin import DEFAULT as SKIN_DEFAULT
from .skin import SkinTuning


def side_sign(side: Side) -> float:
    """1 for the person's right, which lies at larger x, else -1."""
    return 1.0 if side == "right" else -1.0


@dataclass(frozen=True, kw_only=True)
class Trunk:
    """The half of the trunk that no part of the arm can be in, a box open downwards.

    Attributes:
        middle: x of the body's midline [m].
        sign: 1 for the arm on the side of larger x, -1 for the other.
        half_width: of the trunk [m].
        top: z up to which it reaches [m].
        low, high: where it begins and ends along y [m].
    """

    middle: float
    sign: float
    half_width: float
    top: float
    low: float
    high: float

    def depth_inside(self, points: np.ndarray) -> np.ndarray:
        """How far (n,) points (n, 3) lie inside its flank, 0 outside [m]."""
        inside = (points[:, 2] < self.top) & (points[:, 1] > self.low) & (points[:, 1] < self.high)
        return np.where(inside, np.maximum(self.half_width - self.sign * (points[:, 0] - self.middle), 0.0), 0.0)


@dataclass(frozen=True, kw_only=True)
class LyingBody:
    """A body on the bed.

    Attributes:
        mattress: z of the bed's upper side [m].
        middle: x of the body's midline [m].
        shoulder_y: y of the shoulders; the head lies towards -y [m].
        scale: size relative to an adult of 174 cm.
    """

    mattress: float
    middle: float
    shoulder_y: float
    scale: float

    def shoulder_in_map(self, side: Side) -> np.ndarray:
        """Where a shoulder joint (3,) lies [m]."""
        return np.array(
            (
                self.middle + side_sign(side) * PERSON.shoulder_half_width * self.scale,
                self.shoulder_y,
                self.mattress + PERSON.shoulder_height,
            )
        )

    def trunk(self, side: Side, share: float) -> Trunk:
        """The half of the trunk on one side, `share` of its width wide."""
        low, high = PERSON.trunk_range
        return Trunk(
            middle=self.middle,
            sign=side_sign(side),
            half_width=share * PERSON.trunk_half_width * self.scale,
            top=self.mattress + PERSON.flank_height,
            low=self.shoulder_y + low,
            high=self.shoulder_y + high,
        )


def body_seen(
    frame: Frame,
    bed: np.ndarray,
    scale: float | None = None,
    head_tuning: HeadTuning = HEAD_DEFAULT,
    skin_tuning: SkinTuning = SKIN_DEFAULT,
) -> LyingBody:
    """Find the body by its head.

    Args:
        frame: a view of the person.
        bed: (2, 3) lower and upper corner of the bed in the map [m].
        scale: body size relative to an adult of 174 cm; judged by the size of the head when omitted.
        head_tuning: numbers of the search for the head.
        skin_tuning: numbers of what counts as skin.

    Raises:
        PerceptionFailure: no head is seen.
    """
    return body_of(head_seen(frame, bed, head_tuning, skin_tuning), float(bed[1, 2]), scale)


def body_of(head: Head, mattress: float, scale: float | None = None) -> LyingBody:
    """The body that belongs to a head.

    Args:
        head: as it was seen.
        mattress: z of the bed's upper side [m].
        scale: body size relative to an adult of 174 cm; judged by how high the head rises when omitted.
    """
    if scale is None:
        scale = float(np.clip((head.crown_in_map[2] - mattress) / PERSON.head_height, *PERSON.scale_range))
    return LyingBody(
        mattress=mattress,
        middle=head.middle,
        shoulder_y=float(head.crown_in_map[1]) + PERSON.crown_to_shoulder * scale,
        scale=scale,
    )
