"""Confidence in each effect from resampled stretches of the log (stretches longer than the noise remembers)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .block import Block
from .log import JointLog
from .search import Search, bounded_solve
from .thresholds import CONFIDENCE
from .workflow import Named

RESAMPLES = 50
STRETCHES = 30


def kept_part(search: Search, chosen: tuple[int, ...], logs: list[JointLog], seed: int = 0) -> np.ndarray:
    """Part of the resamples, in which the chosen set is refitted, that each block still pays its price in, (B,)."""
    blocks: list[Block] = [search.blocks[i] for i in chosen]
    parameters = [p for b in blocks for p in b.parameters]
    k = len(parameters)
    if k == 0:
        return np.zeros(0)
    channels = sorted({c for b in blocks for c in b.channels})
    each = max(1, STRETCHES // len(logs))
    A, r, yy, n = [], [], [], []
    for log in logs:
        columns = np.zeros((len(channels), len(log.t[log.inner]), k))
        at = 0
        for b in blocks:
            built = b.build(log)
            for j, c in enumerate(b.channels):
                columns[channels.index(c), :, at : at + len(b.parameters)] = built[:, j, :]
            at += len(b.parameters)
        y = log.residual[log.inner][:, channels].T
        for rows in np.array_split(np.arange(y.shape[1]), each):
            X = columns[:, rows]
            A.append(np.einsum("cti,ctj->cij", X, X))
            r.append(np.einsum("cti,ct->ci", X, y[:, rows]))
            yy.append((y[:, rows] ** 2).sum(axis=1))
            n.append(len(rows))
    A, r, yy, n = np.array(A), np.array(r), np.array(yy), np.array(n, dtype=float)
    weight = search.weight[channels]
    ridge = np.diag(search.ridge[search.columns(chosen)])
    rng = np.random.default_rng(seed)
    kept = np.zeros(len(blocks))
    spans = np.cumsum([0, *(len(b.parameters) for b in blocks)])
    for _ in range(RESAMPLES):
        pick = rng.integers(len(n), size=len(n))
        Ac, rc, yc, rows = A[pick].sum(axis=0), r[pick].sum(axis=0), yy[pick].sum(axis=0), n[pick].sum()
        At, rt = np.einsum("c,cij->ij", weight, Ac) + ridge, weight @ rc
        theta = bounded_solve(At, rt, parameters)
        full = _rss(Ac, rc, yc, theta)
        for b in range(len(blocks)):
            others = np.r_[0 : spans[b], spans[b + 1] : k]
            part = np.zeros(k)
            if len(others):
                part[others] = bounded_solve(At[np.ix_(others, others)], rt[others], [parameters[o] for o in others])
            gain = rows * float(np.sum(np.log(_rss(Ac, rc, yc, part)) - np.log(full)))
            kept[b] += gain > search.price[chosen[b]]
    return kept / RESAMPLES


def _rss(A: np.ndarray, r: np.ndarray, yy: np.ndarray, theta: np.ndarray) -> np.ndarray:
    return np.maximum(yy - 2 * r @ theta + np.einsum("i,cij,j->c", theta, A, theta), 1e-12 * yy + 1e-30)


def confident(named: Named, logs: list[JointLog]) -> Named:
    """Leave out, one after the other, effects that too few resamples keep."""
    while named.chosen:
        kept = kept_part(named.search, named.chosen, logs)
        worst = int(np.argmin(kept))
        if kept[worst] >= CONFIDENCE:
            break
        chosen = named.chosen[:worst] + named.chosen[worst + 1 :]
        named = replace(
            named,
            chosen=chosen,
            blocks=named.blocks[:worst] + named.blocks[worst + 1 :],
            theta=named.search.fit(chosen),
        )
    return named
