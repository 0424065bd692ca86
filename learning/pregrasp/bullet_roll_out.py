"""The same action in PyBullet: its cloth, and fingers on a handle that push it; the room that trains nothing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...sim.bullet.cloth import Cloth
from ...sim.bullet.handle import Handle
from ...sim.bullet.soft_world import SoftWorld
from ...sim.pregrasp.action import HandPath
from ...sim.pregrasp.numbers import ACTION, ActionNumbers
from .gowns import mesh_of
from .hung_state import HungState
from .numbers import HANG
from .roll_out import Grasp, grasp_of, waypoints


def bullet_roll_out(state: HungState, path: HandPath, numbers: ActionNumbers = ACTION) -> Grasp:
    """Carry out an action in a PyBullet room of its own.

    Args:
        state: the gown, at rest.
        path: of the hand.
        numbers: of the primitives.
    """
    world = SoftWorld(HANG.step)
    try:
        mesh = mesh_of(state.gown)
        cloth = Cloth(world, mesh, mesh.vertices)
        cloth.pin(state.held)
        world.step()  # takes the rest lengths, see `learning/physics/engine/bullet.py`
        cloth.place(np.asarray(state.vertices, float))
        pose = path.pose_at_end
        pose[:3, 3] = path.start
        handle = Handle(world.client, pose, numbers.opening)
        world.client.changeDynamics(handle.body, handle.link, lateralFriction=0.5)
        for tip in waypoints(path, HANG.step, numbers):
            pose[:3, 3] = tip
            handle.follow(pose.copy())
            world.step()
        there = replace(path, end=handle.position())  # where the motors have brought it
        return grasp_of(state, cloth.vertices(), there, numbers.opening)
    finally:
        world.close()
