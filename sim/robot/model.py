"""What Baxter, as it stands here, is made of: names, sizes, mounting and limits (`baxter.py` puts them together).

Baxter's own links and joint limits come from `example-robot-data` when the URDF is composed
(`urdf.py`).  This file holds what that package does not know: the base, the grippers, the cameras
and how all of it is bolted together.  Lengths in [m], masses in [kg], angles in [rad].
"""

from __future__ import annotations

import numpy as np

from ..mechanics.gripper import GRIPPER
from ..world import SIDES, Side

ARM_JOINTS = ("s0", "s1", "e0", "e1", "w0", "w1", "w2")  # shoulder to wrist
BASE_JOINTS = ("base_x", "base_y", "base_yaw")
HEAD_JOINT = "head_pan"

# Clearpath Ridgeback: 960 x 793 x 311 mm, 135 kg (data sheet).  The box ends 3 cm above the floor, so that
# nothing of the robot ever touches it: the planar joints carry the weight.
BASE_SIZE = np.array((0.96, 0.79, 0.31))
BASE_CLEARANCE = 0.03
BASE_MASS = 135.0

# Baxter's torso frame in the base frame.  Its floor pedestal is replaced by a column on the Ridgeback's deck.
# The shoulder (axis s1) is 0.40 above the torso frame, hence 1.25 above the floor.
TORSO_IN_BASE = np.array((0.10, 0.0, 0.85))
COLUMN_SIZE = np.array((0.28, 0.34))

# Robotiq 2F-85, 0.9 kg in all; its sizes and limits are those of `gripper.py`.
GRIPPER_STROKE = GRIPPER.stroke
GRIPPER_FORCE = GRIPPER.force
GRIPPER_SPEED = GRIPPER.speed
FLANGE_IN_HAND_LINK = 0.025  # the flange's face, beyond Baxter's hand_link frame along z
FLANGE_TO_FINGERTIP = GRIPPER.flange_to_fingertip
PALM_SIZE = np.array((0.07, 0.10, 0.09))
PALM_MASS = 0.8
FINGER_SIZE = np.array((GRIPPER.pad_width, GRIPPER.finger_thickness, GRIPPER.finger_length))
FINGER_MASS = 0.05

# Cameras, optical frames (x right, y down, z forward).
HEAD_CAMERA_IN_HEAD = np.array((0.17, 0.0, 0.12))  # on top of the screen
# Below the horizon.  1.66 above the floor and with a vertical field of view of 54 degrees it sees, 0.35 m ahead of
# itself, from 0.6 m up to 1.55 m: the bed from 0.65 m before the base's centre on, and a gown on a rail in whole.
HEAD_CAMERA_PITCH = np.deg2rad(45.0)
HAND_CAMERA_IN_HAND_LINK = np.array((0.08, 0.0, 0.10))  # beside the palm, across the closing direction
HAND_CAMERA_TILT = np.deg2rad(35.0)  # towards the point 3 cm beyond the fingertips

# Limits of motion.  Joint positions and velocities are the URDF's.  Accelerations: Rethink's own MoveIt
# configuration (baxter_simulator, baxter_moveit_config/config/joint_limits.yaml) plans with 1.0 rad/s^2 on every
# joint; the motors stand more, and a test checks these values against the rated torque with inverse dynamics.
ARM_ACCELERATION = np.array((1.5, 1.5, 2.0, 2.0, 4.0, 4.0, 4.0))  # [rad/s^2]
HEAD_VELOCITY = 1.0  # [rad/s]; the URDF's 10000 is a placeholder
HEAD_ACCELERATION = 2.0  # [rad/s^2]
# Ridgeback: 1.1 m/s at most (data sheet); half of that indoors beside a bed.
BASE_VELOCITY = np.array((0.5, 0.6))  # [m/s, rad/s]
BASE_ACCELERATION = np.array((0.8, 1.2))  # [m/s^2, rad/s^2]
HAND_VELOCITY = np.array((0.5, 1.5))  # of a HandTwist [m/s, rad/s]
HAND_ACCELERATION = np.array((1.0, 4.0))  # of a HandTwist [m/s^2, rad/s^2]

# A posture with both hands in front of the chest, palms forward and elbows out, mirrored: the centre of the null space.
READY = np.array(((0.68, -0.88, -1.295, 1.77, 0.42, 1.16, -0.25), (-0.68, -0.88, 1.295, 1.77, -0.42, 1.16, 0.25)))


def arm_joints(side: Side) -> tuple[str, ...]:
    """URDF names of the seven joints of one arm, shoulder to wrist."""
    return tuple(f"{side}_{name}" for name in ARM_JOINTS)


def finger_joints(side: Side) -> tuple[str, str]:
    """URDF names of the two prismatic finger joints of one hand."""
    return f"{side}_finger_a", f"{side}_finger_b"


ALL_ARM_JOINTS: tuple[str, ...] = tuple(name for side in SIDES for name in arm_joints(side))
ALL_FINGER_JOINTS: tuple[str, ...] = tuple(name for side in SIDES for name in finger_joints(side))
COMMANDED_JOINTS: tuple[str, ...] = (*ALL_ARM_JOINTS, HEAD_JOINT)  # what a JointTrajectory may name
