"""One state of a room without physics: the gown in its rest shape, upright before the rail, or flat on the bed."""

import numpy as np
from caretree.learning.vision.states import RoomState
from caretree.sim.scene.scene import BED_TOP, draw_scene

ARMS = np.array(
    [[(-0.2, -0.55, 0.7), (-0.4, -0.35, 0.66), (-0.5, -0.12, 0.64), (-0.55, 0.04, 0.63)],
     [(0.2, -0.55, 0.7), (0.4, -0.35, 0.66), (0.5, -0.12, 0.64), (0.55, 0.04, 0.63)]]
)  # fmt: skip


def still_state(kind: str = "hung", seed: int = 110) -> RoomState:
    """A state whose gown is stiff: hung upright with its outside to the robot, or laid with its outside up."""
    scene = draw_scene(seed, "medium", "average")
    rest = scene.mesh.vertices
    if kind == "hung":  # y of the rest shape points out of the outside, the robot stands at smaller y
        placed = rest * (-1.0, -1.0, 1.0) + (*scene.rail_xy, 1.55)
    else:
        placed = np.column_stack([rest[:, 0], -rest[:, 2] - 0.3, BED_TOP + 0.25 + rest[:, 1]])
    return RoomState(
        kind=kind,
        seed=seed,
        gown="medium",
        person="average",
        vertices=placed.astype(np.float32),
        arms=ARMS.astype(np.float32),
        capsules=np.array([[3.5, -2.0, 0.3, 3.5, -2.0, 1.0, 0.2]], np.float32),
        source="test",
    )
