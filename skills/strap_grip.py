"""How the strap of a sleeve lies in the fingers, and how the hand must be turned for the armhole to hang open."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..perception.cloud import unit
from ..perception.estimates import SleeveOpening
from ..sim.world import Side
from .arm_path import UP


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


def presenting(grip: StrapGrip, along_in_map: np.ndarray, position_in_map: np.ndarray) -> np.ndarray:
    """Hand pose (4, 4) that holds the strap across an arm: from above, the armhole's side towards the fingertips.

    Args:
        grip: how the strap lies in the fingers.
        along_in_map: (3,) direction of the arm towards the fingertips; only its heading counts.
        position_in_map: (3,) of the hand [m].
    """
    heading = unit(np.asarray(along_in_map, float) * (1.0, 1.0, 0.0))
    # the hand points down: its z is -UP; x and y turn about it so that the strap's `across` points to the shoulder
    y = np.cross(-UP, -heading)  # where the hand's y would be if `across` were the hand's x
    turn = np.arctan2(grip.across_in_hand[1], grip.across_in_hand[0])
    pose = np.eye(4)
    x_hand = np.cos(turn) * -heading - np.sin(turn) * y
    y_hand = np.sin(turn) * -heading + np.cos(turn) * y
    pose[:3, :3] = np.column_stack((x_hand, y_hand, -UP))
    pose[:3, 3] = position_in_map
    return pose
