"""One soft world: what hangs and falls in it, and that its four users see the same cloth move the same way."""

from __future__ import annotations

from contextlib import closing

import numpy as np
import pytest
from caretree.learning.gap.cloth.scene import ClothEpisode, ClothScene, Physics, Pin
from caretree.learning.gap.cloth.simulate import simulate
from caretree.learning.gap.record import hung_path
from caretree.learning.physics.engine.bullet import bullet_fall
from caretree.learning.physics.engine.fall import RATE, steps_per_frame
from caretree.sim.bullet import coupled_room
from caretree.sim.bullet import world as room
from caretree.sim.bullet.soft_world import SoftWorld
from caretree.sim.scene.gown import GOWNS, GownSpec, build_gown

SMALL = GownSpec(name="small", spacing=0.11, front=7, back=2, hole=(2, 2), length=9, sleeve=2)
FRAMES = 10  # a third of a second
STEPS = 8  # between two frames


@pytest.fixture(scope="module")
def mesh():
    return build_gown(SMALL)


@pytest.fixture(scope="module")
def start(mesh):
    """Where the gown is let go, one corner of its neckline held: far above bed and floor."""
    return mesh.vertices + (0.0, 0.0, 4.0)


@pytest.fixture(scope="module")
def in_clip(mesh, start):
    """(frames, V, 3) of the learning clips."""
    assert steps_per_frame(SMALL, len(start)) == STEPS
    return bullet_fall(SMALL, start, FRAMES, clamp=0.0)


def in_recorder(mesh, start, monkeypatch):
    monkeypatch.setattr("caretree.learning.gap.record.RATE", RATE)
    _, path = hung_path(mesh, start, [mesh.corners[0]], None, FRAMES / RATE, 1.0 / RATE / STEPS)
    return path[:FRAMES]


def in_prediction(mesh, start, monkeypatch):
    scene = ClothScene(
        vertices=start,
        faces=mesh.faces,
        stays=mesh.stays,
        physics=Physics(
            mass=SMALL.mass,
            elastic_stiffness=SMALL.elastic,
            damping_stiffness=SMALL.damping,
            bending_stiffness=SMALL.bending,
            friction=SMALL.friction,
            gravity=(0.0, 0.0, -9.81),
            time_step=1.0 / RATE / STEPS,
            per_second=1e4,
        ),
        capsules=np.zeros((0, 7)),
        markers=tuple(range(len(start))),
    )
    episode = ClothEpisode(
        name="fall",
        role="fit",
        t=np.arange(FRAMES) / RATE,
        markers=np.zeros((FRAMES, len(start), 3)),
        load=None,
        pins=(Pin(vertices=(mesh.corners[0],), release_t=float("inf"), path=None),),
    )
    return simulate(scene, episode, (), {}).reshape(FRAMES, -1, 3)


def in_dressing_world(mesh, start, monkeypatch):
    monkeypatch.setitem(GOWNS, "small", SMALL)
    monkeypatch.setattr(coupled_room, "TIME_STEP", 1.0 / RATE / STEPS)
    with closing(room.BulletWorld(seed=0, gown="small")) as world:
        world._hook.release()
        world._cloth.place(start)
        world._cloth.pin([mesh.corners[0]])
        path = [world._cloth.vertices()]
        for _ in range(FRAMES - 1):
            for _ in range(STEPS):
                world._step_room()
            path.append(world._cloth.vertices())
    return np.array(path)


@pytest.mark.parametrize("user", [in_recorder, in_prediction, in_dressing_world])
def test_the_same_cloth_moves_the_same_way_for_every_user(mesh, start, in_clip, user, monkeypatch):
    path = user(mesh, start, monkeypatch)
    assert np.linalg.norm(in_clip[-1] - in_clip[0], axis=1).max() > 0.3  # it does fall
    np.testing.assert_allclose(path, in_clip, atol=1e-6, rtol=0.0)


def load(world, mesh, start, **options):
    return world.load_cloth(
        start, mesh.sewn, mass=0.45, elastic=45.0, damping=0.006, bending=0.1, friction=0.4, options=options
    )


@pytest.mark.parametrize("per_second", [1.0, 1e4])
def test_cloth_falls_freely_in_any_unit_of_time(mesh, start, per_second):
    with closing(SoftWorld(0.002, per_second=per_second, gravity=(0.0, 2.0, -9.81))) as world:
        cloth = load(world, mesh, start)
        for _ in range(100):
            world.step()
        moved = (world.vertices(cloth) - start).mean(axis=0)
    np.testing.assert_allclose(moved, np.array((0.0, 2.0, -9.81)) * 0.2**2 / 2, atol=0.003)


def test_anchored_vertices_stay_until_they_are_released(mesh, start):
    with closing(SoftWorld(0.002)) as world:
        cloth = load(world, mesh, start)
        held = [3, 5]
        constraints = world.anchor(cloth, held)
        for _ in range(50):
            world.step()
        np.testing.assert_allclose(world.vertices(cloth)[held], start[held], atol=1e-6)
        world.release(constraints)
        for _ in range(50):
            world.step()
        assert (world.vertices(cloth)[held, 2] < start[held, 2] - 0.02).all()


def test_options_reach_the_soft_body(mesh, start):
    paths = []
    for options in ({}, {"springDampingAllDirections": 0}):
        with closing(SoftWorld(0.002)) as world:
            cloth = load(world, mesh, start, **options)
            world.anchor(cloth, [0])
            for _ in range(100):
                world.step()
            paths.append(world.vertices(cloth))
    assert np.abs(paths[1] - paths[0]).max() > 1e-4
