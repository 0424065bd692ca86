"""Controls that must not help: the same effect on another joint, and the effect of another moment."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ....sim.effects.joint.joint_registry import JOINT_EFFECTS
from ..findings import Placebo
from .block import Block, joint_block
from .log import JointLog
from .rigid import RigidModel
from .workflow import Named, explained


def placebos(named: Named, model: RigidModel, fitted: list[JointLog], heldout: list[JointLog]) -> tuple[Placebo, ...]:
    """For the strongest effect: fitted on what the other effects leave, does a wrong version of it shrink the gap?

    A wrong version is fitted to the residual after the whole named set, where there is nothing left for it to explain.
    """
    local = [b for b in named.blocks if b.name in JOINT_EFFECTS]
    out = []
    left = _left(named, fitted)
    held = _left(named, heldout)
    if local:
        first = local[0]
        effect = JOINT_EFFECTS[first.name]
        taken = {b.target for b in named.blocks if b.name == first.name}
        free = [j for j in range(len(model.joints)) if model.joints[j] not in taken]
        if free:
            other = joint_block(effect, model, free[0], first.shape, 1)
            out.append(
                Placebo(
                    what=f"{first.name} on {model.joints[free[0]]} instead of {first.target}",
                    ratio=_ratio(other, fitted, left, heldout, held),
                )
            )
        out.append(shifted(named, first, fitted, heldout))
    return tuple(out)


def shifted(named: Named, block: Block, fitted: list[JointLog], heldout: list[JointLog]) -> Placebo:
    """One of the named effects, of another moment."""
    return Placebo(
        what=f"{block.name} on {block.target}, shifted by a third of the episode",
        ratio=_ratio(_shifted(block), fitted, _left(named, fitted), heldout, _left(named, heldout)),
    )


def _left(named: Named, logs: list[JointLog]) -> list[np.ndarray]:
    return [log.residual[log.inner] - explained(list(named.blocks), named.theta, log) for log in logs]


def _shifted(block: Block) -> Block:
    def build(log: JointLog) -> np.ndarray:
        x = block.build(log)
        return np.roll(x, len(x) // 3, axis=0)

    return replace(block, build=build)


def _ratio(
    block: Block, fitted: list[JointLog], left: list[np.ndarray], heldout: list[JointLog], held: list[np.ndarray]
) -> float:
    c = block.channels[0]
    X = np.concatenate([block.build(log)[:, 0, :] for log in fitted])
    y = np.concatenate([x[:, c] for x in left])
    theta = np.linalg.lstsq(X, y, rcond=1e-8)[0]
    a = np.concatenate([x[:, c] - block.build(log)[:, 0, :] @ theta for x, log in zip(held, heldout, strict=True)])
    b = np.concatenate([x[:, c] for x in held])
    return float(np.sqrt(np.mean(a**2) / (np.mean(b**2) + 1e-30)))
