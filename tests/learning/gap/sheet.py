"""A square sheet of light cloth with nothing about it, for searches that never simulate it."""

import numpy as np
from caretree.learning.gap.cloth.scene import ClothScene, Physics

VERTICES = np.array([(0.07 * i, 0.0, -0.07 * j) for j in range(7) for i in range(7)])


def plain_sheet() -> ClothScene:
    physics = Physics(
        mass=0.1,
        elastic_stiffness=40.0,
        damping_stiffness=0.005,
        bending_stiffness=0.1,
        friction=0.4,
        gravity=(0.0, 0.0, -9.81),
        time_step=0.002,
    )
    return ClothScene(
        vertices=VERTICES, faces=np.zeros((0, 3), int), physics=physics, capsules=np.zeros((0, 7)), markers=(0, 6)
    )
