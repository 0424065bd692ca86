"""Forward simulation in short windows: start from the measured state, apply the measured load, see where it ends up.

A joint under load control drifts away from any log within a second, so a long rollout says nothing about a small
effect.  Windows restarted from the log do.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ....sim.effects.effect import JointMotion
from ....sim.effects.joint.joint_registry import JOINT_EFFECTS
from .block import Block
from .log import JointLog
from .rigid import RigidModel

WINDOW = 0.3  # [s]
WINDOWS = 16


@dataclass(frozen=True, kw_only=True)
class PatchedJoints:
    """A rigid model with the effects that depend on the instant alone."""

    model: RigidModel
    effects: tuple[tuple[str, int, dict[str, float]], ...]
    slow: np.ndarray

    def acceleration(
        self, q: np.ndarray, dq: np.ndarray, ddq: np.ndarray, rigid: np.ndarray, load: np.ndarray
    ) -> np.ndarray:
        """Acceleration under a measured load; `ddq` and `rigid` are of the step before."""
        left = load.copy()
        for name, joint, values in self.effects:
            now = JointMotion(
                t=np.zeros(1),
                q=q[joint : joint + 1],
                dq=dq[joint : joint + 1],
                ddq=ddq[joint : joint + 1],
                load=rigid[joint : joint + 1],
                measured=load[joint : joint + 1],
                slow=float(self.slow[joint]),
            )
            left[joint] -= JOINT_EFFECTS[name].load(now, values)[0]
        return self.model.acceleration(q, dq, left)


def patched_joints(model: RigidModel, blocks: tuple[Block, ...], theta: np.ndarray, slow: np.ndarray) -> PatchedJoints:
    """Put named blocks into the model: body terms into its inertias, joint effects beside it."""
    effects, at = [], 0
    for block in blocks:
        values = {
            p.name: float(v) for p, v in zip(block.parameters, theta[at : at + len(block.parameters)], strict=True)
        }
        at += len(block.parameters)
        if block.term is not None:
            model = model.patched(block.term, values)
        elif block.name == "armature":
            model = model.with_armature(block.channels[0], values["inertia"])
        elif JOINT_EFFECTS[block.name].memoryless:
            effects.append((block.name, block.channels[0], {**values, **block.shape}))
    return PatchedJoints(model=model, effects=tuple(effects), slow=slow)


def acting(blocks: Sequence[Block], theta: np.ndarray, log: JointLog) -> tuple[tuple[Block, ...], np.ndarray]:
    """Blocks that act in most of a log, and their numbers: one model stands for all of its windows."""
    kept, numbers, at = [], [], 0
    for block in blocks:
        n = len(block.parameters)
        during = None if block.term is None else block.term.during
        if during is None or during.acts(log.name, log.t).mean() > 0.5:
            kept.append(block)
            numbers.append(theta[at : at + n])
        at += n
    return tuple(kept), np.concatenate(numbers) if numbers else np.zeros(0)


def rollout_gap(patched: PatchedJoints, log: JointLog) -> np.ndarray:
    """Root mean square position error over windows, per joint (n,) [m or rad]."""
    steps = max(3, round(WINDOW / log.dt))
    starts = np.linspace(log.trim, len(log.t) - log.trim - steps - 1, WINDOWS).astype(int)
    total = np.zeros(log.q.shape[1])
    for s in starts:
        q, dq = log.q[s].copy(), log.dq[s].copy()
        ddq, rigid = log.ddq[s].copy(), log.rigid[s].copy()
        fine = max(1, int(np.ceil(log.dt / 0.004)))
        h = log.dt / fine
        for k in range(steps):
            for j in range(fine):
                load = log.measured[s + k] + (log.measured[s + k + 1] - log.measured[s + k]) * j / fine
                ddq = np.clip(patched.acceleration(q, dq, ddq, rigid, load), -1e3, 1e3)
                dq = dq + h * ddq
                q = q + h * dq
            rigid = log.rigid[s + k]
            total += (q - log.q[s + k + 1]) ** 2
    return np.sqrt(total / (len(starts) * steps))
