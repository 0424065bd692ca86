"""What a hand holds things with: a light body on six stiff motors that follows the hand.

Cloth anchored to kinematic bodies can explode (FACTS); a dynamic link behind three prismatic and three
revolute motors does not, and turns what it holds.  Its motors feel an arm that hangs on it; cloth loads are
read in the cloth itself (`Cloth.load`).
"""

from __future__ import annotations

import math
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from ..robot.hand_boxes import local_boxes
from .handle_turn import motor_targets
from .soft_world import GRAVITY
from .units import ROOM

MASS, LINK_MASS = 3.0, 1.0  # of the last link and of the five before it [kg]; lighter ones shake what they hold
_LINK = 5
_AXES = (
    ("prismatic", "1 0 0"),
    ("prismatic", "0 1 0"),
    ("prismatic", "0 0 1"),
    ("revolute", "0 0 1"),
    ("revolute", "0 1 0"),
    ("revolute", "1 0 0"),
)
_LIFTED = MASS + 3 * LINK_MASS  # what the z motor carries: its own link and the turning ones [kg]
_CARRIED = (
    MASS + 5 * LINK_MASS,
    MASS + 4 * LINK_MASS,
    MASS + 3 * LINK_MASS,
)  # what the motors along x, y and z move [kg]
_JOINTS = tuple(range(6))
FOLLOWS = 0.3  # share of the way that is left which a motor goes in one step
_POSITION_GAINS, _VELOCITY_GAINS = (FOLLOWS,) * 6, (1.0,) * 6  # stiff, and damped as PyBullet's motors are by default
_FORCES = (ROOM.force(300.0),) * 3 + (ROOM.force(20.0),) * 3  # of the motors, 300 N and 20 N m
_FORCE, _RATE = ROOM.force(1.0), ROOM.rate(1.0)
_UPRIGHT = 1e-6  # below this cosine of the pitch, roll and yaw cannot be told apart
_SMOOTHING = 0.05  # share of a new reading: about 40 ms at a 2 ms step


class Handle:
    """A body that goes where a hand goes and measures what pulls on it.

    Args:
        client: BulletClient of the room.
        pose_in_map: (4, 4) where to start.
        opening: of fingers that push cloth aside, boxes on the handle [m]; None for a handle that touches nothing.
            They keep the orientation that they have at the start.
    """

    def __init__(self, client: Any, pose_in_map: np.ndarray, opening: float | None = None) -> None:
        self.client = client
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "handle.urdf"
            path.write_text(_urdf("" if opening is None else _fingers(pose_in_map[:3, :3], opening)))
            self.body: int = client.loadURDF(str(path), useFixedBase=True)
        self.link = _LINK
        for link in range(-1, 6):
            client.changeDynamics(
                self.body,
                link,
                activationState=client.ACTIVATION_STATE_DISABLE_SLEEPING,
                linearDamping=0.0,
                angularDamping=0.0,
                jointDamping=0.0,
            )
        self._load, self._speed = [0.0] * 3, [0.0] * 3
        self._turn_at_reset = np.eye(3)
        self.reset(pose_in_map)

    def reset(self, pose_in_map: np.ndarray) -> None:
        """Jump to a pose and call its orientation zero; only while nothing is held."""
        self._followed, self._turn_at_reset = b"", pose_in_map[:3, :3].copy()
        self._target = np.concatenate([pose_in_map[:3, 3], np.zeros(3)])
        for joint, value in enumerate(self._target):
            self.client.resetJointState(self.body, joint, float(value))
        self._load, self._speed = [0.0] * 3, [0.0] * 3

    def follow(self, pose_in_map: np.ndarray) -> None:
        """Set the motors towards a pose (4, 4); once per physics step.

        Motors keep what they were told: there is nothing to tell them where the pose has not changed since, as in every
        second step of the room, of which the robot's takes two.
        """
        if (pose := pose_in_map.tobytes()) == self._followed:
            return
        self._followed = pose
        self._target = motor_targets(pose_in_map, self._turn_at_reset, self._target)
        self.client.setJointMotorControlArray(
            self.body,
            _JOINTS,
            self.client.POSITION_CONTROL,
            targetPositions=self._target.tolist(),
            positionGains=_POSITION_GAINS,
            velocityGains=_VELOCITY_GAINS,
            forces=_FORCES,
        )

    def feel(self, duration: float | None = None) -> None:
        """Take a load reading; once per physics step, after it.

        Args:
            duration: of the step [s]; what speeds the handle itself up is then not felt.  It weighs more than a thing
                that is carried through the room; an arm is moved slowly.
        """
        for k, state in enumerate(self.client.getJointStates(self.body, (0, 1, 2))):  # in numbers: it is asked so often
            motor = state[3] / _FORCE
            if k == 2:
                motor -= _LIFTED * GRAVITY
            if duration is not None:
                speed = state[1] / _RATE
                motor -= _CARRIED[k] * (speed - self._speed[k]) / duration
                self._speed[k] = speed
            self._load[k] += _SMOOTHING * (-motor - self._load[k])

    @property
    def load(self) -> np.ndarray:
        """(3,) force that an arm held by a constraint exerts on the hand, map frame, own weight removed [N]."""
        return np.array(self._load)

    def position(self) -> np.ndarray:
        """(3,) where it really is [m]."""
        return np.array(self.client.getLinkState(self.body, self.link)[4])


def _fingers(turn: np.ndarray, opening: float) -> str:
    """Collision shapes of two fingers and a palm on a link whose axes are the map's."""
    roll, pitch, yaw = roll_pitch_yaw(turn)
    parts = []
    for middle, half in zip(*local_boxes(opening), strict=True):
        x, y, z = turn @ middle
        a, b, c = 2 * half
        parts.append(
            f'<collision><origin xyz="{x:.6f} {y:.6f} {z:.6f}" rpy="{roll:.9f} {pitch:.9f} {yaw:.9f}"/>'
            f'<geometry><box size="{a:.6f} {b:.6f} {c:.6f}"/></geometry></collision>'
        )
    return "".join(parts)


def roll_pitch_yaw(turn: np.ndarray) -> tuple[float, float, float]:
    """Angles [rad] about the fixed axes x, y and z, as URDF has them, of a rotation (3, 3).

    A hand that comes in level has its x axis upright, where roll and yaw turn about the same axis: roll is then 0.
    """
    pitch = math.atan2(-turn[2, 0], math.hypot(turn[2, 1], turn[2, 2]))
    if math.hypot(turn[2, 1], turn[2, 2]) < _UPRIGHT:
        return 0.0, pitch, math.atan2(-turn[0, 1], turn[1, 1])
    return math.atan2(turn[2, 1], turn[2, 2]), pitch, math.atan2(turn[1, 0], turn[0, 0])


def _urdf(fingers: str = "") -> str:
    # below 1e-3 kg m^2 the turning motors do not hold against the anchors
    inertia = '<inertia ixx="1e-3" iyy="1e-3" izz="1e-3" ixy="0" ixz="0" iyz="0"/>'
    parts = [f'<link name="room"><inertial><mass value="0"/>{inertia}</inertial></link>']
    parent = "room"
    for k, (kind, axis) in enumerate(_AXES):
        mass = MASS if k == _LINK else LINK_MASS
        shapes = fingers if k == _LINK else ""
        parts.append(f'<link name="l{k}"><inertial><mass value="{mass}"/>{inertia}</inertial>{shapes}</link>')
        # lower > upper: no limit, hence no limit constraint to solve for
        parts.append(
            f'<joint name="j{k}" type="{kind}"><parent link="{parent}"/><child link="l{k}"/>'
            f'<axis xyz="{axis}"/><limit lower="1" upper="-1" effort="1000" velocity="10"/></joint>'
        )
        parent = f"l{k}"
    return f'<robot name="handle">{"".join(parts)}</robot>'
