"""A delay of a size that matters: the difference between the load and the load a little later, not its slope.

The registry's delay is of first order in the lag.  What the second order leaves looks like a spring, the third like
viscous friction, so once a lag is known about, its column is the change of the load over just that lag.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.interpolate import CubicSpline

from .block import Block
from .gram import exchange
from .log import JointLog
from .search import Search

NEAR = 2e-3  # part of the lag within which its column is as good as at the lag itself
ROUNDS = 4


def at_lag(block: Block, lag: float) -> Block:
    """A delay's block with its column exact at a lag [s]; the same block where it is so already."""
    if lag == 0.0 or abs(lag - block.about) < NEAR * abs(lag):
        return block
    joint = block.channels[0]
    kept: dict[str, np.ndarray] = {}

    def build(log: JointLog) -> np.ndarray:
        if log.name not in kept:
            load = log.measured[:, joint]
            later = CubicSpline(log.t, load)(np.clip(log.t + lag, log.t[0], log.t[-1]))
            kept[log.name] = log.shared((load - later)[:, None] / lag)[:, None, :]
        return kept[log.name]

    return replace(block, build=build, about=lag)


def lagged(search: Search, chosen: tuple[int, ...], logs: list[JointLog]) -> Search:
    """The search with the delays among `chosen` exact at the lags it finds."""
    for _ in range(ROUNDS):
        theta, at, changed = search.fit(chosen), 0, {}
        for i in chosen:
            block = search.blocks[i]
            if block.name == "delay":
                new = at_lag(block, float(theta[at]))
                if new is not block:
                    changed[i] = new
            at += len(block.parameters)
        if not changed:
            break
        search = Search(gram=exchange(search.gram, changed, logs), noise=search.noise, strict=search.strict)
    return search
