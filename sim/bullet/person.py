"""The person: a life-sized manikin, supine, with arms that nothing but contact and the robot's grip moves.

The trunk rests on the bed and stays there (the robot could not move it); each arm is a passive chain of a three-axis
shoulder and an elbow, with dry and viscous friction and joint limits, and a stiff hand.  Where friction is below
gravity, an arm that nobody holds falls onto bed or trunk.  Sizes, masses and what the joint angles mean:
`scene/person_spec.py`.
"""

from __future__ import annotations

import math
from itertools import product
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import numpy as np

from ..scene.person_spec import (
    ARM_AXES,
    JOINT_LIMITS,
    OUTWARD,
    PersonSpec,
    shoulder_in_map,
    torso_front,
    trunk_capsules,
)
from ..world import SIDES, Side
from .contact_law import TUNING
from .units import ROOM

BRACED = 60.0  # torque that keeps an arm which somebody carries before a run [N m]
BRISTLE = 0.02  # how far a joint gives before its friction slips [rad]
STIR_SPEED = 0.45  # of both shoulders, outwards ... [rad/s]
STIR_TIME = 0.6  # ... for this long [s]
STIR_TORQUE = 7.0  # of a shoulder that its owner moves [N m]: a tenth of an adult's strength, enough to lift the arm


class Person:
    """The manikin in a PyBullet client.  Truth: skills, trees and perception never see this object."""

    def __init__(
        self,
        client: Any,
        spec: PersonSpec,
        bed_top: float,
        bed_xy: tuple[float, float] = (0.0, 0.0),
        plain: bool = True,
    ) -> None:
        """Load the body and set its arm pose.

        Args:
            client: PyBullet module or BulletClient with a deformable world.
            spec: who.
            bed_top: height of the mattress [m].
            bed_xy: middle of the bed in the map frame [m].
            plain: the trunk as rigid bodies without links, which soft bodies meet at half the cost, but whose shapes
                cannot be read.
        """
        self._plain = plain
        self.client, self.spec = client, spec
        self.bed_top, self.bed_xy = bed_top, bed_xy
        self.shoulders = {side: shoulder_in_map(spec, side, bed_top, bed_xy) for side in SIDES}
        self.trunk = trunk_capsules(spec, bed_top, bed_xy)
        self.trunk_bodies = {name: self._add_capsule(*capsule) for name, capsule in self.trunk.items()}
        self.body = self._load()
        names = {client.getJointInfo(self.body, j)[1].decode(): j for j in range(client.getNumJoints(self.body))}
        self.joints = {side: [names[f"{side}_{axis}"] for axis in ARM_AXES] for side in SIDES}
        self._joints = [j for side in SIDES for j in self.joints[side]]
        self.links = {
            side: [names[f"{side}_rotation"], names[f"{side}_flexion"], names[f"{side}_wrist"]] for side in SIDES
        }
        for side in SIDES:
            for j, angle in zip(self.joints[side], spec.pose[side], strict=True):
                client.resetJointState(self.body, j, angle)
        for link in range(-1, client.getNumJoints(self.body)):
            client.changeDynamics(self.body, link, linearDamping=0.0, angularDamping=0.0)
            client.changeDynamics(self.body, link, activationState=client.ACTIVATION_STATE_DISABLE_SLEEPING)
            client.changeDynamics(self.body, link, jointDamping=0.0)
            # by itself: beside the dampings, a link keeps the default of 0.5
            client.changeDynamics(self.body, link, lateralFriction=spec.skin_friction)
        # upper arm and trunk overlap at the shoulder, where contact could not part them: pushed, the arm would explode
        for upper, part in product((self.links[side][0] for side in SIDES), self.trunk_bodies.values()):
            client.setCollisionFilterPair(self.body, part, upper, -1, 0)
        self._dry, self._ends, self._end_stiffness = (np.ravel(values) for values in _resistance(spec))
        self._torso_front = torso_front(spec, bed_top, bed_xy)
        self._swing, self._braced = 0.0, False
        self._stirs_until: float | None = None
        self._stuck = np.array([angle for side in SIDES for angle in spec.pose[side]])
        self.resist()

    def resist(self) -> None:
        """Set the joints' friction for their present angles and speeds; every 10 ms or so.

        Dry friction as a bristle: each joint is held at an angle with a bounded torque, and the angle is dragged
        along when the joint is forced away from it.  The bound grows with the speed, which adds the viscous part.
        (A velocity motor would creep by one step of gravity, 0.16 rad/s at the elbow; Bullet's own joint damping
        is explicit and shakes these light arms apart.)  Beyond the end of its range a stiff joint is held at that end,
        with a bound that grows with the angle.
        """
        angles, speeds, *_ = zip(*self.client.getJointStates(self.body, self._joints), strict=True)
        angles, speeds = np.array((angles, speeds))
        speeds /= ROOM.rate(1.0)
        torques = self._dry + self.spec.viscous * np.abs(speeds) + BRACED * self._braced
        wanted = np.zeros(8)  # speeds
        if self._swing:
            self._stuck[::4], wanted[::4] = angles[::4], self._swing
            torques[::4] = np.maximum(torques[::4], max(STIR_TORQUE, self.spec.stirring))
        torques = torques + self._end_stiffness * np.maximum(angles - self._ends, 0.0)
        self._stuck = np.minimum(np.minimum(np.maximum(self._stuck, angles - BRISTLE), angles + BRISTLE), self._ends)
        self.client.setJointMotorControlArray(
            self.body,
            self._joints,
            self.client.POSITION_CONTROL,
            targetPositions=self._stuck.tolist(),
            targetVelocities=[ROOM.rate(speed) for speed in wanted.tolist()],
            positionGains=[0.2] * 8,
            velocityGains=[1.0] * 8,
            forces=[ROOM.force(torque) for torque in torques.tolist()],
        )

    def spring(self) -> None:
        """Draw the shoulders back to where they started, where this person's are so; before every step."""
        if not self.spec.shoulder_spring:
            return
        joints = [j for side in SIDES for j in self.joints[side][:2]]
        start = np.array([angle for side in SIDES for angle in self.spec.pose[side][:2]])
        angles = np.array([state[0] for state in self.client.getJointStates(self.body, joints)])
        torques = self.spec.shoulder_spring * (start - angles)
        self.client.setJointMotorControlArray(
            self.body, joints, self.client.TORQUE_CONTROL, forces=[ROOM.force(t) for t in torques]
        )

    def give_skin(self) -> None:
        """Let the arms be as soft in contact as skin is; only where something soft may touch them.

        Bullet adds the damping of both partners, and a body that was told nothing has 0.1 in Bullet's own units: 1 kN
        s/m here, 100 times what a sponge has.
        """
        skin = (TUNING.upper_arm, TUNING.forearm, TUNING.hand)
        for side in SIDES:
            for link, stiffness in zip(self.links[side], skin, strict=True):
                self.client.changeDynamics(self.body, link, contactStiffness=ROOM.force(stiffness), contactDamping=0.0)

    def bend_arm(self, side: Side, angles: tuple[float, float, float, float]) -> None:
        """Put an arm somewhere else at once, where its friction then holds it; only before a run.

        Args:
            side: which arm.
            angles: in the order of `ARM_AXES` [rad].
        """
        for j, angle in zip(self.joints[side], angles, strict=True):
            self.client.resetJointState(self.body, j, angle)
        first = 4 * SIDES.index(side)
        self._stuck[first : first + 4] = angles
        self.resist()

    def brace(self, braced: bool) -> None:
        """Keep arms that fall where they are, as hands under them would, or let them go; only before a run."""
        self._braced = braced and self.spec.falls
        self.resist()

    def swing(self, speed: float) -> None:
        """Swing both arms outwards at `speed` [rad/s] with the joints' own torque; 0 makes them passive again."""
        self._swing = speed
        self.resist()

    @property
    def stirs(self) -> bool:
        """Whether the person moves by itself."""
        return self._stirs_until is not None

    def begin_to_stir(self, time: float) -> None:
        """Swing both arms outwards for a moment, from now [s] on."""
        self._stirs_until = time + STIR_TIME

    def stir(self, time: float) -> None:
        """Go on with what `begin_to_stir` began; before every step, with the world clock [s]."""
        if self._stirs_until is None:
            return
        goes_on = time < self._stirs_until
        self.swing(STIR_SPEED if goes_on else 0.0)
        if not goes_on:
            self._stirs_until = None

    def arms(self) -> np.ndarray:
        """(2, 4, 3) [left, right] x [shoulder, elbow, wrist, fingertip] in the map frame [m]."""
        links = [link for side in SIDES for link in self.links[side]]
        states = self.client.getLinkStates(self.body, links, computeForwardKinematics=1)
        out = np.empty((2, 4, 3))
        for i in range(2):
            upper, fore, hand = states[3 * i : 3 * i + 3]
            out[i, :3] = upper[4], fore[4], hand[4]
            x, y, z, w = hand[5]
            along = np.array((2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)))  # the hand's y axis
            out[i, 3] = out[i, 2] + self.spec.arm_lengths[2] * along
        return out

    def torso_front(self) -> np.ndarray:
        """(m, 6) points on the front of the trunk with outward normals, chest to waist, map frame [m]."""
        return self._torso_front.copy()

    def radii(self) -> np.ndarray:
        """(2, 3) capsule radii of upper arm, forearm, hand, left then right [m]."""
        return np.tile(self.spec.arm_radii, (2, 1))

    def _add_capsule(self, a: np.ndarray, b: np.ndarray, radius: float) -> int:
        c = self.client
        middle, length, turn = _along(a, b)
        shape = c.createCollisionShape(c.GEOM_CAPSULE, radius=radius, height=length)
        body: int = c.createMultiBody(
            0,
            shape,
            basePosition=middle.tolist(),
            useMaximalCoordinates=int(self._plain),
            baseOrientation=c.getQuaternionFromEuler(turn),
        )
        c.changeDynamics(body, -1, lateralFriction=self.spec.skin_friction)
        return body

    def _load(self) -> int:
        import tempfile

        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "person.urdf"
            path.write_text(ET.tostring(self._urdf(), encoding="unicode"))
            return self.client.loadURDF(str(path), useFixedBase=True)

    def _urdf(self) -> ET.Element:
        spec = self.spec
        robot = ET.Element("robot", name="person")
        _link(robot, "trunk", spec.trunk_mass)
        masses, lengths, radii = spec.arm_masses, spec.arm_lengths, spec.arm_radii
        for side in SIDES:
            sign = OUTWARD[side]
            # the arm's own frame: y along the arm, x away from the body (mirrored on the left by the joint axes)
            axes = {"abduction": (0, 0, -sign), "elevation": (1, 0, 0), "rotation": (0, sign, 0), "flexion": (1, 0, 0)}
            parent, offset = "trunk", self.shoulders[side]
            for name, mass, length, radius in (
                ("abduction", 0.02, 0, 0),
                ("elevation", 0.02, 0, 0),
                ("rotation", masses[0], lengths[0], radii[0]),
                ("flexion", masses[1], lengths[1], radii[1]),
            ):
                link = _link(robot, f"{side}_{name}", mass, length)
                if length:
                    _capsule(link, (0, 0, 0), (0, length, 0), radius)
                _joint(robot, f"{side}_{name}", parent, f"{side}_{name}", offset, axes[name], JOINT_LIMITS[name])
                parent, offset = f"{side}_{name}", np.array([0.0, length, 0.0])
            hand = _link(robot, f"{side}_hand", masses[2], lengths[2])
            _capsule(hand, (0, 0, 0), (0, lengths[2], 0), radii[2])
            _joint(robot, f"{side}_wrist", parent, f"{side}_hand", offset)
        return robot


def _resistance(spec: PersonSpec) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Dry friction [N m], upper end of the range [rad] and stiffness beyond it [N m/rad], each (2, 4): side, axis."""
    shoulder, elbow = spec.dry_friction
    dry = np.tile((shoulder, shoulder, shoulder, elbow), (2, 1))
    ends, stiffness = np.full((2, 4), np.inf), np.zeros((2, 4))
    for side, stiff in spec.stiff.items():
        n = SIDES.index(side)
        dry[n, :3] = stiff.dry_friction
        ends[n, :2] = stiff.abduction_end, stiff.elevation_end
        stiffness[n, :2] = stiff.end_stiffness
    return dry, ends, stiffness


def _link(robot: ET.Element, name: str, mass: float, length: float = 0.0) -> ET.Element:
    link = ET.SubElement(robot, "link", name=name)
    inertial = ET.SubElement(link, "inertial")
    ET.SubElement(inertial, "origin", xyz=f"0 {length / 2} 0")
    ET.SubElement(inertial, "mass", value=f"{mass}")
    # at least a small ball's inertia: near-massless links of a chain make the solver stiff
    across, along = max(mass * length**2 / 12, 5e-4), max(mass * 0.04**2 / 2, 3e-4)
    ET.SubElement(inertial, "inertia", ixx=f"{across}", iyy=f"{along}", izz=f"{across}", ixy="0", ixz="0", iyz="0")
    return link


def _along(a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, float, list[float]]:
    """Middle, length and roll-pitch-yaw that turn a capsule along z into the one from a to b."""
    d = b - a
    length = float(np.linalg.norm(d))
    return (a + b) / 2, length, [0.0, math.acos(d[2] / length), math.atan2(d[1], d[0])]


def _capsule(link: ET.Element, a: Any, b: Any, radius: float) -> None:
    middle, length, turn = _along(np.asarray(a, float), np.asarray(b, float))
    for kind in ("collision", "visual"):
        element = ET.SubElement(link, kind)
        ET.SubElement(element, "origin", xyz=" ".join(map(str, middle)), rpy=" ".join(map(str, turn)))
        ET.SubElement(ET.SubElement(element, "geometry"), "capsule", radius=f"{radius}", length=f"{length}")


def _joint(
    robot: ET.Element,
    name: str,
    parent: str,
    child: str,
    offset: Any,
    axis: tuple[float, ...] | None = None,
    limits: tuple[float, float] | None = None,
) -> None:
    joint = ET.SubElement(robot, "joint", name=name, type="revolute" if axis else "fixed")
    ET.SubElement(joint, "parent", link=parent)
    ET.SubElement(joint, "child", link=child)
    ET.SubElement(joint, "origin", xyz=" ".join(map(str, offset)))
    if axis and limits:
        ET.SubElement(joint, "axis", xyz=" ".join(map(str, axis)))
        ET.SubElement(joint, "limit", lower=f"{limits[0]}", upper=f"{limits[1]}", effort="100", velocity="10")
