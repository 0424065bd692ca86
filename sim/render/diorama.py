"""The room as people watch it, in the video, live and in a replay: closed walls, bed, rail, person, robot and gown."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from .appearance import Appearance
from .camera import Renderer
from .manikin import Capsule, arm_parts, lying_parts
from .raster import Light
from .solids import box_mesh, capsule_mesh, cylinder_mesh

ROOM_LOW, ROOM_HIGH = np.array((-3.0, -3.0, 0.0)), np.array((4.0, 3.5, 2.7))  # [m]
LAMP = np.array((0.30, -0.38, 0.87))  # towards the lamp that people watch by; the robot's cameras have another
TINTS = {"hair": (58, 42, 34), "eyes": (38, 36, 40), "lips": (150, 78, 76), "skirting": (190, 186, 178)}
TINTS |= {"window": (206, 228, 244), "frame": (240, 240, 238), "board": (172, 140, 104)}
FOLLOWED = ("robot_", "object_")  # begins of the names of what moves
BED_HALF = np.array((0.50, 1.00))  # as in the scene [m]


@dataclass(frozen=True, kw_only=True)
class Furniture:
    """Where things stand.

    Attributes:
        bed_xy: middle of the bed [m].
        bed_top: height of the mattress [m].
        rail: the hook (3,) [m]; None where there is none.
    """

    bed_xy: tuple[float, float]
    bed_top: float
    rail: tuple[float, float, float] | None = None


class Diorama:
    """Keeps a `Renderer` of everything that people watch.

    Args:
        look: colours of this run.
        furniture: where bed and rail stand.
        trunk: the person without the arms, name -> end, end, radius [m].
        arm_radii: (2, 3) of upper arm, forearm and hand [m].
        arm_lengths: (2, 3) of the same [m].

    Attributes:
        renderer: ready to draw, or to be shown in a browser.
        shell: ids of the bodies that close the room: they throw no shadow.
    """

    def __init__(
        self,
        look: Appearance,
        furniture: Furniture,
        trunk: Mapping[str, Capsule],
        arm_radii: np.ndarray,
        arm_lengths: np.ndarray,
    ) -> None:
        light: Light = replace(look.light, direction_in_map=LAMP / np.linalg.norm(LAMP), intensity=1.3, ambient=0.62)
        self.renderer = Renderer(light)
        self.shell: tuple[int, ...] = ()
        self._colours = {**look.colours, **TINTS}
        self._room()
        self._bed(furniture)
        if furniture.rail is not None:
            self._rail(*furniture.rail)
        for name, mesh, colour in lying_parts(trunk):
            self._add(name, mesh, colour)
        for arm in range(2):
            for part, mesh in enumerate(arm_parts(list(arm_radii[arm]), list(arm_lengths[arm]), arm)):
                self._add(f"arm{arm}{part}", mesh, "skin")

    def follow(self, seen: Renderer) -> Renderer:
        """Bring robot, objects, arms and cloth to where they are in what the robot's cameras are drawn from."""
        for body in seen.bodies():
            if body.name.startswith(FOLLOWED) and body.name not in self.renderer.ids:
                self.renderer.add_rigid(body.name, body.vertices, body.faces, body.colours)
            if body.name.startswith("object_"):  # a sheet changes its shape
                self.renderer.move_vertices(body.name, body.vertices)
            if body.name in self.renderer.ids and body.name.startswith((*FOLLOWED, "arm")):
                self.renderer.set_pose(body.name, body.pose_in_map)
        cloth = seen.cloth
        if cloth is None:
            self.renderer.remove_cloth()
        elif self.renderer.cloth is None:
            self.renderer.set_cloth(*cloth)
        else:
            self.renderer.move_cloth(cloth[0])
        return self.renderer

    def add_capsules(self, names: list[str], capsules: np.ndarray) -> None:
        """Add the robot as capsules (r, 7), ends and radius [m], where its links are not known."""
        for name, capsule in zip(names, capsules, strict=True):
            length = float(np.linalg.norm(capsule[3:6] - capsule[:3]))
            mesh = capsule_mesh(np.zeros(3), np.array((0.0, 0.0, length)), float(capsule[6]))
            self._add(f"link_{name}", mesh, "robot" if "arm" in name or "shoulder" in name else "robot_grey")

    def move_arms(self, arms: np.ndarray) -> None:
        """Bring the person's arms (2, 4, 3) to where they are [m]."""
        for arm in range(2):
            for part in range(3):
                self.renderer.set_pose(f"arm{arm}{part}", along(arms[arm, part], arms[arm, part + 1]))

    def move_capsules(self, names: list[str], capsules: np.ndarray) -> None:
        """Bring the robot's capsules (r, 7) to where they are [m]."""
        for name, capsule in zip(names, capsules, strict=True):
            self.renderer.set_pose(f"link_{name}", along(capsule[:3], capsule[3:6]))

    def _add(self, name: str, mesh: tuple[np.ndarray, np.ndarray], colour: str) -> None:
        self.renderer.add_rigid(name, *mesh, self._colours[colour])

    def _room(self) -> None:
        low, high, thick = ROOM_LOW, ROOM_HIGH, 0.05
        walls = {
            "floor": ((low[0], low[1], -thick), (high[0], high[1], 0.0), "floor"),
            "wall_north": ((low[0], high[1], 0.0), (high[0], high[1] + thick, high[2]), "wall"),
            "wall_south": ((low[0], low[1] - thick, 0.0), (high[0], low[1], high[2]), "wall"),
            "wall_west": ((low[0] - thick, low[1], 0.0), (low[0], high[1], high[2]), "wall"),
            "wall_east": ((high[0], low[1], 0.0), (high[0] + thick, high[1], high[2]), "wall"),
            "ceiling": ((low[0], low[1], high[2]), (high[0], high[1], high[2] + thick), "wall"),
            "skirting_north": ((low[0], high[1] - 0.02, 0.0), (high[0], high[1], 0.12), "skirting"),
            "skirting_south": ((low[0], low[1], 0.0), (high[0], low[1] + 0.02, 0.12), "skirting"),
            "skirting_west": ((low[0], low[1], 0.0), (low[0] + 0.02, high[1], 0.12), "skirting"),
            "skirting_east": ((high[0] - 0.02, low[1], 0.0), (high[0], high[1], 0.12), "skirting"),
            "window_frame": ((-1.9, high[1] - 0.03, 0.95), (0.1, high[1], 2.25), "frame"),
            "window": ((-1.82, high[1] - 0.04, 1.03), (0.02, high[1], 2.17), "window"),
            "door": ((2.3, high[1] - 0.03, 0.0), (3.3, high[1], 2.1), "board"),
        }
        for name, (lower, upper, colour) in walls.items():
            self._add(name, box_mesh(np.array(lower), np.array(upper)), colour)
        self.shell = tuple(self.renderer.ids[name] for name in walls)

    def _bed(self, furniture: Furniture) -> None:
        top = furniture.bed_top
        middle, half = np.array((*furniture.bed_xy, 0.0)), np.array((*BED_HALF, 0.0))
        for name, low, high, tint in (("mattress", -0.09, 0.0, "sheet"), ("bed_frame", -0.12, -0.09, "bed_frame")):
            self._add(name, box_mesh(middle - half + (0, 0, top + low), middle + half + (0, 0, top + high)), tint)
        for k, (x, y) in enumerate(((-0.3, -0.9), (0.3, -0.9), (-0.3, 0.9), (0.3, 0.9))):
            foot = middle + (x, y, 0.0)
            self._add(f"bed_leg{k}", cylinder_mesh(foot, foot + (0, 0, top - 0.12), 0.03), "bed_frame")
        bed = middle + (0.0, 0.0, top)
        self._add("pillow", box_mesh(bed + (-0.25, -0.98, 0.0), bed + (0.25, -0.66, 0.03)), "frame")

    def _rail(self, x: float, y: float, z: float) -> None:
        bar = z + 0.05
        ends = np.array(((x - 0.8, y + 0.03, bar), (x + 0.8, y + 0.03, bar)))
        self._add("rail_bar", cylinder_mesh(ends[0], ends[1], 0.015), "rail")
        for k, end in enumerate((-0.8, 0.8)):
            foot = np.array((x + end, y + 0.03, 0.0))
            self._add(f"rail_post{k}", cylinder_mesh(foot, foot + (0, 0, bar), 0.02), "rail")
        hook = np.array((x, y, z))
        self._add("hook", cylinder_mesh(hook, hook + (0, 0.03, 0.05), 0.008), "rail")


def along(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Pose (4, 4) at `a` with z towards `b`, both (3,)."""
    z = np.asarray(b, float) - a
    z /= max(float(np.linalg.norm(z)), 1e-9)
    x = np.cross((0.0, 1.0, 0.1), z)
    length = float(np.linalg.norm(x))
    x = x / length if length > 1e-9 else np.array((1.0, 0.0, 0.0))
    pose = np.eye(4)
    pose[:3, 0], pose[:3, 1], pose[:3, 2], pose[:3, 3] = x, np.cross(z, x), z, a
    return pose
