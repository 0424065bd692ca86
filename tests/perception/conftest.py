"""Rendered scenes with known geometry: a gown hung, stretched or laid, and a person on a bed.

Cloth that hangs or lies is settled by a second or two of PyBullet, once per session and shape.
"""

from __future__ import annotations

import tempfile
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pytest
from caretree.sim.render.appearance import Appearance, draw_appearance, gown_colours
from caretree.sim.render.camera import HEAD_SIZE, Renderer, camera_intrinsics, looking_at
from caretree.sim.render.solids import box_mesh, capsule_mesh, cylinder_mesh, join_meshes
from caretree.sim.scene.gown import GOWNS, GownMesh, build_gown
from caretree.sim.world import Frame

BED = np.array(((-0.45, -1.0, 0.5), (0.45, 1.0, 0.6)))
GOWN = build_gown(GOWNS["medium"])
RADII = (0.041, 0.036, 0.030)
BEDSIDE = looking_at(np.array((0.70, -0.30, 1.66)), np.array((-0.26, -0.30, 0.70)))  # Baxter's head at the bed


def turned(angle: float) -> np.ndarray:
    """Rotation (3, 3) about z."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array(((c, -s, 0), (s, c, 0), (0, 0, 1)))


def settle(vertices, pins=(), capsules=(), boxes=(), seconds=2.0):
    """Vertices (V, 3) of the gown after it has hung or lain for a while."""
    import pybullet
    from pybullet_utils.bullet_client import BulletClient

    client = BulletClient(pybullet.DIRECT)
    client.resetSimulation(pybullet.RESET_USE_DEFORMABLE_WORLD)
    client.setGravity(0, 0, -9.81)
    client.setTimeStep(0.002)
    for a, b, radius in capsules:
        a, b = np.array(a, float), np.array(b, float)
        length = np.linalg.norm(b - a)
        axis = np.cross((0, 0, 1), (b - a) / length)
        angle = float(np.arctan2(np.linalg.norm(axis), (b - a)[2] / length))
        turn = client.getQuaternionFromAxisAngle((axis / np.linalg.norm(axis)).tolist(), angle)
        shape = client.createCollisionShape(pybullet.GEOM_CAPSULE, radius=radius, height=float(length))
        client.createMultiBody(0, shape, basePosition=((a + b) / 2).tolist(), baseOrientation=turn)
    for low, high in boxes:
        shape = client.createCollisionShape(pybullet.GEOM_BOX, halfExtents=((high - low) / 2).tolist())
        client.createMultiBody(0, shape, basePosition=((low + high) / 2).tolist())
    spec = GOWN.spec
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "gown.obj"
        path.write_text(
            "".join("v {} {} {}\n".format(*v) for v in vertices)
            + "".join("f {} {} {}\n".format(*(f + 1)) for f in GOWN.faces)
        )
        cloth = client.loadSoftBody(
            str(path),
            mass=spec.mass,
            useMassSpring=1,
            useBendingSprings=1,
            useNeoHookean=0,
            springElasticStiffness=spec.elastic,
            springDampingStiffness=spec.damping,
            springDampingAllDirections=1,
            springBendingStiffness=spec.bending,
            frictionCoeff=spec.friction,
            collisionMargin=0.006,
        )
    for pin in pins:
        client.createSoftBodyAnchor(cloth, int(pin), -1, -1)
    for _ in range(int(seconds / 0.002)):
        client.stepSimulation()
    settled = np.array(client.getMeshData(cloth, -1, flags=pybullet.MESH_DATA_SIMULATION_MESH)[1])
    client.disconnect()
    return settled


@dataclass
class Scene:
    """A renderer and what is true in it."""

    renderer: Renderer
    look: Appearance
    camera: np.ndarray
    gown: GownMesh = GOWN
    vertices: np.ndarray | None = None
    arms: dict = field(default_factory=dict)
    scale: float = 1.0
    hand: np.ndarray = field(default_factory=lambda: np.eye(4))

    def frame(self, seed: int = 0, stamp: float = 0.0) -> Frame:
        rgb, depth = self.renderer.photograph("head", self.camera, np.random.default_rng(seed))
        return Frame(
            camera="head",
            stamp=stamp,
            rgb=rgb,
            depth=depth,
            intrinsics=camera_intrinsics("head"),
            pose_camera_in_map=self.camera,
        )

    def dress(self, vertices: np.ndarray) -> None:
        self.vertices = vertices
        self.renderer.set_cloth(vertices, GOWN.faces, *gown_colours(GOWN, self.look))

    def distance_to_cloth(self, point: np.ndarray) -> float:
        """From a point to the gown's surface, by sampling its faces [m]."""
        shares = np.array([(1 - u - v, u, v) for u in np.linspace(0, 1, 9) for v in np.linspace(0, 1 - u, 9)])
        samples = np.einsum("bk,fkd->fbd", shares, self.vertices[GOWN.faces])
        return float(np.linalg.norm(samples - point, axis=-1).min())


class Scenes:
    """Builds scenes by seed; shapes of cloth are settled once."""

    def __init__(self) -> None:
        self._shapes: dict = {}

    def _shape(self, key, make):
        if key not in self._shapes:
            self._shapes[key] = make()
        return self._shapes[key]

    def room(self, seed: int, camera: np.ndarray) -> Scene:
        look = draw_appearance(np.random.default_rng(seed))
        renderer = Renderer(look.light)
        colours = look.colours
        renderer.add_rigid("floor", *box_mesh((-4, -4, -0.1), (4, 4, 0)), colours["floor"])
        walls = [
            box_mesh((-4, 3, 0), (4, 3.1, 2.6)),
            box_mesh((-4, -3.1, 0), (4, -3, 2.6)),
            box_mesh((-3.1, -4, 0), (-3, 4, 2.6)),
            box_mesh((3, -4, 0), (3.1, 4, 2.6)),
        ]
        renderer.add_rigid("walls", *join_meshes(walls), colours["wall"])
        renderer.add_rigid("bed", *box_mesh(*BED), colours["sheet"])
        return Scene(renderer=renderer, look=look, camera=camera)

    def _hanging(self, pin: int, shape: int) -> np.ndarray:
        """The gown hung by a vertex, which is the origin."""

        def make():
            rng = np.random.default_rng(shape)
            v = (GOWN.vertices - GOWN.vertices[pin]) @ turned(rng.uniform(0, 2 * np.pi)).T
            pins = np.argsort(np.linalg.norm(GOWN.vertices - GOWN.vertices[pin], axis=1))[:2]
            v = settle(v + rng.normal(0, 0.002, v.shape), pins=pins)
            return v - v[pins].mean(axis=0)

        return self._shape(("hanging", pin, shape), make)

    def on_rail(self, seed: int) -> Scene:
        rng = np.random.default_rng(seed)
        hook = np.array((1.6, 1.4, 1.53))
        eye = np.array((1.6 + rng.uniform(-0.1, 0.1), 0.3, 1.55))
        scene = self.room(seed, looking_at(eye, hook - (0, 0, 0.4)))
        rail = join_meshes(
            [
                cylinder_mesh((1.0, 1.4, 1.55), (2.2, 1.4, 1.55), 0.015),
                cylinder_mesh((1.0, 1.4, 0), (1.0, 1.4, 1.55), 0.02),
                cylinder_mesh((2.2, 1.4, 0), (2.2, 1.4, 1.55), 0.02),
            ]
        )
        scene.renderer.add_rigid("rail", *rail, scene.look.colours["rail"])
        pin = int(GOWN.collar[3 + seed % 2 * 6])
        scene.dress(self._hanging(pin, seed % 2) + hook)
        scene.hand[:3, 3] = hook
        return scene

    def in_hand(self, seed: int, turn: float = 0.0) -> Scene:
        """Hung from a gripper that has turned by `turn` about the vertical, head camera 0.7 m away."""
        eye = np.array((1.9, -0.3, 1.6))
        scene = self.room(seed, looking_at(eye, eye + np.array((-np.cos(0.55), 0, -np.sin(0.55)))))
        pin = int(GOWN.collar[(4, 0, 9, 14)[seed % 4]])
        scene.hand[:3, :3], scene.hand[:3, 3] = turned(turn), (1.2, -0.3, 1.45)
        scene.dress(self._hanging(pin, seed % 4) @ turned(turn).T + scene.hand[:3, 3])
        colours = scene.look.colours
        scene.renderer.add_rigid("palm", *box_mesh((1.15, -0.42, 1.40), (1.25, -0.34, 1.50)), colours["robot_grey"])
        scene.renderer.add_rigid("limb", *capsule_mesh((1.2, -0.45, 1.45), (1.2, -0.9, 1.45), 0.05), colours["robot"])
        return scene

    def stretched(self, seed: int, outside: bool) -> Scene:
        """Held by both collar corners in front of the head camera."""

        def make():
            v = GOWN.vertices * (0.96, 1, 1) + np.random.default_rng(1).normal(0, 0.002, GOWN.vertices.shape)
            return settle(v, pins=GOWN.corners, seconds=1.6)

        eye = np.array((1.9, -0.3, 1.6))
        scene = self.room(seed, looking_at(eye, eye + np.array((-np.cos(0.5), 0, -np.sin(0.5)))))
        v = self._shape("stretched", make) @ turned(-np.pi / 2 if outside else np.pi / 2).T
        corners = v[list(GOWN.corners)]
        scene.dress(v - corners.mean(axis=0) + (1.05, -0.3, 1.45))
        return scene

    def person(self, seed: int, lift: float = 0.0) -> Scene:
        """A person without gown; the right arm is lifted at the shoulder by `lift` [rad]."""
        scene = self.room(seed, BEDSIDE)
        self._add_person(scene, seed, lift)
        return scene

    def lying(self, seed: int) -> Scene:
        """The gown laid outside up over the person, settled."""
        scene = self.room(seed, BEDSIDE)
        capsules = self._add_person(scene, seed, 0.0)

        def make():
            rng = np.random.default_rng(seed)
            g = GOWN.vertices
            v = np.stack(
                [g[:, 0] + rng.uniform(-0.05, 0.05), -g[:, 2] - rng.uniform(0.58, 0.66), 0.9 * g[:, 1] + 0.86], axis=1
            )
            return settle(v + rng.normal(0, 0.003, v.shape), capsules=capsules, boxes=[BED], seconds=0.8)

        scene.dress(self._shape(("lying", seed), make))
        return scene

    def _add_person(self, scene: Scene, seed: int, lift: float) -> list:
        rng = np.random.default_rng(1000 + seed)
        s = scene.scale = float(rng.uniform(0.94, 1.04))
        top = BED[1, 2]
        trunk, legs = [((0, -0.55 - 0.08 * s, top + 0.11 * s), (0, -0.55 - 0.22 * s, top + 0.12 * s), 0.09 * s)], []
        for sign in (-1, 1):
            trunk.append(((sign * 0.09 * s, -0.5 * s, top + 0.11 * s), (sign * 0.09 * s, 0, top + 0.11 * s), 0.11 * s))
            legs.append(
                ((sign * 0.1 * s, 0.02 * s, top + 0.08 * s), (sign * 0.12 * s, 0.8 * s, top + 0.06 * s), 0.075 * s)
            )
        limbs = []
        for side, sign in (("left", -1), ("right", 1)):
            abduction, bend = rng.uniform(0.45, 0.87), rng.uniform(0.1, 1.0)
            points = [np.array((sign * 0.2 * s, -0.55, top + 0.1))]
            for length, angle, slope in (
                (0.28, abduction, -0.12),
                (0.25, abduction - bend, -0.05),
                (0.17, abduction - bend, -0.05),
            ):
                way = np.array((sign * np.sin(angle), np.cos(angle), 0))
                points.append(points[-1] + length * s * (np.cos(slope) * way + np.sin(slope) * np.array((0, 0, 1))))
            arm = np.array(points)
            for k, radius in ((1, 0.041), (2, 0.036), (3, 0.03)):
                arm[k, 2] = max(arm[k, 2], top + radius)
            if side == "right" and lift:
                axis = np.cross(arm[1] - arm[0], (0, 0, 1))
                x, y, z = axis / np.linalg.norm(axis)
                cross = np.array(((0, -z, y), (z, 0, -x), (-y, x, 0)))
                rotation = np.eye(3) + np.sin(lift) * cross + (1 - np.cos(lift)) * cross @ cross
                arm = arm[0] + (arm - arm[0]) @ rotation.T
            scene.arms[side] = arm
            limbs += [(arm[k], arm[k + 1], RADII[k] * s) for k in range(3)]
        colours = scene.look.colours
        body = join_meshes([capsule_mesh(*c) for c in trunk + limbs])
        scene.renderer.add_rigid("person", *body, colours["skin"])
        scene.renderer.add_rigid("legs", *join_meshes([capsule_mesh(*c) for c in legs]), colours["shorts"])
        return trunk + limbs + legs


@pytest.fixture(scope="session")
def scenes() -> Scenes:
    return Scenes()


@pytest.fixture(scope="session")
def bed() -> np.ndarray:
    return BED


@pytest.fixture
def black() -> Frame:
    """A camera that works and sees nothing at all."""
    width, height = HEAD_SIZE
    return Frame(
        camera="head",
        stamp=1.0,
        rgb=np.zeros((height, width, 3), np.uint8),
        depth=np.zeros((height, width), np.float32),
        intrinsics=camera_intrinsics("head"),
        pose_camera_in_map=BEDSIDE,
    )
