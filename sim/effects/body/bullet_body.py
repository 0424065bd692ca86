"""A PyBullet body with the effects of a model file, applied as external forces before every step.

Joint effects act as opposite torques on the two links of a joint, so the body's own motors are left alone.  A free
body feels drag, lift and wind at its centre.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..effect import EffectError, JointMotion
from ..joint.arm_geometry import GEOMETRY
from ..joint.joint_registry import JOINT_EFFECTS
from ..joint.link_inertia import BODY_TERMS
from ..model_file import EffectModel
from .body_registry import BODY_EFFECTS


class EffectBody:
    """Effects on one body of a PyBullet client; call `apply` before every step.

    Attributes:
        client: the pybullet module or a bullet_client.
        body: unique id.
    """

    def __init__(self, client: Any, body: int, effects: EffectModel, gravity: float = 9.81) -> None:
        """Find the joints and change masses.

        Raises:
            EffectError: a target does not exist on this body.
        """
        self.client, self.body, self.gravity = client, body, gravity
        self._free: list[tuple[str, dict[str, float]]] = []
        self._joints: list[tuple[str, int, int, np.ndarray, bool, dict[str, float]]] = []
        if effects.system == "fall":
            self._free = [(e.name, e.parameters) for e in effects.effects]
            return
        if effects.system not in ("arm", "axis"):
            raise EffectError(
                f"the model file is for system '{effects.system}', a PyBullet body takes arm, axis or fall"
            )
        info = [client.getJointInfo(body, j) for j in range(client.getNumJoints(body))]
        by_name = {i[1].decode(): i for i in info}
        movable = [i for i in info if i[2] in (client.JOINT_REVOLUTE, client.JOINT_PRISMATIC)]
        for e in (*effects.effects, *effects.recalibration):
            if e.name in GEOMETRY:
                raise EffectError(f"a PyBullet body cannot have {e.name}: load it turned so, or read its joints so")
            found = movable[0] if e.target == "axis" and movable else by_name.get(e.target)
            if found is None:
                raise EffectError(f"the body has no joint '{e.target}', it has {', '.join(by_name)}")
            j = found[0]
            if e.name in (*BODY_TERMS, "mass"):
                mass = client.getDynamicsInfo(body, j)[0]
                client.changeDynamics(body, j, mass=max(mass + e.parameters["mass"], 1e-4))
            elif JOINT_EFFECTS[e.name].memoryless:
                self._joints.append(
                    (e.name, j, found[16], np.array(found[13]), found[2] == client.JOINT_PRISMATIC, e.parameters)
                )

    def apply(self) -> None:
        """Apply this step's forces."""
        p = self.client
        if self._free:
            position, _ = p.getBasePositionAndOrientation(self.body)
            velocity = np.array(p.getBaseVelocity(self.body)[0])
            mass = p.getDynamicsInfo(self.body, -1)[0]
            force = sum(BODY_EFFECTS[n].specific_force(velocity, v, self.gravity) for n, v in self._free) * mass
            p.applyExternalForce(self.body, -1, list(force), position, p.WORLD_FRAME)
        for name, joint, parent, axis, prismatic, values in self._joints:
            q, dq = p.getJointState(self.body, joint)[:2]
            load = float(JOINT_EFFECTS[name].load(JointMotion.instant(q=q, dq=dq), values)[0])
            self._push(joint, parent, axis, prismatic, -load)

    def _push(self, joint: int, parent: int, axis: np.ndarray, prismatic: bool, load: float) -> None:
        p = self.client
        state = p.getLinkState(self.body, joint)
        # world axis from the joint frame; torques are given in the world frame because the link frame is the inertia's
        world = np.array(p.getMatrixFromQuaternion(state[5])).reshape(3, 3) @ axis
        if prismatic:
            p.applyExternalForce(self.body, joint, list(world * load), state[0], p.WORLD_FRAME)
            if parent >= 0:
                p.applyExternalForce(self.body, parent, list(-world * load), state[0], p.WORLD_FRAME)
        else:
            p.applyExternalTorque(self.body, joint, list(world * load), p.WORLD_FRAME)
            if parent >= 0:
                p.applyExternalTorque(self.body, parent, list(-world * load), p.WORLD_FRAME)
