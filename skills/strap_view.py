"""Where a sleeve is seen from afar, and from where the hand's camera then looks at its strap."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..perception.errors import PerceptionFailure
from ..perception.estimates import SleeveOpening
from ..sim.robot import model
from ..sim.robot.kinematics import default_kinematics
from ..sim.world import SIDES, Side
from .arm_path import UP
from .bedside import outwards
from .motion.ik import hand_pose
from .skill import Skill

DISTANCE = 0.29  # from the hand's camera to the strap it looks at [m]
TO_STRAP = np.array((0.0, -0.05, 0.0))  # from an armhole to its strap, in a gown laid with its collar headward [m]
# The hand points that far below the horizontal when it looks, its camera 35 degrees less: at a sleeve that lies on
# the bed, and at one that hangs over its edge.
_LYING, _HANGING = np.deg2rad((97.0, 80.0, 65.0)), np.deg2rad((52.0, 68.0, 40.0))
_HANGS = 0.03  # a sleeve this far below the mattress hangs over the edge [m]


def find_sleeve(skill: Skill, side: Side, arm_in_map: np.ndarray) -> SleeveOpening:
    """The sleeve from afar: below the hand, where it was laid, or by the elbow, where it may be after a miss.

    Args:
        skill: that asks.
        side: of the person.
        arm_in_map: (4, 3) shoulder, elbow, wrist, fingertip [m].

    Raises:
        PerceptionFailure: it is at neither place.
        SensorLost: the camera is dead.
        SkillFailure: its picture is stale.
    """
    frame, lost = skill.world.look("head"), None
    for near in (arm_in_map[3] * (1.0, 1.0, 0.0) + skill.world.room.bed[1, 2] * UP, arm_in_map[1]):
        try:
            seen = skill.context.perceive("sleeve_opening", frame, side=side, near_in_map=near)
        except PerceptionFailure as stop:
            lost = lost or stop
            continue
        assert isinstance(seen, SleeveOpening)
        return seen
    assert lost is not None
    raise lost


def strap_views(far: SleeveOpening, side: Side, hand: Side, bed: np.ndarray) -> Iterator[np.ndarray]:
    """Hand poses (4, 4) from the robot's side whose camera has the strap in the middle, the best one first.

    Args:
        far: the sleeve as the head's camera sees it.
        side: of the person that the sleeve belongs to.
        hand: of the robot that looks.
        bed: (2, 3) lower and upper corner [m].
    """
    hangs = far.position_in_map[2] < bed[1, 2] - _HANGS
    camera = _camera_in_hand(hand)
    for tilt in _HANGING if hangs else _LYING:
        pose = hand_pose(np.zeros(3), -np.cos(tilt) * outwards(side) - np.sin(tilt) * UP, TO_STRAP)
        if (pose[:3, :3] @ camera[:3, 2]) @ outwards(side) > pose[:3, 2] @ outwards(side):
            pose = pose @ np.diag((-1.0, -1.0, 1.0, 1.0))  # the camera's side of the hand towards the robot
        pose[:3, 3] = far.position_in_map + TO_STRAP - pose[:3, :3] @ (camera[:3, 3] + DISTANCE * camera[:3, 2])
        yield pose


def _camera_in_hand(hand: Side) -> np.ndarray:
    """Pose (4, 4) of a hand's camera in the hand's frame."""
    kinematics, n, base = default_kinematics(), SIDES.index(hand), np.zeros(3)
    camera = kinematics.pose_camera_in_map(f"{hand}_hand", base, model.READY, 0.0)
    return np.linalg.inv(kinematics.pose_hand_in_map(hand, model.READY[n], base)) @ camera
