"""Robot and person touch: every link above the base against every part of the body, both of them capsules.

The two live in different PyBullet clients (`world.py`), so no solver sees both: the forces are computed here
(`contact_law.py`) and given to each.  Forces on the trunk, the legs and the head, which do not move, push only the
robot.  A gripper's gear does not give: what pushes a finger pushes the hand.
"""

from __future__ import annotations

import math

import numpy as np

from ..mechanics.capsules import RobotCapsules
from ..robot.body import JointReading, RobotBody
from ..scene.person_spec import ARM_SEGMENTS, PERSON_PARTS, arm_part, part_of
from ..world import SIDES
from .contact_law import ContactLaw
from .contact_pairs import Capsules, overlaps
from .person import Person
from .units import ROOM

SENSOR_TIME = 0.04  # the wrists' sensors follow in this time, as they follow an arm that hangs on a hand [s]
FASTEST = 4.0  # robot and person do not approach each other faster: a hand at 1 m/s, an arm that falls at 3 m/s [m/s]


class Contact:
    """What robot and person do to each other.

    Call `watch` after every step of the robot, `meet` before every step of the robot or the room, and right before
    these steps `push_robot` and `push_arms`.

    Args:
        capsules: of the robot.
        person: the body, in the room's client.
        robot_step: of the robot's physics [s].
        room_step: of the room's physics [s].

    Attributes:
        law: the forces.
        on_arms: whether the robot pushes an arm.
        part_force: (k,) on each of `PERSON_PARTS` now [N].
        part_peak: (k,) the largest since `forget_peak` [N].
    """

    def __init__(self, capsules: RobotCapsules, person: Person, robot_step: float, room_step: float) -> None:
        self._capsules, self._person, self._robot_step = capsules, person, robot_step
        trunk, count = person.trunk.values(), len(ARM_SEGMENTS)
        self._still = len(trunk)  # capsules of the person that do not move; those of the arms come after them
        self._ends = np.array([(a, b) for a, b, _ in trunk] + [(np.zeros(3), np.zeros(3))] * (2 * count))
        self._radii = np.concatenate(([radius for *_, radius in trunk], person.radii().ravel()))
        arms = [arm_part(arm, segment) for arm in range(2) for segment in range(count)]
        self._parts = np.array([part_of(name) for name in person.trunk] + arms)
        self._arm = np.repeat((-1, 0, 1), (self._still, count, count))  # which arm a capsule belongs to, -1 none
        self._links = [_rigid_link(capsule.link) for capsule in capsules.capsules]
        self._hand = np.array([[link == f"{side}_gripper" for link in self._links] for side in SIDES])
        self._fingers = [[capsules.names.index(f"{side}_finger_{n}") for n in (1, 2)] for side in SIDES]
        bodies = np.unique(self._links, return_inverse=True)[1]
        self.law = ContactLaw(bodies, self._parts, float(person.spec.arm_masses.sum()), robot_step, room_step)
        self._holds = [-1, -1]
        self._free = np.zeros((len(bodies), len(self._parts)), bool)  # pairs that do not push each other
        self.part_force, self.part_peak = np.zeros(len(PERSON_PARTS)), np.zeros(len(PERSON_PARTS))
        self.forget()

    def forget(self) -> None:
        """The robot stands somewhere else at once."""
        self._robot: list[tuple[float, np.ndarray]] = []  # its last two places: time, ends
        self._seen = self._met = self._clear_until = -np.inf  # the arms, the last forces, and no force before
        self._felt, self._felt_at = np.zeros((2, 6)), 0.0  # wrenches about the map's origin, and when
        self._feels = False  # whether they are any
        self._part_ways()

    def _part_ways(self) -> None:
        """Nothing touches."""
        self._touching = self.on_arms = False
        self._force = self._point = np.zeros((0, 3))
        self._pushed = self._pressed = np.zeros(0, int)
        self.part_force = np.zeros(len(PERSON_PARTS))
        self.law.forget()

    # -- before the forces ---------------------------------------------------------------------------------

    def watch(self, time: float, reading: JointReading) -> None:
        """The robot stands like this at `time` [s]; looked at only where it can be near the person."""
        if time < self._clear_until:
            self._robot = []
            return
        ends = self._capsules.ends(
            reading.pose_base_in_map, reading.arm_positions, reading.head_pan, reading.gripper_opening
        )
        self.place(time, ends)

    def place(self, time: float, ends: np.ndarray) -> None:
        """The axes of the robot's capsules end at `ends` (r, 2, 3) at `time` [s]."""
        self._robot = [*self._robot[-1:], (time, ends)]

    def meet(self, time: float, holds: list[int]) -> None:
        """Compute the forces at `time` [s].

        Args:
            time: now, between the last two places of the robot or at the last.
            holds: which arm each hand holds (-1 none, 0 left, 1 right): palm and fingers do not push it, and where they
                reach into it when they let it go, they push only what goes deeper.
        """
        self._feel(time)
        if holds != self._holds:
            self._hold(holds)
        if not self._robot or time < self._clear_until:
            return
        found = overlaps(self._robot_at(time), self._person_at(time), self._free)
        self._clear_until = time + found.gap / FASTEST
        if len(found.depth):
            self._touching = True
            self._force = self.law.forces(found, min(time - self._met, self._robot_step))
            self._point, self._pushed, self._pressed, self._met = found.point, found.robot, found.person, time
            self.on_arms = bool(self._force[self._pressed >= self._still].any())
            total = np.zeros((len(PERSON_PARTS), 3))
            np.add.at(total, self._parts[found.person], self._force)
            self.part_force = np.linalg.norm(total, axis=1)
            self.part_peak = np.maximum(self.part_peak, self.part_force)
        elif self._touching:
            self._part_ways()

    def _hold(self, holds: list[int]) -> None:
        """Hands take or let go of an arm."""
        before, self._free = self._free, np.zeros_like(self._free)
        for hand, arm in zip(self._hand, holds, strict=True):
            if arm >= 0:
                self._free |= hand[:, None] & (self._arm == arm)
        self.law.forgive(before & ~self._free)
        self._holds, self._clear_until, self._touching = list(holds), -np.inf, True

    def _feel(self, time: float) -> None:
        """The wrists' sensors follow what has touched the hands since the last time."""
        if self._touching or self._feels:
            now = np.zeros((2, 6))
            for n, hand in enumerate(self._hand):
                force, point = self._force[hand[self._pushed]], self._point[hand[self._pushed]]
                now[n] = (*force.sum(axis=0), *np.cross(point, force).sum(axis=0))
            self._felt += (1.0 - math.exp((self._felt_at - time) / SENSOR_TIME)) * (now - self._felt)
            self._felt[np.abs(self._felt) < 1e-3] = 0.0
            self._feels = bool(self._felt.any())
        self._felt_at = time

    def _robot_at(self, time: float) -> Capsules:
        last, ends = self._robot[-1]
        speed = np.zeros_like(ends)
        if len(self._robot) == 2:
            before, start = self._robot[0]
            speed = (ends - start) / (last - before)
            ends = ends + (time - last) * speed
        return Capsules(ends=ends, speed=speed, radii=self._capsules.radii)

    def _person_at(self, time: float) -> Capsules:
        joints, ends, speed = self._person.arms(), self._ends.copy(), np.zeros_like(self._ends)
        ends[self._still :, 0], ends[self._still :, 1] = joints[:, :-1].reshape(-1, 3), joints[:, 1:].reshape(-1, 3)
        if 0.0 < time - self._seen < 1.5 * self._robot_step:
            speed = (ends - self._ends) / (time - self._seen)
        self._ends, self._seen = ends, time
        return Capsules(ends=ends, speed=speed, radii=self._radii)

    # -- the forces ----------------------------------------------------------------------------------------

    def push_robot(self, robot: RobotBody) -> None:
        """Load the robot for its next step."""
        for capsule, force, point in zip(self._pushed, self._force, self._point, strict=True):
            robot.push(self._links[capsule], force, point)

    def push_arms(self) -> None:
        """Load the arms for the room's next step."""
        if not self.on_arms:
            return
        person, client = self._person, self._person.client
        for n in np.flatnonzero(self._pressed >= self._still):
            arm, segment = divmod(int(self._pressed[n]) - self._still, len(ARM_SEGMENTS))
            link, force = person.links[SIDES[arm]][segment], [-ROOM.force(value) for value in self._force[n]]
            client.applyExternalForce(person.body, link, force, self._point[n].tolist(), client.WORLD_FRAME)

    def wrench(self, hands: np.ndarray) -> np.ndarray:
        """(2, 6) force [N] and torque [N m] about hands at `hands` (2, 4, 4) of what touches palms and fingers.

        The sensors sit between the arms' last link and the grippers, so they do not feel the wrist.
        """
        out = self._felt.copy()
        if self._feels:
            out[:, 3:] -= np.cross(hands[:, :3, 3], out[:, :3])
        return out

    def squeeze(self, hands: np.ndarray) -> np.ndarray:
        """(2,) force that keeps a finger of each hand at `hands` (2, 4, 4) from closing, the larger of the two [N]."""
        out = np.zeros(2)
        if self._touching:
            for n, fingers in enumerate(self._fingers):
                for finger, sign in zip(fingers, (1.0, -1.0), strict=True):
                    force = self._force[self._pushed == finger].sum(axis=0)
                    out[n] = max(out[n], sign * force @ hands[n, :3, 1])
        return out

    def forget_peak(self) -> None:
        """Begin a new span of time for `part_peak`."""
        self.part_peak = self.part_force.copy()


def _rigid_link(link: str) -> str:
    """The link that a force on `link` moves."""
    return f"{link.split('_')[0]}_gripper" if "finger" in link else link
