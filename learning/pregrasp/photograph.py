"""Six pictures of a gown that hangs from one hand, drawn from its vertices, with or without the other hand."""

from __future__ import annotations

import numpy as np

from ...sim.pregrasp.numbers import ACTION, VIEWS, ViewNumbers
from ...sim.pregrasp.views import Views, camera_pose, lens
from ...sim.render.camera import CLOTH_ID, Renderer
from ...sim.render.camera_noise import add_sensor_noise
from ...sim.render.looks import FABRICS
from ...sim.render.raster import Light
from ...sim.render.solids import box_mesh
from ...sim.robot.hand_boxes import local_boxes
from .hung_state import HungState

HAND_COLOUR = (60, 60, 60)


def photograph(state: HungState, numbers: ViewNumbers = VIEWS, *, hand: np.ndarray | None = None) -> Views:
    """Six pictures of a state, in a colour and under a light that its seed draws, with the noise of a camera.

    Args:
        state: the gown; its vertices may have been moved since it hung.
        numbers: of the pictures.
        hand: (4, 4) of the other hand, whose open fingers and palm hide some of the gown; None is far away.
    """
    rng = np.random.default_rng([state.seed, 16])
    colour = np.array(FABRICS[str(rng.choice(list(FABRICS)))], float)
    inside = 255.0 - (255.0 - colour) * (1.0 if rng.random() < 0.5 else rng.uniform(0.5, 1.0))
    lamp = np.array((*rng.normal(0.0, 0.5, 2), 1.0))
    renderer = Renderer(Light(direction_in_map=lamp / np.linalg.norm(lamp)))
    faces = state.faces
    if hand is None:
        renderer.add_rigid("nothing", np.full((3, 3), (0.0, 0.0, 90.0)), np.array([[0, 1, 2]]), (0, 0, 0))
    else:
        for k, (middle, half) in enumerate(zip(*local_boxes(ACTION.opening), strict=True)):
            renderer.add_rigid(f"box {k}", *box_mesh(middle - half, middle + half), HAND_COLOUR)
            renderer.set_pose(f"box {k}", hand)
    renderer.set_cloth(state.vertices, faces, np.tile(colour, (len(faces), 1)), np.tile(inside, (len(faces), 1)))
    rgbs, depths = [], []
    for view in range(numbers.views):
        picture = renderer.render(
            camera_pose(view * numbers.turn, numbers), (numbers.width, numbers.height), lens(numbers)
        )
        rgb, depth = add_sensor_noise(picture, rng)
        depths.append(np.where(picture.ids == CLOTH_ID, depth, 0.0))
        rgbs.append(rgb)
    return Views(rgb=np.stack(rgbs), depth=np.stack(depths).astype(np.float32), numbers=numbers)
