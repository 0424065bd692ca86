"""A tool or a payload is no point: what its own inertia does may have been named as other effects.

The search knows a body by its mass and where that is.  What a real one adds beyond (its inertia about its own centre,
or a tool whose mass lies otherwise than in the URDF) is small beside it, but other small effects on the same joints
then pay for mopping it up.  So a set with such a body is compared with the plainer ones in which it may have any
inertia.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from .....sim.effects.effect import Parameter
from ..alternatives import SAME
from ..arm_model import ArmModel
from ..block import Block
from ..gram import assemble
from ..log import JointLog
from ..search import Search, Set

BODIES = frozenset({"payload", "wrong_tool"})
INERTIA = ("ixx", "ixy", "iyy", "ixz", "iyz", "izz")


def solid(block: Block, model: ArmModel) -> Block:
    """The block of a body with all ten numbers that a rigid body has."""
    kept: dict[str, np.ndarray] = {}

    def build(log: JointLog) -> np.ndarray:
        if log.name not in kept:
            kept[log.name] = log.shared(model.inertial_columns(block.body, log.q, log.dq, log.ddq))
        return kept[log.name]

    others = (*(Parameter(name=f"mass_com_{a}", unit="kg m") for a in "xyz"), *(_inertia(n) for n in INERTIA))
    return replace(block, build=build, parameters=(block.parameters[0], *others))


def _inertia(name: str) -> Parameter:
    return Parameter(name=name, unit="kg m^2")


def with_solid_body(
    search: Search, chosen: Set, model: ArmModel, logs: Sequence[JointLog]
) -> list[tuple[Search, Set, Set]]:
    """The plainest set that fits as well once the body among the chosen effects has an inertia of its own.

    Args:
        search: chose the set.
        chosen: the set.
        model: the arm.
        logs: those searched.

    Returns:
        A search over the chosen blocks and the solid body, the chosen set in it, the plainer one; none where there is
        no such body, or nothing beside it can be left out.
    """
    bodies = [i for i in chosen if search.blocks[i].name in BODIES and search.blocks[i].term is not None]
    if len(bodies) != 1 or len(chosen) < 2:
        return []
    blocks = [search.blocks[i] for i in chosen]
    whole, at = tuple(range(len(blocks))), chosen.index(bodies[0])
    small = Search(gram=assemble([*blocks, solid(blocks[at], model)], list(logs)), noise=search.noise)
    plain = tuple(len(blocks) if i == at else i for i in whole)
    limit = _misfit(small, plain) + SAME * max(float(search.widening[i]) for i in chosen)
    while True:
        fewer = [tuple(i for i in plain if i != k) for k in plain if k < len(blocks) and not blocks[k].recalibration]
        left = min(((_misfit(small, s), s) for s in fewer), default=(np.inf, plain))
        if left[0] > limit:
            break
        plain = left[1]
    return [(small, whole, plain)] if len(plain) < len(whole) else []


def _misfit(search: Search, chosen: Set) -> float:
    return float(search.rows @ np.log(search.rss(chosen)))
