"""One hypothesis of the search: an effect on a target, as columns it would leave in the residual."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from ....sim.effects.effect import JointEffect, Parameter, Spread
from ....sim.effects.joint.joint_registry import JOINT_EFFECTS
from .log import JointLog, spread
from .rigid import BodyTerm, RigidModel

Build = Callable[[JointLog], np.ndarray]  # log -> (T_inner, len(channels), p), through the shared filter


@dataclass(frozen=True, kw_only=True)
class Block:
    """An effect (or recalibration) with its nonlinear values fixed.

    Attributes:
        name: effect name, or `mass`.
        target: joint or body.
        recalibration: a parameter of the user's own model.
        channels: joints whose load it touches.
        parameters: linear parameters, one per column.
        shape: nonlinear parameters and their values.
        shape_parameters: their descriptions.
        contains: names of effects that are special cases of it on the same target.
        build: its columns in one log.
        trials: how many shapes were screened (multiplicity).
        term: the body term behind it, if any.
        about: value of its parameter that its columns are exact at.
    """

    name: str
    target: str
    recalibration: bool
    channels: tuple[int, ...]
    parameters: tuple[Parameter, ...]
    build: Build = field(repr=False)
    shape: dict[str, float] = field(default_factory=dict)
    shape_parameters: tuple[Parameter, ...] = ()
    contains: frozenset[str] = frozenset()
    trials: int = 1
    term: BodyTerm | None = None
    about: float = 0.0

    @property
    def key(self) -> tuple[str, str]:
        """Name and target: two blocks with the same key are the same effect in different shape."""
        return self.name, self.target

    @property
    def body(self) -> str:
        """Joint or body it acts on; `target` also says from when on, where that is not all the time."""
        return self.target if self.term is None else self.term.target

    @property
    def size(self) -> int:
        """Number of free values, nonlinear ones included."""
        return len(self.parameters) + sum(p.name != "side" for p in self.shape_parameters)


def joint_block(effect: JointEffect, model: RigidModel, joint: int, shape: dict[str, float], trials: int) -> Block:
    """The block of a joint effect at one shape."""
    kept: dict[str, np.ndarray] = {}

    def build(log: JointLog) -> np.ndarray:
        if log.name not in kept:
            kept[log.name] = log.columns(effect, joint, shape)[:, None, :]
        return kept[log.name]

    return Block(
        name=effect.name,
        target=model.joints[joint],
        recalibration=False,
        channels=(joint,),
        parameters=effect.linear,
        build=build,
        shape=shape,
        shape_parameters=(*effect.shape, *(p for p in effect.optional if p.name in shape)),
        contains=effect.contains,
        trials=trials,
    )


def body_block(term: BodyTerm, model: RigidModel) -> Block:
    """The block of a body term; its columns are kept per log, they cost a pass through the model."""
    kept: dict[str, np.ndarray] = {}

    def build(log: JointLog) -> np.ndarray:
        if log.name not in kept:
            columns = model.body_columns(term, log.q, log.dq, log.ddq)
            if term.during is not None:
                columns = columns * term.during.acts(log.name, log.t)[:, None, None]
            kept[log.name] = log.shared(columns, sharp=term.during is not None)
        return kept[log.name]

    special = {"payload": frozenset({"wrong_tool"}), "wrong_tool": frozenset({"payload"})}
    return Block(
        name=term.name,
        target=_since(term),
        recalibration=term.recalibration,
        channels=tuple(range(len(model.joints))),
        parameters=term.parameters,
        build=build,
        shape=term.shape,
        term=term,
        contains=special.get(term.name, frozenset()),
    )


def _since(term: BodyTerm) -> str:
    """The body, and where the term does not act all the time, since when."""
    if term.during is None:
        return term.target
    name, spells = next((n, s) for n, s in term.during.spells.items() if s)
    return f"{term.target} from {max(spells[0][0], 0.0):.4g} s of {name}"


def effect_blocks(model: RigidModel, logs: list[JointLog], system: str) -> list[Block]:
    """Every hypothesis for these logs: each effect on each joint in each screened shape, and each body term."""
    blocks = [body_block(term, model) for term in model.body_terms()]
    for joint in range(len(model.joints)):
        reach: Spread = spread(logs, joint)
        if reach.speed <= 0 or reach.q[1] - reach.q[0] <= 0:
            blocks.append(joint_block(JOINT_EFFECTS["offset"], model, joint, {}, 1))
            continue
        for effect in JOINT_EFFECTS.values():
            if system not in effect.systems or (system == "axis" and effect.name in AXIS_IS_MASS):
                continue
            shapes = effect.shapes(reach)
            blocks += [joint_block(effect, model, joint, shape, len(shapes)) for shape in shapes]
    return blocks


AXIS_IS_MASS = frozenset({"gain_error", "armature"})
"""On a bare mass these are columns proportional to the mass itself: reported beside a recalibrated mass."""
