"""The force of an overlap: a spring, a damper, friction."""

from __future__ import annotations

import numpy as np
import pytest
from caretree.sim.bullet.contact_law import TUNING, ContactLaw
from caretree.sim.bullet.contact_pairs import Overlaps
from caretree.sim.scene.person_spec import PERSON_PARTS

TRUNK, HAND, HEAD = (PERSON_PARTS.index(name) for name in ("trunk", "right_hand", "head"))
PALM, FINGER, FOREARM = range(3)


def law() -> ContactLaw:
    """A robot of a hand (two capsules) and a forearm; a person of trunk (two capsules), hand and head."""
    return ContactLaw(np.array((0, 0, 1)), np.array((TRUNK, TRUNK, HAND, HEAD)), 0.9, 0.005, 0.0025)


def touch(*contacts: tuple[int, int, float], speed: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Overlaps:
    """Overlaps (robot, person, depth) whose normal is up."""
    robot, person, depth = zip(*contacts, strict=True)
    n = len(contacts)
    return Overlaps(
        robot=np.array(robot),
        person=np.array(person),
        depth=np.array(depth),
        normal=np.tile((0.0, 0.0, 1.0), (n, 1)),
        point=np.zeros((n, 3)),
        speed=np.tile(speed, (n, 1)),
        gap=-max(depth),
    )


@pytest.mark.parametrize(("person", "stiffness"), [(0, TUNING.trunk), (3, TUNING.head)])
def test_at_rest_it_is_a_spring(person, stiffness):
    force = law().forces(touch((PALM, person, 0.004)), 0.005)
    assert force[0] == pytest.approx((0.0, 0.0, 0.004 * stiffness))


def test_a_light_hand_is_softer_than_its_tissue():
    stiffness = law().stiffness[2]
    assert stiffness == pytest.approx(TUNING.arm_masses[2] * 0.9 / 0.0025**2)
    assert stiffness < TUNING.hand


def test_closing_adds_and_leaving_never_pulls():
    still = law().forces(touch((PALM, 0, 0.002)), 0.005)[0, 2]
    assert law().forces(touch((PALM, 0, 0.002), speed=(0, 0, -0.1)), 0.005)[0, 2] > still
    assert law().forces(touch((PALM, 0, 0.002), speed=(0, 0, 0.1)), 0.005)[0, 2] < still
    assert law().forces(touch((PALM, 0, 0.002), speed=(0, 0, 9.0)), 0.005)[0, 2] == 0.0


def test_capsules_of_one_hand_share_the_stiffness_of_a_part():
    alone = law().forces(touch((PALM, 0, 0.01)), 0.005).sum(axis=0)[2]
    assert law().forces(touch((PALM, 0, 0.01), (FINGER, 1, 0.01)), 0.005).sum(axis=0)[2] == pytest.approx(alone)
    assert law().forces(touch((PALM, 0, 0.01), (FOREARM, 0, 0.01)), 0.005).sum(axis=0)[2] == pytest.approx(2 * alone)
    nearly = law().forces(touch((PALM, 0, 0.01), (FINGER, 1, 1e-6)), 0.005).sum(axis=0)[2]
    assert nearly == pytest.approx(alone, rel=1e-3)  # no jump where a second one begins to touch


def test_friction_grows_with_sliding_up_to_its_share():
    pressed = law()
    sizes = []
    for _ in range(40):
        force = pressed.forces(touch((PALM, 0, 0.01), speed=(0.2, 0.0, 0.0)), 0.005)[0]
        assert force[1] == 0.0
        sizes.append(-force[0])
    assert sizes[0] < sizes[5] < sizes[-1]
    assert sizes[-1] == pytest.approx(TUNING.friction * 250.0)
    held = pressed.forces(touch((PALM, 0, 0.01)), 0.005)[0]
    assert -held[0] == pytest.approx(sizes[-1], rel=0.02)  # it sticks where it stopped


def test_what_overlaps_when_it_begins_is_forgiven_until_it_parts():
    pressed = law()
    pressed.forgive(np.ones((3, 4), bool))
    assert pressed.forces(touch((PALM, 0, 0.01)), 0.005)[0] == pytest.approx(0.0)
    assert pressed.forces(touch((PALM, 0, 0.012)), 0.005)[0, 2] == pytest.approx(0.002 * TUNING.trunk)
    assert pressed.forces(touch((PALM, 0, 0.004)), 0.005)[0, 2] == 0.0
    assert pressed.forces(touch((PALM, 0, 0.006)), 0.005)[0, 2] == pytest.approx(0.002 * TUNING.trunk)
    pressed.forget()
    assert pressed.forces(touch((PALM, 0, 0.01)), 0.005)[0, 2] == pytest.approx(0.01 * TUNING.trunk)
