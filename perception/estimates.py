"""What perception says: frozen values with a stamp and a confidence, whoever estimated them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from ..sim.world import Side

GraspTarget = Literal[
    "near_hang",
    "collar_corner_left",
    "collar_corner_right",
    "sleeve_left",
    "sleeve_right",
    "collar_middle",
]
SLEEVE_OF: dict[Side, GraspTarget] = {"left": "sleeve_left", "right": "sleeve_right"}
CORNER_OF: dict[Side, GraspTarget] = {"left": "collar_corner_left", "right": "collar_corner_right"}


@dataclass(frozen=True, kw_only=True)
class Estimate:
    """Base of all estimates.

    Attributes:
        stamp: world clock of the image it came from [s].
        confidence: 0 (a guess) to 1 (certain).
    """

    stamp: float
    confidence: float


@dataclass(frozen=True, kw_only=True)
class GraspPoint(Estimate):
    """Where to close the fingers.

    Attributes:
        target: which part of the gown it is.
        position_in_map: (3,) [m].
        approach_in_map: (3,) unit vector from the hand to the cloth.
        closing_in_map: (3,) unit vector along which the fingers close (across the cloth's edge or fold).
    """

    target: GraspTarget
    position_in_map: np.ndarray
    approach_in_map: np.ndarray
    closing_in_map: np.ndarray


@dataclass(frozen=True, kw_only=True)
class GownSide(Estimate):
    """Which side of the gown the camera sees: the printed outside or the plain inside."""

    outside: bool


@dataclass(frozen=True, kw_only=True)
class ArmPosture(Estimate):
    """One arm of the person as a chain of four points in the map frame, (4, 3) [m].

    Attributes:
        side: the person's own left or right.
        points_in_map: shoulder, elbow, wrist, fingertip.
        deviation: (4,) standard deviation of each point [m].
    """

    side: Side
    points_in_map: np.ndarray
    deviation: np.ndarray


@dataclass(frozen=True, kw_only=True)
class LayerCount(Estimate):
    """How many layers of cloth are between the fingers of one hand (0: missed)."""

    side: Side
    layers: int


@dataclass(frozen=True, kw_only=True)
class SleeveOpening(GraspPoint):
    """A grasp on the rim of an armhole, with what is seen of the rim.

    Attributes:
        armhole_points_in_map: (n, 3) of the armhole's binding [m].
        centre_in_map: (3,) of the opening [m].
    """

    armhole_points_in_map: np.ndarray
    centre_in_map: np.ndarray


@dataclass(frozen=True, kw_only=True)
class SleeveHeading(Estimate):
    """Which way a held sleeve points.

    Attributes:
        side: the wearer's sleeve.
        cuff_from_armhole_in_map: (3,) from the middle of what shows of the armhole's binding to that of the cuff's [m].
    """

    side: Side
    cuff_from_armhole_in_map: np.ndarray


@dataclass(frozen=True, kw_only=True)
class WornSleeve(Estimate):
    """Where a sleeve shows along an upper arm.

    Attributes:
        side: of the person.
        armhole_at: middle of what shows of the armhole's binding, 0 shoulder, 1 elbow.
        cuff_at: the same of the cuff's.
        reach: how far up the upper arm the whole armhole is taken to be, 0 elbow to 1 shoulder: its hidden side too.
        round_arm: share of the directions off the arm's axis in which the cuff shows.
        inside_out: share of the fabric between both bindings that shows the gown's inside; 0 where too little shows.
    """

    side: Side
    armhole_at: float
    cuff_at: float
    reach: float
    round_arm: float
    inside_out: float = 0.0


@dataclass(frozen=True, kw_only=True)
class SleeveProfile(Estimate):
    """Where the bindings of a worn sleeve show round its arm, in one picture.

    Sectors are equal ones round the upper arm's axis, which begin at the top and go round outwards.

    Attributes:
        side: of the person.
        armhole_at: (n,) share of the upper arm, 0 shoulder, 1 elbow, in each sector; NaN where it does not show.
        cuff_at: (n,) likewise of the cuff.
    """

    side: Side
    armhole_at: np.ndarray
    cuff_at: np.ndarray


Primitive = Literal["move_left", "direct", "move_right"]


@dataclass(frozen=True, kw_only=True)
class PreGrasp(Estimate):
    """A pre-grasp manipulation: where to go in with open fingers, and how to isolate the cloth before closing.

    Attributes:
        primitive: sweep 5 cm to the left of the view, or to the right, or grasp at once.
        view: index of the frame it was chosen from.
        position_in_map: (3,) middle of the open fingertips at the start [m].
        approach_in_map: (3,) unit vector, horizontal.
        sweep_in_map: (3,) displacement of the sweep, zero for `direct` [m].
        corner_in_map: (3,) the collar corner as it was seen [m].
    """

    primitive: Primitive
    view: int
    position_in_map: np.ndarray
    approach_in_map: np.ndarray
    sweep_in_map: np.ndarray
    corner_in_map: np.ndarray


@dataclass(frozen=True, kw_only=True)
class Head(Estimate):
    """The person's head.

    Attributes:
        crown_in_map: (3,) far end of the head, away from the feet [m].
        middle: x of the body's midline at the head [m].
    """

    crown_in_map: np.ndarray
    middle: float


@dataclass(frozen=True, kw_only=True)
class ChestFront(Estimate):
    """How high the front of the chest lies above the mattress; what covers it counts as part of it.

    Attributes:
        height: of its highest part [m].
        breastbone: on the midline [m].
    """

    height: float
    breastbone: float


@dataclass(frozen=True, kw_only=True)
class Shift(Estimate):
    """How much of what was seen of an arm is elsewhere now.  share: 0 to 1 of its skin in free view."""

    share: float


@dataclass(frozen=True, kw_only=True)
class Cover(Estimate):
    """How much of the trunk's front, or of a hand, lies under the gown.  share: 0 to 1."""

    share: float


@dataclass(frozen=True, kw_only=True)
class ChestCover(Cover):
    """How much of the trunk's front lies under the gown.

    Attributes:
        outside: share of what is covered on which the gown's outside is out, 0 to 1.
    """

    outside: float
