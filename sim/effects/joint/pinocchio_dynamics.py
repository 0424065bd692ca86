"""A pinocchio arm with the effects of a model file: inverse and forward dynamics."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..effect import EffectError, JointMotion
from ..model_file import EffectModel
from .arm_geometry import with_tilted_base
from .joint_registry import JOINT_EFFECTS
from .link_inertia import BODY_TERMS, with_point_mass, with_scaled_mass

if TYPE_CHECKING:
    import pinocchio as pin  # pyright: ignore[reportMissingImports] - lives in a cmeel prefix


class EffectArm:
    """An arm whose bodies and joints carry the effects of a model file.

    Attributes:
        model: the pinocchio model with masses, payload, tool, armature and the way the base stands changed.
    """

    def __init__(self, model: pin.Model, effects: EffectModel, slow: float = 1e-3) -> None:
        """Check every target and change the bodies.

        Raises:
            EffectError: the file is for another system or names a joint this model lacks.
        """
        effects.require("arm")
        self.slow = slow
        for e in effects.recalibration:
            model = with_scaled_mass(model, e.target, e.parameters["mass"])
        self._on_joint: list[tuple[str, int, dict[str, float]]] = []
        armature = np.array(model.armature)
        self._zeros = np.zeros(model.nv)  # what the readings of the joints lack [rad]
        for e in effects.effects:
            if e.name in BODY_TERMS:
                model = with_point_mass(model, e.target, e.parameters)
                continue
            if e.name == "base_tilt":
                model = with_tilted_base(model, e.parameters)
                continue
            if not model.existJointName(e.target):
                raise EffectError(f"the model has no joint '{e.target}', it has {', '.join(list(model.names)[1:])}")
            joint = model.joints[model.getJointId(e.target)].idx_v
            if e.name == "armature":
                armature[joint] += e.parameters["inertia"]
            elif e.name == "encoder_offset":
                self._zeros[joint] += e.parameters["angle"]
            else:
                self._on_joint.append((e.name, joint, e.parameters))
        self.model = model.copy()
        self.model.armature = armature
        self.data = self.model.createData()

    def inverse(self, t: np.ndarray, q: np.ndarray, dq: np.ndarray, ddq: np.ndarray) -> np.ndarray:
        """Loads a sensor would read along a motion, (T, n) [N m]; history-dependent effects included."""
        import pinocchio as pin  # pyright: ignore[reportMissingImports] - lives in a cmeel prefix

        rigid = np.array(
            [pin.rnea(self.model, self.data, self._true(a), b, c) for a, b, c in zip(q, dq, ddq, strict=True)]
        )
        out = rigid.copy()
        for name, j, values in self._on_joint:
            motion = JointMotion(
                t=t, q=q[:, j], dq=dq[:, j], ddq=ddq[:, j], load=rigid[:, j], measured=rigid[:, j], slow=self.slow
            )
            out[:, j] += JOINT_EFFECTS[name].load(motion, values)
        return out

    def forward(self, q: np.ndarray, dq: np.ndarray, load: np.ndarray) -> np.ndarray:
        """Acceleration under a load (n,) [rad/s^2]; effects that need history are left out."""
        import pinocchio as pin  # pyright: ignore[reportMissingImports] - lives in a cmeel prefix

        at = self._true(q)
        rigid = pin.rnea(self.model, self.data, at, dq, np.zeros(self.model.nv))
        left = np.array(load, dtype=float)
        for name, j, values in self._on_joint:
            if JOINT_EFFECTS[name].memoryless:
                left[j] -= _instant(name, values, q[j], dq[j], rigid[j], load[j], self.slow)
        return pin.aba(self.model, self.data, at, dq, left)

    def _true(self, q: np.ndarray) -> np.ndarray:
        """Where the joints are that are read at `q`."""
        import pinocchio as pin  # pyright: ignore[reportMissingImports] - lives in a cmeel prefix

        return pin.integrate(self.model, q, self._zeros) if self._zeros.any() else q


def _instant(name: str, values: dict[str, float], q: float, dq: float, rigid: float, load: float, slow: float) -> float:
    motion = JointMotion.instant(q=q, dq=dq, load=rigid, measured=load, slow=slow)
    return float(JOINT_EFFECTS[name].load(motion, values)[0])
