"""The manikin's arms: some stay where they are put, others fall."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.sim.bullet.person import Person
from caretree.sim.bullet.soft_world import SoftWorld
from caretree.sim.scene.person_spec import StiffShoulder
from caretree.sim.scene.scene import BED_HALF, BED_THICKNESS, BED_TOP, draw_scene
from caretree.sim.world import SIDES
from caretree.sim.world_kind import WorldKind

STEP = 0.0025  # [s]
UP = (0.9, 0.7, -1.0, 0.6)  # an arm in the air [rad]


class Bed:
    """A person on a bed, nothing else."""

    def __init__(self, kind="easy+falling_arms", seed=103, **changes):
        scene = draw_scene(seed, kind=WorldKind.named(kind))
        self.soft = SoftWorld(STEP)
        c = self.soft.client
        bed = c.createMultiBody(
            0,
            c.createCollisionShape(c.GEOM_BOX, halfExtents=(*BED_HALF, BED_THICKNESS / 2)),
            useMaximalCoordinates=1,
            basePosition=(*scene.bed_xy, BED_TOP - BED_THICKNESS / 2),
        )
        c.changeDynamics(bed, -1, lateralFriction=1.0)
        self.person = Person(c, replace(scene.person, **changes), BED_TOP, scene.bed_xy)

    def joints(self, side="right"):
        """Angles and speeds (4,) [rad], [rad/s]."""
        states = self.soft.client.getJointStates(self.person.body, self.person.joints[side])
        return np.array([state[0] for state in states]), np.array([state[1] for state in states]) * 1e4

    def step(self, seconds):
        """Pass time; returns the joint centres (n, 2, 4, 3) after each control step [m]."""
        arms = []
        for k in range(round(seconds / STEP)):
            if k % 4 == 0:
                self.person.resist()
                arms.append(self.person.arms())
            self.soft.step()
        return np.array(arms)


@pytest.mark.parametrize("seed", [100, 101, 105, 112])
def test_an_arm_let_go_of_in_the_air_falls_and_comes_to_rest_on_the_bed(seed):
    bed = Bed(seed=seed, stiff={})
    for side in SIDES:
        bed.person.bend_arm(side, UP)
    before = bed.person.arms()
    arms = bed.step(2.0)
    assert (before[:, 1:, 2] - BED_TOP > 0.2).all()
    assert (arms[-1, :, 1:3, 2] - BED_TOP < 0.10).all()
    assert np.abs(arms[-1] - arms[-50]).max() < 0.005, "it lies still"
    speeds = np.linalg.norm(np.diff(arms, axis=0), axis=3) / (4 * STEP)
    assert 0.5 < speeds.max() < 5.0, "it falls and is not thrown [m/s]"
    lowest = np.minimum.accumulate(arms[:, :, 1, 2], axis=0)
    assert (arms[:, :, 1, 2] - lowest).max() < 0.03, "the elbow does not bounce [m]"


def test_a_forearm_on_the_trunk_is_carried_by_it():
    bed = Bed(stiff={})
    bed.person.bend_arm("right", (0.35, -0.1, -0.4, 1.6))
    arms = bed.step(0.3)[:, 1]
    flank = bed.person.trunk["trunk_right"]
    gaps = np.linalg.norm((arms[:, 2] - flank[0])[:, (0, 2)], axis=1)
    assert gaps.min() > flank[2] - 0.01, "the wrist never goes into the trunk"


def test_easy_arms_stay_where_they_are_put():
    bed = Bed(kind="easy")
    bed.person.bend_arm("right", UP)
    bed.step(1.0)
    assert bed.joints()[0] == pytest.approx(UP, abs=0.03)


def test_braced_arms_do_not_fall():
    bed = Bed(stiff={})
    bed.person.brace(True)
    bed.person.bend_arm("right", UP)
    bed.step(1.0)
    assert bed.joints()[0] == pytest.approx(UP, abs=0.03)
    bed.person.brace(False)
    bed.step(1.0)
    assert bed.joints()[0][1] < 0.1


@pytest.mark.parametrize("stiffness", [20.0, 40.0])
def test_a_stiff_shoulder_springs_back_to_the_end_of_its_range(stiffness):
    stiff = StiffShoulder(dry_friction=2.0, elevation_end=0.4, abduction_end=1.2, end_stiffness=stiffness)
    bed = Bed(stiff={"right": stiff})
    bed.person.bend_arm("right", (1.2 + 0.3, -0.2, -1.3, 0.5))  # beyond its range, on the bed
    bed.step(1.5)
    assert bed.joints()[0][0] < 1.2 + 0.3 - 0.1
    assert np.abs(bed.joints()[1]).max() < 0.2


def test_a_person_whose_arms_fall_can_stir_all_the_same():
    bed = Bed(stiff={})
    before = bed.step(1.0)[-1]
    bed.person.swing(0.45)
    bed.step(0.6)
    bed.person.swing(0.0)
    assert np.linalg.norm(bed.person.arms() - before, axis=2).max() > 0.05


def test_all_of_the_body_has_the_friction_of_its_skin():
    bed = Bed(kind="easy+skin_friction")
    client, person = bed.soft.client, bed.person
    links = [(person.body, link) for link in range(-1, client.getNumJoints(person.body))]
    links += [(body, -1) for body in person.trunk_bodies.values()]
    frictions = [client.getDynamicsInfo(*each)[1] for each in links]
    assert frictions == pytest.approx([person.spec.skin_friction] * len(links))
    assert person.spec.skin_friction > 0.6
