"""Robot and person push each other; the robot is given by the places of its capsules."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from caretree.sim.bullet.contact import Contact
from caretree.sim.bullet.contact_law import TUNING
from caretree.sim.bullet.person import Person
from caretree.sim.bullet.soft_world import GRAVITY, SoftWorld
from caretree.sim.mechanics.capsules import RobotCapsules
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.scene.person_spec import PERSON_PARTS, PERSONS, PersonSpec, arm_part
from caretree.sim.world import SIDES

STEP = 0.0025  # of the room [s]; the robot takes two at once
BED_TOP = 0.6
NOBODY = [-1, -1]
TRUNK = PERSON_PARTS.index("trunk")
FAR = 9.0


class Room:
    """A person, and the robot's left hand wherever a test wants it; the rest of the robot is far away."""

    def __init__(self, spec: PersonSpec = PERSONS["average"]) -> None:
        self.soft = SoftWorld(STEP)
        self.person = Person(self.soft.client, spec, BED_TOP)
        self.capsules = RobotCapsules(kinematics_of(BAXTER))
        self.contact = Contact(self.capsules, self.person, 2 * STEP, STEP)
        self.ends = np.full((len(self.capsules.names), 2, 3), FAR)
        self.holds = list(NOBODY)
        self.steps = 0
        self.speeds: list[float] = []  # of the fastest point of an arm [m/s]
        self.forces: list[np.ndarray] = []
        self._arms = self.person.arms()

    @property
    def time(self) -> float:
        return self.steps * STEP

    def put(self, **ends: tuple) -> None:
        """Put capsules of the left hand somewhere at once: `palm_1=(a, b)`."""
        self.contact.forget()
        for name, place in ends.items():
            self.ends[self.capsules.names.index(f"left_{name}")] = place

    def meet(self) -> np.ndarray:
        """Forces on the parts with everything where it is, at rest."""
        self.contact.place(self.time, self.ends.copy())
        self.contact.meet(self.time, self.holds)
        return self.contact.part_force

    def run(self, duration: float, velocity: np.ndarray | tuple = (0.0, 0.0, 0.0)) -> None:
        """Let the hand move at a velocity [m/s] and everything else happen."""
        for _ in range(round(duration / STEP)):
            if self.steps % 2 == 0:
                self.contact.meet(self.time, self.holds)
                near = (self.ends < FAR - 1.0).all(axis=(1, 2))
                self.ends[near] += 2 * STEP * np.asarray(velocity)
                self.contact.place(self.time + 2 * STEP, self.ends.copy())
            else:
                self.contact.meet(self.time, self.holds)
            if self.steps % 4 == 0:
                self.person.resist()
            self.contact.push_arms()
            self.soft.step()
            self.steps += 1
            arms = self.person.arms()
            self.speeds.append(float(np.linalg.norm(arms - self._arms, axis=2).max()) / STEP)
            self.forces.append(self.contact.part_force)
            self._arms = arms


@pytest.fixture
def room():
    room = Room()
    yield room
    room.soft.close()


def palm_on_trunk(room: Room, depth: float) -> None:
    """Both capsules of the palm along the trunk, `depth` [m] inside its front."""
    a, _, radius = room.person.trunk["trunk_left"]
    height = a[2] + radius + room.capsules.radii[room.capsules.names.index("left_palm_1")] - depth
    room.put(
        palm_1=((a[0], -0.30, height), (a[0], -0.27, height)), palm_2=((a[0], -0.22, height), (a[0], -0.19, height))
    )


def test_a_palm_in_the_trunk_is_pushed_by_its_stiffness(room):
    palm_on_trunk(room, 0.01)
    assert room.meet()[TRUNK] == pytest.approx(0.01 * TUNING.trunk, rel=0.05)
    assert np.delete(room.contact.part_force, TRUNK).max() == 0.0


def test_the_wrist_feels_what_the_hand_touches_and_the_other_wrist_does_not(room):
    palm_on_trunk(room, 0.01)
    room.run(0.5)
    hands = np.stack([np.eye(4)] * 2)
    hands[0, :3, 3] = -0.10, -0.245, 0.8  # midway between the two capsules of the palm, 1 cm beside them
    wrench = room.contact.wrench(hands)
    x = room.person.trunk["trunk_left"][0][0]
    assert wrench[0, :3] == pytest.approx((0.0, 0.0, 250.0), abs=1.0)
    assert wrench[0, 3:] == pytest.approx((0.0, -(x + 0.10) * 250.0, 0.0), abs=0.5)
    assert not wrench[1].any()
    room.run(0.02, (0.0, 0.0, 1.0))
    assert 50.0 < room.contact.wrench(hands)[0, 2] < 200.0  # it follows in 40 ms
    room.run(1.0)
    assert not room.contact.wrench(hands).any()


def test_the_wrist_does_not_feel_what_is_before_it(room):
    a, b, radius = room.person.trunk["trunk_left"]
    up = np.array((0.0, 0.0, radius + 0.05))
    room.put(wrist_2=(a + up, b + up))
    room.run(0.1)
    assert room.forces[-1][TRUNK] > 50.0
    assert not room.contact.wrench(np.stack([np.eye(4)] * 2)).any()


def test_apart_there_is_no_force(room):
    palm_on_trunk(room, -0.001)
    assert not room.meet().any()
    assert not room.contact.on_arms


def test_the_peak_is_kept_until_it_is_forgotten(room):
    palm_on_trunk(room, 0.01)
    room.meet()
    palm_on_trunk(room, 0.002)
    room.meet()
    assert room.contact.part_peak[TRUNK] > room.contact.part_force[TRUNK] > 0.0
    room.contact.forget_peak()
    assert room.contact.part_peak[TRUNK] == room.contact.part_force[TRUNK]
    palm_on_trunk(room, -0.1)
    assert not room.meet().any()


def standing_palm(room: Room, arm: int, segment: int, share: float) -> np.ndarray:
    """Stand a palm upright 1 cm beside an arm's segment; returns the direction to push it (3,), inwards."""
    a, b = room.person.arms()[arm, segment : segment + 2]
    axis = (b - a) / np.linalg.norm(b - a)
    inwards = np.cross(axis, (0.0, 0.0, 1.0))
    inwards *= -np.sign(inwards[0]) * (1.0 if arm else -1.0)
    inwards /= np.linalg.norm(inwards)
    reach = room.person.radii()[arm, segment] + room.capsules.radii[room.capsules.names.index("left_palm_1")]
    middle = a + share * (b - a) - (reach + 0.01) * inwards
    room.put(palm_1=(middle - (0, 0, 0.05), middle + (0, 0, 0.05)))
    return inwards


@pytest.mark.parametrize("speed", [0.05, 0.5])
@pytest.mark.parametrize(("segment", "share"), [(0, 0.4), (0, 0.9), (1, 0.5), (1, 0.9), (2, 0.5), (2, 1.0)])
def test_a_palm_moves_an_arm_aside_and_throws_it_nowhere(room, segment, share, speed):
    inwards = standing_palm(room, 1, segment, share)
    before = room.person.arms()[1]
    touched = before[segment] + share * (before[segment + 1] - before[segment])
    lever = np.linalg.norm(before[3] - before[0]) / np.linalg.norm(touched - before[0])  # its tip is faster by that
    room.run(0.05 / speed, speed * inwards)
    assert ((room.person.arms()[1] - before) @ inwards).max() > 0.03
    assert max(room.speeds) < 0.1 + 2.0 * lever * speed
    assert max(force.max() for force in room.forces) < 60.0 + 120.0 * lever * speed
    part = arm_part(1, segment)
    pressed = [force[part] > 0.0 for force in room.forces]
    assert sum(pressed) > 0.4 * len(pressed)


def test_a_held_arm_is_not_pushed_by_the_hand_that_holds_it(room):
    a, b = room.person.arms()[1, 1:3]
    room.put(finger_1=(a, b), palm_1=(a, b), palm_2=(a, b))
    room.holds = [1, -1]
    assert not room.meet().any()
    assert not room.contact.on_arms
    room.put(wrist_2=(a, b))
    assert room.meet().any()  # but by its wrist


def test_a_hand_that_holds_one_arm_pushes_the_other(room):
    room.holds = [0, -1]
    room.meet()
    room.put(palm_1=room.person.arms()[1, 1:3])
    assert room.meet().any()


def test_a_hand_that_lets_go_does_not_throw_the_arm(room):
    a, b = room.person.arms()[1, 1:3]
    beside = np.array((0.0, 0.0, room.person.radii()[1, 1]))
    room.put(finger_1=(a + beside, b + beside))
    room.holds = [1, -1]
    room.run(0.05)
    assert max(force.max() for force in room.forces) == 0.0
    room.holds = list(NOBODY)
    room.run(0.3)
    assert max(force.max() for force in room.forces) < 5.0
    room.run(0.2, (0.0, 0.0, 0.2))  # away ...
    room.run(0.3, (0.0, 0.0, -0.2))  # ... and back: now it pushes
    assert room.forces[-1].max() > 5.0


@pytest.mark.parametrize("aside", [-0.008, 0.008])
def test_closing_fingers_bring_an_arm_between_them(room, aside):
    """0.15 m/s, as fast as the gripper closes."""
    a, b = room.person.arms()[1, 1:3]
    axis = (b - a) / np.linalg.norm(b - a)
    across = np.cross(axis, (0.0, 0.0, 1.0))
    across /= np.linalg.norm(across)
    middle = a + 0.6 * (b - a) + aside * across
    up, radius = np.array((0.0, 0.0, 0.03)), 0.006
    thickness = 2 * room.person.radii()[1, 1]
    opening = 0.085
    while opening > thickness:
        opening -= 0.15 * 2 * STEP
        for finger, sign in ((1, 1.0), (2, -1.0)):
            place = middle + sign * (opening / 2 + radius) * across
            room.ends[room.capsules.names.index(f"left_finger_{finger}")] = place - up, place + up
        room.run(2 * STEP)
    room.run(0.1)
    arms = room.person.arms()[1]
    assert abs((arms[1] + 0.6 * (arms[2] - arms[1]) - middle) @ across) < 0.005
    assert max(room.speeds) < 1.0
    assert room.forces[-1].max() < 30.0


def test_what_keeps_a_finger_from_closing_is_its_squeeze(room):
    a, b = room.person.arms()[1, 1:3]
    across = np.cross((b - a) / np.linalg.norm(b - a), (0.0, 0.0, 1.0))
    hands = np.stack([np.eye(4)] * 2)
    hands[0, :3, 1] = across / np.linalg.norm(across)  # closes in this direction
    beside = (room.person.radii()[1, 1] + 0.005) * hands[0, :3, 1]
    up, middle = np.array((0.0, 0.0, 0.02)), (a + b) / 2
    room.put(finger_1=(middle + beside - up, middle + beside + up))
    force = room.meet()
    assert force.max() == pytest.approx(0.001 * TUNING.forearm, rel=0.05)
    assert room.contact.squeeze(hands) == pytest.approx((force.max(), 0.0))
    room.put(finger_1=(middle - beside - up, middle - beside + up))
    assert room.meet().any()
    assert room.contact.squeeze(hands)[0] == 0.0  # its back is pushed


def test_an_arm_that_falls_on_a_palm_comes_to_rest():
    limp = replace(PERSONS["average"], dry_friction=(0.05, 0.02), viscous=0.1)
    room = Room(limp)
    room.person.bend_arm("right", (0.9, 0.5, -1.3, 0.3))
    a, b = room.person.arms()[1, 1:3]
    below = (a + 0.7 * (b - a)) - (0.0, 0.0, 0.14)
    room.put(palm_1=(below - (0.0, 0.05, 0.0), below + (0.0, 0.05, 0.0)), palm_2=(below - (0.06, 0, 0), below))
    room.run(3.0)
    part = PERSON_PARTS.index("right_forearm")
    assert room.forces[0].max() == 0.0
    first = next(n for n, force in enumerate(room.forces) if force[part] > 0.0)
    assert max(room.speeds[first + 200 :]) < 0.5 * room.speeds[first]  # it does not bounce for ever
    assert max(room.speeds[-100:]) < 0.01
    arms = room.person.arms()[1]
    assert room.forces[-1][part] == pytest.approx(np.mean([force[part] for force in room.forces[-100:]]), rel=0.1)
    assert 1.0 < room.forces[-1][part] < 0.9 * GRAVITY  # part of the arm's weight
    room.soft.close()
    assert (arms[:, 2] > BED_TOP).all()


def test_it_happens_the_same_way_twice():
    ends = []
    for _ in range(2):
        room = Room()
        inwards = standing_palm(room, 0, 1, 0.7)
        room.run(0.4, 0.3 * inwards)
        ends.append((room.person.arms(), np.array(room.forces)))
        room.soft.close()
    np.testing.assert_array_equal(ends[0][0], ends[1][0])
    np.testing.assert_array_equal(ends[0][1], ends[1][1])


def test_every_capsule_of_the_robot_belongs_to_a_link_that_can_be_pushed(room):
    known = {frame.name for frame in kinematics_of(BAXTER).model.frames}
    assert set(room.contact._links) <= known
    assert not any("finger" in link for link in room.contact._links)
    assert [room.contact._hand[n].sum() for n in range(len(SIDES))] == [4, 4]  # two palms, two fingers
