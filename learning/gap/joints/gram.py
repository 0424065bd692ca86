"""Normal equations of all hypotheses at once, per fold and channel."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from .block import Block
from .log import JointLog
from .noise import autocorrelation, lag_count


@dataclass(frozen=True, kw_only=True)
class Gram:
    """Sums of products over rows, in the units of the load.

    Attributes:
        blocks: hypotheses, in column order.
        spans: column slice of each block.
        G: (F, C, K, K) products of columns per fold and channel.
        b: (F, C, K) columns times residual.
        yy: (F, C) residual times itself.
        rows: (F, C) rows.
        acf: per channel, (lags, K) autocorrelation of the columns (0 where a column does not touch the channel).
        edges: rows (fold, start, stop) per log.
        tables: per channel and log, the columns themselves (T, K_c), and `index` (K_c,) where they stand among K.
    """

    blocks: list[Block]
    spans: list[slice]
    G: np.ndarray
    b: np.ndarray
    yy: np.ndarray
    rows: np.ndarray
    acf: list[np.ndarray]
    edges: list[list[tuple[int, int, int]]]
    tables: list[list[np.ndarray]]
    index: list[np.ndarray]


def column_spans(blocks: list[Block]) -> tuple[list[slice], int]:
    """Column slice of each block, and the total number of columns."""
    spans, at = [], 0
    for block in blocks:
        spans.append(slice(at, at + len(block.parameters)))
        at += len(block.parameters)
    return spans, at


def fold_edges(logs: list[JointLog], folds: int, mixed: bool = False) -> list[list[tuple[int, int, int]]]:
    """Rows (fold, start, stop) of each log: whole episodes where there are enough of them, else stretches of time.

    Args:
        logs: to be divided.
        folds: how many.
        mixed: every log into every fold, in short stretches, for what acts in a part of one log alone.
    """
    lengths = [len(log.t[log.inner]) for log in logs]
    if mixed:
        count = SHORT * folds
        edges = [np.linspace(0, n, count + 1).astype(int) for n in lengths]
        return [[(k % folds, int(e[k]), int(e[k + 1])) for k in range(count)] for e in edges]
    if len(logs) >= folds:
        return [[(i % folds, 0, n)] for i, n in enumerate(lengths)]
    each = int(np.ceil(folds / len(logs)))
    out = []
    for i, n in enumerate(lengths):
        edges = np.linspace(0, n, each + 1).astype(int)
        out.append([(i * each + k, int(edges[k]), int(edges[k + 1])) for k in range(each)])
    return out


SHORT = 3  # stretches of one fold in one log, where logs are mixed


def assemble(blocks: list[Block], logs: list[JointLog], folds: int = 6, *, mixed: bool = False) -> Gram:
    """Build every column once and sum products per fold and channel.

    Args:
        blocks: whose columns.
        logs: in which.
        folds: how many.
        mixed: whether every log is in every fold, as it is where something does not act all the time.
    """
    spans, k = column_spans(blocks)
    mixed = mixed or any(b.term is not None and b.term.during is not None for b in blocks)
    edges = fold_edges(logs, folds, mixed=mixed)
    count = 1 + max(f for episode in edges for f, _, _ in episode)
    channels = logs[0].residual.shape[1]
    G, b = np.zeros((count, channels, k, k)), np.zeros((count, channels, k))
    yy, rows = np.zeros((count, channels)), np.zeros((count, channels))
    lags = lag_count([log.t[log.inner] for log in logs])
    built = [[block.build(log) for block in blocks] for log in logs]
    acf, every, places = [], [], []
    for c in range(channels):
        local = [(i, block.channels.index(c)) for i, block in enumerate(blocks) if c in block.channels]
        index = np.array([k for i, _ in local for k in range(spans[i].start, spans[i].stop)], dtype=int)
        empty = [np.zeros((len(log.t[log.inner]), 0)) for log in logs]  # of a channel that no block touches
        tables = [
            np.concatenate([x, *(parts[i][:, j, :] for i, j in local)], axis=1)
            for x, parts in zip(empty, built, strict=True)
        ]
        for log, X, parts in zip(logs, tables, edges, strict=True):
            y = log.residual[log.inner, c]
            for fold, start, stop in parts:
                A, r = X[start:stop], y[start:stop]
                G[fold, c][np.ix_(index, index)] += A.T @ A
                b[fold, c][index] += A.T @ r
                yy[fold, c] += r @ r
                rows[fold, c] += len(r)
        whole = np.zeros((lags, k))
        if local:
            whole[:, index] = autocorrelation(tables, lags)
        acf.append(whole)
        every.append(tables)
        places.append(index)
    return Gram(
        blocks=blocks, spans=spans, G=G, b=b, yy=yy, rows=rows, acf=acf, edges=edges, tables=every, index=places
    )


def exchange(gram: Gram, changed: dict[int, Block], logs: list[JointLog]) -> Gram:
    """The same sums with some blocks replaced by others of the same size; only their products are computed."""
    blocks = [changed.get(i, block) for i, block in enumerate(gram.blocks)]
    for c, index in enumerate(gram.index):
        mine = [i for i, block in changed.items() if c in block.channels]
        if not mine:
            continue
        columns = np.concatenate([np.arange(gram.spans[i].start, gram.spans[i].stop) for i in mine])
        at = np.searchsorted(index, columns)
        gram.G[:, c, columns[:, None], index[None, :]] = 0.0
        gram.G[:, c, index[:, None], columns[None, :]] = 0.0
        gram.b[:, c, columns] = 0.0
        for log, X, parts in zip(logs, gram.tables[c], gram.edges, strict=True):
            X[:, at] = np.concatenate([changed[i].build(log)[:, changed[i].channels.index(c), :] for i in mine], axis=1)
            y = log.residual[log.inner, c]
            for fold, start, stop in parts:
                A = X[start:stop]
                cross = A.T @ A[:, at]
                gram.G[fold, c][np.ix_(index, columns)] += cross
                rest = np.setdiff1d(np.arange(len(index)), at)
                gram.G[fold, c][np.ix_(columns, index[rest])] += cross[rest].T
                gram.b[fold, c][columns] += A[:, at].T @ y[start:stop]
        gram.acf[c][:, columns] = autocorrelation([X[:, at] for X in gram.tables[c]], len(gram.acf[c]))
    return replace(gram, blocks=blocks)
