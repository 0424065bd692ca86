"""The deformable PyBullet world that every cloth moves in: its parameters are set here and nowhere else.

Four users share it: the dressing world (`world.py`), the recorder of measurement sets (`learning/gap/record.py`), the
gap workflow's prediction (`learning/gap/cloth/simulate.py`) and the clips (`learning/physics/engine/bullet.py`).
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterable, Mapping, Sequence
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np

from .units import PER_SECOND, TimeUnit

GRAVITY = 9.81  # [m/s^2]
MARGIN = 0.006  # collision margin [m]
SOLVER_ITERATIONS = 10  # 10 instead of PyBullet's 50 change nothing that was measured
STABILITY_MAX = 0.7  # elastic * dt^2 / vertex mass: above it the explicit springs explode (measured, FACTS)


class SoftWorld:
    """A PyBullet client of its own with a deformable world, empty at first.

    Args:
        time_step: of the physics [s].
        per_second: the world's units of time in a second.  With 1, plain SI, the solver keeps PyBullet's own settings,
            which are made for seconds, and cloth may fall asleep.
        gravity: (3,) [m/s^2].

    Attributes:
        client: the BulletClient; it speaks in the world's unit of time.
        time_step: of the physics [s].
        unit: converts between SI and the world's unit of time.
    """

    def __init__(
        self,
        time_step: float,
        *,
        per_second: float = PER_SECOND,
        gravity: Sequence[float] = (0.0, 0.0, -GRAVITY),
    ) -> None:
        from ..bullet_client import direct_client  # pybullet is loaded only where something is simulated

        self.client: Any = direct_client()
        self.time_step, self.unit = time_step, TimeUnit(per_second)
        self.client.resetSimulation(self.client.RESET_USE_DEFORMABLE_WORLD)
        self.set_gravity(gravity)
        self.client.setPhysicsEngineParameter(numSubSteps=0)  # resetSimulation keeps an old one
        if not self.unit.is_second:
            self.client.setPhysicsEngineParameter(
                numSolverIterations=SOLVER_ITERATIONS, solverResidualThreshold=self.unit.residual
            )
        self.client.setTimeStep(self.unit.time(time_step))

    def set_gravity(self, gravity: Sequence[float]) -> None:
        """Change gravity (3,) [m/s^2]."""
        self.client.setGravity(*(self.unit.force(g) for g in gravity))

    def load_cloth(
        self,
        vertices: np.ndarray,
        faces: np.ndarray,
        *,
        mass: float,
        elastic: float,
        damping: float,
        bending: float,
        friction: float,
        options: Mapping[str, Any] | None = None,
    ) -> int:
        """Load a mass-spring cloth; returns its body.

        Args:
            vertices: (V, 3) rest shape, where it also starts [m].
            faces: (F, 3) triangles whose edges are springs.
            mass: of the whole cloth [kg].
            elastic: stiffness of the springs [N/m].
            damping: of the springs [N s/m].
            bending: stiffness of the bending springs [N/m].
            friction: Coulomb coefficient.
            options: of PyBullet's `loadSoftBody`, to try what they change.
        """
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "cloth.obj"
            path.write_text(
                "".join("v {:.9f} {:.9f} {:.9f}\n".format(*v) for v in vertices)
                + "".join("f {} {} {}\n".format(*(face + 1)) for face in faces)
            )
            settings: dict[str, Any] = {
                "mass": mass,
                "useMassSpring": 1,
                "useBendingSprings": 1,
                "useNeoHookean": 0,
                "springElasticStiffness": self.unit.force(elastic),
                "springDampingStiffness": self.unit.rate(damping),
                "springDampingAllDirections": 1,
                "springBendingStiffness": self.unit.force(bending),
                "useSelfCollision": 0,
                "frictionCoeff": friction,
                "collisionMargin": MARGIN,
            }
            body: int = self.client.loadSoftBody(str(path), **{**settings, **(options or {})})
        if not self.unit.is_second:  # in small units of time everything is slow enough to fall asleep
            self.client.changeDynamics(body, -1, activationState=self.client.ACTIVATION_STATE_DISABLE_SLEEPING)
        return body

    def anchor(self, cloth: int, vertices: Iterable[int], body: int = -1, link: int = -1) -> list[int]:
        """Hold vertices of a cloth to a link, or to the world, where they are now; returns the constraints."""
        return [self.client.createSoftBodyAnchor(cloth, int(k), body, link) for k in vertices]

    def release(self, constraints: Iterable[int]) -> None:
        """Let anchored vertices go."""
        for constraint in constraints:
            self.client.removeConstraint(constraint)

    def vertices(self, cloth: int) -> np.ndarray:
        """(V, 3) where the vertices of a cloth are now [m]."""
        count, data = self.client.getMeshData(cloth, -1, flags=self.client.MESH_DATA_SIMULATION_MESH)
        return np.fromiter(chain.from_iterable(data), float, 3 * count).reshape(count, 3)  # half the time of np.array

    def step(self) -> None:
        """Pass one time step."""
        self.client.stepSimulation()

    def close(self) -> None:
        """End the client."""
        self.client.disconnect()
