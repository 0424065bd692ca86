"""Whether an effect is the same all the time, or warms up, wears or runs away from one recording to the next."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .....sim.effects.effect import Parameter
from ..block import Block
from ..gram import assemble
from ..log import JointLog
from ..search import Search
from ..workflow import Named

CHANGE = "change of "  # and then the effect that may change
CHANGED = 0.25  # of its mean, by which an effect's size has to change before it is said to


def unsteady(named: Named, logs: list[JointLog]) -> str:
    """Which named effect is not the same in all of some logs, and how it changes; "" where all are.

    Each effect on a joint is given a size of its own in every log, at its beginning and at its end, beside all that
    was named; that has to pay as any effect has to.

    Args:
        named: what was found.
        logs: what it was fitted to.
    """
    blocks, at = list(named.blocks), 0
    changing: list[tuple[slice, Block]] = []
    for block in blocks:
        span = slice(at, at + len(block.parameters))
        at = span.stop
        if block.term is None and named.theta[span].any():
            changing.append((span, _changing(block, named.theta[span], logs)))
    if not changing:
        return ""
    search = Search(gram=assemble([*blocks, *(c for _, c in changing)], logs, mixed=True), noise=named.noise)
    whole, found = tuple(range(len(blocks))), []
    for k, (span, change) in enumerate(changing, len(blocks)):
        richer = (*whole, k)
        gain = float(search.rows @ (np.log(search.rss(whole)) - np.log(search.rss(richer)))) - search.price[k]
        if gain > 0.0 and search.crossed(richer, k, whole) and search.weighty(richer, k, whole):
            theta, old = search.fit(richer), named.theta[span]
            mean = float(theta[span] @ old / (old @ old))  # what is the same all the time gives way as well
            found.append((gain, change, _sizes(mean, theta[len(named.theta) :], len(logs))))
    for _, change, sizes in sorted(found, key=lambda f: -f[0]):
        low, high = int(np.argmin(sizes)), int(np.argmax(sizes))
        if sizes[high] - sizes[low] > CHANGED:
            ends = " and ".join(f"{sizes[k]:.2f} {_end(logs, k)}" for k in (low, high))
            what = f"{change.name.removeprefix(CHANGE)} on {change.target}"
            return f"{what} is not the same all the time: of its size {ends}"
    return ""


def _changing(block: Block, theta: np.ndarray, logs: list[JointLog]) -> Block:
    """What an effect of some size would add, were it another in each log (K - 1), and grew along each (K)."""
    names = [log.name for log in logs]

    def build(log: JointLog) -> np.ndarray:
        load = block.build(log) @ theta
        mine = names.index(log.name)
        along = np.linspace(-1.0, 1.0, len(load))[:, None]
        out = np.zeros((*load.shape, 2 * len(names) - 1))
        out[..., mine] = load * along
        if mine:
            out[..., len(names) + mine - 1] = load
        return out

    parameters = tuple(Parameter(name=f"change_{k}", unit="1") for k in range(2 * len(names) - 1))
    return replace(block, name=f"{CHANGE}{block.name}", build=build, parameters=parameters, contains=frozenset())


def _sizes(mean: float, theta: np.ndarray, logs: int) -> np.ndarray:
    """(2 K,) of an effect over its named one, at the beginning and at the end of each log."""
    level = mean + np.concatenate([[0.0], theta[logs:]])
    return np.stack([level - theta[:logs], level + theta[:logs]], axis=1).ravel()


def _end(logs: list[JointLog], k: int) -> str:
    return f"at the {'end' if k % 2 else 'beginning'} of {logs[k // 2].name}"
