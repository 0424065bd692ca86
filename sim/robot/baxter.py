"""Baxter with two Robotiq 2F-85 grippers on a Ridgeback, put together from what `model.py` knows."""

from __future__ import annotations

import numpy as np

from ..mechanics.robot_model import MotionLimits, RobotModel
from ..world import CAMERAS, SIDES
from . import model
from .link_capsules import link_capsules
from .shapes import LIMBS, collision_shapes, own_pairs
from .urdf import compose

MIRROR = np.array((-1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0))  # left and right arm are mirror images
# Fingertips 0.70 m ahead, 0.15 m aside, 1.33 m above the floor, pointing down: a choice, tried every 15 degrees of a
# turn with the collision shapes, so that the camera sees what hangs from the fingers under the arm.
RIGHT_HELD_UP = np.array((0.284, -1.137, 1.275, 0.913, -0.47, 2.046, 0.517))

BAXTER = RobotModel(
    name="baxter",
    urdf=compose,
    arm_joints=model.ARM_JOINTS,
    ready=model.READY,
    held_up=np.array((MIRROR * RIGHT_HELD_UP, RIGHT_HELD_UP)),
    hands={side: f"{side}_hand" for side in SIDES},
    fingers={side: model.finger_joints(side) for side in SIDES},
    gripper=model.GRIPPER,
    base_joints=model.BASE_JOINTS,
    head_joint=model.HEAD_JOINT,
    neck_in_base=model.TORSO_IN_BASE,
    cameras={camera: f"{camera}_camera" for camera in CAMERAS},
    limits=MotionLimits(
        arm_acceleration=model.ARM_ACCELERATION,
        motion_torque=np.array((6.0, 6.0, 6.0, 6.0, 3.0, 3.0, 3.0)),
        head_velocity=model.HEAD_VELOCITY,
        head_acceleration=model.HEAD_ACCELERATION,
        base_velocity=model.BASE_VELOCITY,
        base_acceleration=model.BASE_ACCELERATION,
        hand_velocity=model.HAND_VELOCITY,
        hand_acceleration=model.HAND_ACCELERATION,
        sources={
            "arm_acceleration": "baxter_moveit_config plans with 1.0 rad/s^2; a test holds these against rated torque",
            "motion_torque": "choice: what these accelerations take in the median posture, and some more",
            "head_velocity": "choice: the URDF's 10000 rad/s is a placeholder",
            "head_acceleration": "choice: it starts and stops gently",
            "base_velocity": "datasheet: Ridgeback, 1.1 m/s at most; half of that indoors beside a bed",
            "base_acceleration": "choice: it starts and stops gently",
            "hand_velocity": "choice: near the person the guard slows it",
            "hand_acceleration": "choice: it starts and stops gently",
        },
    ),
    shapes=collision_shapes(),
    limbs=LIMBS,
    own_pairs=own_pairs(),
    capsules=link_capsules(),
)
