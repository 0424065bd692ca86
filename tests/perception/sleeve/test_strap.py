"""The strap of an armhole in the simulated room: a gown laid by hand, seen from where a hand's camera would be."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure
from caretree.perception.sleeve.strap import sleeve_strap
from caretree.perception.sleeve.strap_edge import strap_between
from caretree.sim.bullet.world import BulletWorld
from caretree.sim.render.camera import camera_intrinsics, looking_at
from caretree.sim.world import Frame


@pytest.fixture(scope="module")
def world():
    world = BulletWorld(seed=1)  # both straps lie: one that stands up is seen edge-on, and may be missed (4, right)
    world.set_initial_state("gown_on_person")
    yield world
    world.close()


def strap_of(world, side):
    """Middle line (n, 3) of the true strap, inner end first, and the mean direction across it."""
    mesh, now = world.scene.mesh, world._cloth.vertices()
    rim = mesh.loops[f"armhole_{side}"]
    rim = rim[mesh.vertices[rim][:, 2] > mesh.vertices[rim][:, 2].max() - 0.01]
    rim = rim[np.argsort(np.abs(mesh.vertices[rim][:, 0]))]
    edge = np.array([np.argmin(np.linalg.norm(mesh.vertices - mesh.vertices[k] * (1, 1, 0), axis=1)) for k in rim])
    across = (now[edge] - now[rim]).mean(axis=0)
    return (now[rim] + now[edge]) / 2, across / np.linalg.norm(across)


def view(world, target):
    """From 0.3 m above, a little from the feet."""
    pose = looking_at(target + (0.0, 0.08, 0.30), target)
    seen = world.observe()
    renderer = world._backdrop.update(
        world._vertices_now(),
        world._person.arms(),
        world.kinematics.configuration(seen.pose_base_in_map, seen.arm_positions),
    )
    rgb, depth = renderer.photograph("right_hand", pose, world._noise)
    return Frame(
        camera="right_hand",
        stamp=1.5,
        rgb=rgb,
        depth=depth,
        intrinsics=camera_intrinsics("right_hand"),
        pose_camera_in_map=pose,
    )


@pytest.mark.parametrize("side", ["left", "right"])
def test_both_ways_find_the_strap(world, side):
    line, across = strap_of(world, side)
    ring = world._cloth.vertices()[world.scene.mesh.loops[f"armhole_{side}"]]
    frame = view(world, line.mean(axis=0))
    near = ring.mean(axis=0)
    fine = np.concatenate([np.linspace(a, b, 10) for a, b in pairwise(line)])
    seen = sleeve_strap(frame, side, near)
    strap = strap_between(frame, near)
    for middle, direction in ((seen.position_in_map, seen.closing_in_map), (strap.middle, strap.across)):
        assert np.linalg.norm(fine - middle, axis=1).min() < 0.02
        assert direction @ across > 0.8
    assert seen.stamp == 1.5
    assert seen.approach_in_map[2] < -0.5
    assert seen.target == f"sleeve_{side}"


def test_no_strap_where_no_armhole_is(world):
    frame = view(world, np.array((0.0, 0.6, 0.7)))
    for find in (
        lambda: sleeve_strap(frame, "left", np.array((0.0, 0.6, 0.7))),
        lambda: strap_between(frame, np.array((0.0, 0.6, 0.7))),
    ):
        with pytest.raises(PerceptionFailure, match="rim"):
            find()
