"""Where a hand has to be for its own camera to look at a place."""

from __future__ import annotations

import numpy as np

from ...perception.image.cloud import unit
from ...sim.mechanics.kinematics import kinematics_of
from ...sim.mechanics.robot_model import RobotModel
from ...sim.world import SIDES, Side
from ..geometry.arm_path import UP


def camera_in_hand(robot: RobotModel, hand: Side) -> np.ndarray:
    """Pose (4, 4) of a hand's camera in the hand's frame."""
    kinematics, n, base = kinematics_of(robot), SIDES.index(hand), np.zeros(3)
    camera = kinematics.pose_camera_in_map(f"{hand}_hand", base, robot.ready, 0.0)
    return np.linalg.inv(kinematics.pose_hand_in_map(hand, robot.ready[n], base)) @ camera


def view_of(robot: RobotModel, hand: Side, target: np.ndarray, eye: np.ndarray) -> np.ndarray:
    """Hand pose (4, 4) in the map whose camera, upright, is at `eye` and has a place in the middle of its picture.

    Args:
        robot: that looks.
        hand: of the robot that looks.
        target: (3,) the place, in the map, not right below the camera [m].
        eye: (3,) the camera, in the map [m].
    """
    forward = unit(target - eye)
    right = unit(np.cross(forward, UP))
    camera = np.eye(4)
    camera[:3, :3] = np.column_stack((right, np.cross(forward, right), forward))
    camera[:3, 3] = eye
    return camera @ np.linalg.inv(camera_in_hand(robot, hand))


def level_view(robot: RobotModel, hand: Side, target: np.ndarray, heading: np.ndarray, distance: float) -> np.ndarray:
    """Hand pose (4, 4) in the map whose camera, upright and level, has a place in the middle of its picture.

    Args:
        robot: that looks.
        hand: of the robot that looks.
        target: (3,) the place, in the map [m].
        heading: (3,) level unit vector along the view, in the map.
        distance: from the camera to the place [m].
    """
    return view_of(robot, hand, target, target - distance * heading)
