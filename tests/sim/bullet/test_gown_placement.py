"""A gown that is put on by hand."""

import numpy as np
from caretree.sim.bullet.coupled_room import TIME_STEP
from caretree.sim.bullet.gown_placement import RAISED, holding, put_on_by_hand
from caretree.sim.bullet.world import BulletWorld
from caretree.sim.evaluate.crossings import sleeve
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.robot.ur5_pair import UR5_PAIR
from caretree.sim.world import SIDES


def test_another_robot_holds_the_neckline_where_baxter_does():
    for n, side in enumerate(SIDES):
        theirs = kinematics_of(BAXTER).pose_hand_in_base(side, holding(kinematics_of(BAXTER))[n])
        ours = kinematics_of(UR5_PAIR).pose_hand_in_base(side, holding(kinematics_of(UR5_PAIR))[n])
        np.testing.assert_allclose(ours, theirs, atol=0.01)


def reached(spread):
    """How far up their arms (2,) the armholes come to rest, on arms spread by so much [rad]."""
    world = BulletWorld(seed=15)
    world._hook.release()
    put_on_by_hand(
        world._cloth,
        world._person,
        world._handles,
        world._client.stepSimulation,
        TIME_STEP,
        (0.0, 0.0),
        (spread, *RAISED[1:]),
    )
    vertices, arms, loops = world._cloth.vertices(), world._person.arms(), world.scene.mesh.loops
    world.close()
    worn = [
        sleeve(*(vertices[None, loops[f"{part}_{side}"]] for part in ("armhole", "cuff")), arms[None, n])
        for n, side in enumerate(SIDES)
    ]
    assert all(one.on.all() for one in worn)
    return np.array([one.armhole.upper_arm[0] for one in worn])


def test_sleeves_go_farther_up_arms_that_are_spread():
    narrow, wide = reached(0.5), reached(0.9)
    assert (wide > narrow + 0.04).all()
    assert wide.mean() > narrow.mean() + 0.1
