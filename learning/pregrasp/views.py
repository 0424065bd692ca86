"""Six pictures around a gown that hangs from one hand, as the robot's camera delivers them, cropped to the gown."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sim.render.camera import CLOTH_ID, Renderer, looking_at
from ...sim.render.looks import FABRICS
from ...sim.render.raster import Light, add_sensor_noise
from .hung_state import HungState
from .numbers import VIEWS, ViewNumbers


@dataclass(frozen=True, kw_only=True)
class Views:
    """The six pictures.

    Attributes:
        rgb: (6, H, W, 3) uint8.
        depth: (6, H, W) along the optical axis [m], 0 where the gown does not show.
        numbers: of the cameras.
    """

    rgb: np.ndarray
    depth: np.ndarray
    numbers: ViewNumbers = VIEWS

    def place(self, view: int, row: int, column: int) -> np.ndarray:
        """(3,) what a pixel shows, in the frame of the holding hand [m].

        Raises:
            ValueError: nothing of the gown.
        """
        depth = float(self.depth[view, row, column])
        if depth <= 0.0:
            raise ValueError(f"pixel ({row}, {column}) of view {view + 1} shows nothing of the gown")
        fx, fy, cx, cy = lens(self.numbers)
        ray = np.array(((column - cx) / fx, (row - cy) / fy, 1.0))
        pose = camera_pose(view, self.numbers)
        return pose[:3, 3] + depth * (pose[:3, :3] @ ray)

    def pixel(self, view: int, place: np.ndarray) -> tuple[int, int]:
        """(row, column) in which a place (3,) of the hand's frame [m] lies; it may be outside of the picture."""
        fx, fy, cx, cy = lens(self.numbers)
        pose = camera_pose(view, self.numbers)
        x, y, z = pose[:3, :3].T @ (place - pose[:3, 3])
        return round(fy * y / z + cy), round(fx * x / z + cx)


def direction_of(view: int, numbers: ViewNumbers = VIEWS) -> np.ndarray:
    """(3,) level unit vector along which a view looks."""
    angle = view * numbers.turn
    return np.array((np.cos(angle), np.sin(angle), 0.0))


def approach_of(view: int, yaw: float, numbers: ViewNumbers = VIEWS) -> np.ndarray:
    """(3,) level unit vector, turned from the view's by `yaw` [rad]."""
    angle = view * numbers.turn + yaw
    return np.array((np.cos(angle), np.sin(angle), 0.0))


def lens(numbers: ViewNumbers = VIEWS) -> tuple[float, float, float, float]:
    """(fx, fy, cx, cy) [px]."""
    focal = numbers.distance / numbers.pixel
    return focal, focal, (numbers.width - 1) / 2, (numbers.height - 1) / 2


def camera_pose(view: int, numbers: ViewNumbers = VIEWS) -> np.ndarray:
    """(4, 4) of a view's camera, optical frame, in the frame of the holding hand."""
    middle = np.array((0.0, 0.0, numbers.above - numbers.height * numbers.pixel / 2))
    return looking_at(middle - numbers.distance * direction_of(view, numbers), middle)


def photograph(state: HungState, numbers: ViewNumbers = VIEWS) -> Views:
    """Six pictures of a state, in a colour and under a light that its seed draws, with the noise of a camera."""
    rng = np.random.default_rng([state.seed, 16])
    colour = np.array(FABRICS[str(rng.choice(list(FABRICS)))], float)
    inside = 255.0 - (255.0 - colour) * (1.0 if rng.random() < 0.5 else rng.uniform(0.5, 1.0))
    lamp = np.array((*rng.normal(0.0, 0.5, 2), 1.0))
    renderer = Renderer(Light(direction_in_map=lamp / np.linalg.norm(lamp)))
    faces = state.faces
    renderer.add_rigid("nothing", np.full((3, 3), (0.0, 0.0, 90.0)), np.array([[0, 1, 2]]), (0, 0, 0))
    renderer.set_cloth(state.vertices, faces, np.tile(colour, (len(faces), 1)), np.tile(inside, (len(faces), 1)))
    rgbs, depths = [], []
    for view in range(numbers.views):
        picture = renderer.render(camera_pose(view, numbers), (numbers.width, numbers.height), lens(numbers))
        rgb, depth = add_sensor_noise(picture, rng)
        depths.append(np.where(picture.ids == CLOTH_ID, depth, 0.0))
        rgbs.append(rgb)
    return Views(rgb=np.stack(rgbs), depth=np.stack(depths).astype(np.float32), numbers=numbers)
