"""Dry friction that does not jump: how fast a joint has to turn until its friction has changed sides.

The search knows dry friction as a sign.  Where that is named, the speed within which it passes through zero is fitted,
and kept where it pays for the number it is and does so on folds it was not fitted to.
"""

from __future__ import annotations

import numpy as np
from scipy.stats import chi2

from ....sim.effects.joint.joint_registry import JOINT_EFFECTS
from .block import joint_block
from .gram import exchange
from .log import JointLog, spread
from .refine import fit_shape
from .rigid import RigidModel
from .search import Search
from .thresholds import ALPHA, CROSS, MATERIAL

START = 0.1  # of the usual speed
WIDEST = 0.5  # of the usual speed


def widened(search: Search, chosen: tuple[int, ...], model: RigidModel, logs: list[JointLog]) -> Search:
    """The search with the dry friction among `chosen` as wide as the logs show it to be."""
    dry = [i for i in chosen if "width" in _optional(search.blocks[i].name)]
    for i in dry:
        old, c = search.blocks[i], search.blocks[i].channels[0]
        reach = spread(logs, c)
        start = max(START * reach.speed, 2.0 * reach.slow)
        begun = joint_block(JOINT_EFFECTS[old.name], model, c, {"width": start}, 1)
        wide = fit_shape(begun, [search.blocks[j] for j in chosen if j != i], model, logs)
        if not 2.0 * reach.slow <= wide.shape["width"] <= WIDEST * reach.speed:
            continue  # narrower than the log resolves, or so wide that it is viscous friction
        before, held = search.rss(chosen), search.held(chosen)
        tried = Search(gram=exchange(search.gram, {i: wide}, logs), noise=search.noise, strict=search.strict)
        after = tried.rss(chosen)
        gain = float(search.rows @ (np.log(before) - np.log(after)))
        price = max(chi2.isf(ALPHA / len(dry), 1) * search.widening[i], search.strict * MATERIAL**2 * search.rows[c])
        whole = float(search.weight @ (before - after))
        if gain > price and held - tried.held(chosen) > CROSS * whole:
            search = tried
        else:  # the sums are shared between the two
            search = Search(gram=exchange(tried.gram, {i: old}, logs), noise=search.noise, strict=search.strict)
    return search


def _optional(name: str) -> set[str]:
    return {p.name for p in JOINT_EFFECTS[name].optional} if name in JOINT_EFFECTS else set()
