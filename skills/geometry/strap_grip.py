"""How the strap of a sleeve lies in the fingers, and how the hand must be turned for the armhole to hang open."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...perception.estimates import SleeveOpening
from ...perception.image.cloud import unit
from ...sim.quantity import Quantities, quantity
from ...sim.world import Side
from .arm_path import UP


@dataclass(frozen=True, kw_only=True)
class StrapGripTuning(Quantities):
    """How a strap is presented."""

    lean: float = quantity(
        0.25,
        "rad",
        "of the hand off the vertical, away from the person",
        "choice: the outside of the strap then faces the fingertips' side, so that the sleeve falls outwards",
    )


STRAP_GRIP = StrapGripTuning()


@dataclass(frozen=True, kw_only=True)
class StrapGrip:
    """A strap held by a hand.

    Attributes:
        arm: the wearer's side the sleeve belongs to.
        hand: that holds it.
        across_in_hand: (3,) unit vector across the strap, from the armhole to the gown's upper edge, in the hand.
    """

    arm: Side
    hand: Side
    across_in_hand: np.ndarray


def strap_grip(arm: Side, hand: Side, strap: SleeveOpening, pose_hand_in_map: np.ndarray) -> StrapGrip:
    """What a hand holds that closed at `pose_hand_in_map` (4, 4) on a strap."""
    across = pose_hand_in_map[:3, :3].T @ strap.closing_in_map
    return StrapGrip(arm=arm, hand=hand, across_in_hand=unit(across * (1.0, 1.0, 0.0)))


def presenting(
    grip: StrapGrip, along_in_map: np.ndarray, position_in_map: np.ndarray, lean: float = STRAP_GRIP.lean
) -> np.ndarray:
    """Hand pose (4, 4) that holds the strap across an arm, its armhole towards the fingertips.

    Args:
        grip: how the strap lies in the fingers.
        along_in_map: (3,) direction of the arm towards the fingertips; only its heading counts.
        position_in_map: (3,) of the hand [m].
        lean: of the hand off the vertical, away from the person [rad]: the outside of the strap then faces the
            fingertips' side, so that the sleeve falls outwards, ahead of the hand that comes through it.
    """
    heading = unit(np.asarray(along_in_map, float) * (1.0, 1.0, 0.0))
    approach = -math.cos(lean) * UP - math.sin(lean) * heading
    across = -math.cos(lean) * heading + math.sin(lean) * UP
    # x and y of the hand turn about its approach so that the strap's `across_in_hand` comes to lie along `across`
    beside = np.cross(approach, across)
    turn = math.atan2(grip.across_in_hand[1], grip.across_in_hand[0])
    pose = np.eye(4)
    pose[:3, 0] = math.cos(turn) * across - math.sin(turn) * beside
    pose[:3, 1] = math.sin(turn) * across + math.cos(turn) * beside
    pose[:3, 2] = approach
    pose[:3, 3] = position_in_map
    return pose
