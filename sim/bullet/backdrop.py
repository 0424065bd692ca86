"""What the cameras see of a scene: room, bed, rail, person, robot and gown as triangles with colours."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

import numpy as np

from ..mechanics.kinematics import Kinematics
from ..render.appearance import Appearance, gown_colours
from ..render.camera import Renderer
from ..render.diorama import Diorama, Furniture, along
from ..render.solids import box_mesh, capsule_mesh, cylinder_mesh, sphere_mesh
from ..robot.visual import meshes_of
from ..scene.person_spec import ARM_SEGMENTS, Capsule
from ..scene.scene import BED_HALF, BED_THICKNESS, BED_TOP, RAIL_HEIGHT, Scene


class Lying(Protocol):
    """What is drawn of a person: `Person` has it."""

    @property
    def trunk(self) -> Mapping[str, Capsule]:
        """Ends and radius of every capsule but the arms', by name [m]."""
        ...

    def radii(self) -> np.ndarray:
        """(2, 3) of the arms' segments [m]."""
        ...

    def arms(self) -> np.ndarray:
        """(2, 4, 3) shoulder, elbow, wrist, fingertip [m]."""
        ...


class Backdrop:
    """Keeps a `Renderer` in step with the bodies of one world.

    Args:
        scene: what was drawn for this run, with its gown.
        look: its colours and light.
        person: the manikin.
        kinematics: of the robot.

    Attributes:
        renderer: what the robot's cameras are drawn from.
        diorama: what people watch.
    """

    def __init__(self, scene: Scene, look: Appearance, person: Lying, kinematics: Kinematics) -> None:
        self.renderer, self.person, self.kinematics = Renderer(look.light, look.on_cloth), person, kinematics
        self._colours = look.colours
        self._room(scene)
        self._body(scene)
        meshes = meshes_of(kinematics.robot)
        for name, (vertices, faces, rgb) in meshes.items():
            colour = 255.0 * np.asarray(rgb) * look.tint
            self.renderer.add_rigid(f"robot_{name}", vertices, faces, colour)
        self._links = list(meshes)
        self.renderer.set_cloth(scene.mesh.vertices, scene.mesh.faces, *gown_colours(scene.mesh, look))
        furniture = Furniture(bed_xy=scene.bed_xy, bed_top=BED_TOP, rail=(*scene.rail_xy, RAIL_HEIGHT))
        lengths = np.tile(scene.person.arm_lengths, (2, 1))
        self.diorama = Diorama(look, furniture, person.trunk, person.radii(), lengths)

    def add(self, name: str, vertices: np.ndarray, faces: np.ndarray, colour: object) -> None:
        """Show an object: vertices (V, 3) in the map [m], triangles (F, 3), red, green and blue."""
        self.renderer.add_rigid(f"object_{name}", vertices, faces, colour)

    def update(
        self,
        vertices: np.ndarray,
        arms: np.ndarray,
        configuration: np.ndarray,
        objects: Mapping[str, np.ndarray] | None = None,
    ) -> Renderer:
        """Move everything to where it is; returns the renderer, ready to draw.

        Args:
            vertices: (V, 3) of the gown [m].
            arms: (2, 4, 3) of the person [m].
            configuration: (nq,) of the robot.
            objects: name -> (V, 3) of what a task has added [m].
        """
        self.renderer.move_cloth(vertices)
        for name, moved in (objects or {}).items():
            self.renderer.move_vertices(f"object_{name}", moved)
        for arm in range(2):
            for part in range(len(ARM_SEGMENTS)):
                self.renderer.set_pose(f"arm{arm}{part}", along(arms[arm, part], arms[arm, part + 1]))
        poses = self.kinematics.link_poses(configuration)
        for name in self._links:
            self.renderer.set_pose(f"robot_{name}", poses[name])
        return self.renderer

    def _room(self, scene: Scene) -> None:
        add, colour = self.renderer.add_rigid, self._colours
        add("floor", *box_mesh(np.array((-3.0, -3.0, -0.05)), np.array((4.0, 3.5, 0.0))), colour["floor"])
        add("wall_back", *box_mesh(np.array((-3.0, 3.5, 0.0)), np.array((4.0, 3.55, 2.6))), colour["wall"])
        add("wall_side", *box_mesh(np.array((-3.05, -3.0, 0.0)), np.array((-3.0, 3.5, 2.6))), colour["wall"])
        middle = np.array((*scene.bed_xy, 0.0))
        half = np.array((*BED_HALF, 0.0))
        for name, low, high, tint in (
            ("mattress", BED_TOP - 0.09, BED_TOP, "sheet"),
            ("bed_frame", BED_TOP - BED_THICKNESS, BED_TOP - 0.09, "bed_frame"),
        ):
            add(name, *box_mesh(middle - half + (0, 0, low), middle + half + (0, 0, high)), colour[tint])
        for k, (x, y) in enumerate(((-0.3, -0.9), (0.3, -0.9), (-0.3, 0.9), (0.3, 0.9))):
            foot = middle + (x, y, 0.0)
            add(f"bed_leg{k}", *cylinder_mesh(foot, foot + (0, 0, BED_TOP - BED_THICKNESS), 0.03), colour["bed_frame"])
        x, y = scene.rail_xy
        bar = RAIL_HEIGHT + 0.05
        ends = np.array(((x - 0.8, y + 0.03, bar), (x + 0.8, y + 0.03, bar)))
        add("rail_bar", *cylinder_mesh(ends[0], ends[1], 0.015), colour["rail"])
        for k, end in enumerate((-0.8, 0.8)):
            foot = np.array((x + end, y + 0.03, 0.0))
            add(f"rail_post{k}", *cylinder_mesh(foot, foot + (0, 0, bar), 0.02), colour["rail"])
        hook = np.array((x, y, RAIL_HEIGHT))
        add("hook", *cylinder_mesh(hook, hook + (0, 0.03, 0.05), 0.008), colour["rail"])

    def _body(self, scene: Scene) -> None:
        add, skin = self.renderer.add_rigid, self._colours["skin"]
        legs = {name: capsule for name, capsule in self.person.trunk.items() if name.startswith("leg")}
        for name, capsule in self.person.trunk.items():
            if name not in legs:
                add(name, *capsule_mesh(*capsule), skin)
        for name, (a, b, radius) in legs.items():
            knee = a + 0.45 * (b - a)
            add(f"{name}_thigh", *capsule_mesh(a, knee, radius * 1.01), self._colours["shorts"])
            add(f"{name}_shin", *capsule_mesh(knee, b, radius), skin)
        bed = np.array((*scene.bed_xy, BED_TOP))
        add("pillow", *box_mesh(bed + (-0.25, -0.98, 0.0), bed + (0.25, -0.66, 0.03)), self._colours["sheet"])
        lengths = scene.person.arm_lengths
        for arm in range(2):
            radii = self.person.radii()[arm]
            for part in range(len(ARM_SEGMENTS)):
                tip = np.array((0.0, 0.0, lengths[part]))
                add(f"arm{arm}{part}", *capsule_mesh(np.zeros(3), tip, radii[part]), skin)
            add(f"shoulder{arm}", *sphere_mesh(self.person.arms()[arm, 0], radii[0] * 1.15), skin)
