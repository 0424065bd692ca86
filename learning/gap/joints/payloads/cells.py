"""Which payload an arm carries when: the times at which it changes within recordings, or from one to the next.

The payload's columns (mass and first moments of the last link) are cut into cells of time.  Beside everything the
registry can say that holds all the time, all of it fitted anew, a cell may carry one of several payloads.  Changes are
added one after the other where they gain most, each for the price of its numbers and of all places it could have been
at; payloads the log cannot tell apart are one; then every change is moved to the row that suits it best.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from scipy.stats import chi2

from ..log import JointLog
from ..search import Search
from ..thresholds import ALPHA, MATERIAL
from .carried import Carried, indistinct, inverse
from .course import LEAST, Span, during_of, lengths, told

CELL = 0.5  # [s]
MOST_CELLS = 200  # of a recording
FEWEST = 3  # cells a payload is carried at least
MOST = 12  # changes looked for


def carried(search: Search, base: Sequence[int], payload: int, logs: list[JointLog]) -> Carried | None:
    """The payloads of some logs; None where one is carried all the time, or none.

    Args:
        search: over all blocks of the logs, none of which knows of a change.
        base: indices of the blocks fitted beside, in order, `payload` among them.
        payload: index of the block that is the payload, or like it while nothing changes.
        logs: what to look at, in order.
    """
    cells = _Cells(search, base, payload, logs)
    labels = cells.labels()
    if not labels.any():
        return None
    left, loads = cells.loads(labels)
    states = list(range(len(loads[0])))
    while True:  # a cell in which something changes is like neither side; what is carried that briefly is nothing
        some = [y[states] for y in loads]
        every = [told(*x, search.weight, cells.place) for x in zip(logs, left, some, strict=True)]
        longest = [max(lengths(every, logs, k), default=0.0) for k in range(len(states))]
        if min(longest) >= LEAST:
            break
        del states[int(np.argmin(longest))]
    order = sorted(range(len(states)), key=lambda k: _first(every, k))
    if len(order) < 2:
        return None
    last = every[-1][-1][0]
    during = tuple(during_of(k, every, logs, k == last) for k in order)
    return Carried(during=during, price=cells.place)


def _first(every: list[list[Span]], state: int) -> tuple[int, int]:
    return min((i, a) for i, spans in enumerate(every) for s, a, _ in spans if s == state)


class _Cells:
    """Products of the payload's columns per cell of time, with everything that holds all the time projected out."""

    def __init__(self, search: Search, base: Sequence[int], payload: int, logs: list[JointLog]) -> None:
        self._search, self._logs = search, logs
        self._columns = search.columns(tuple(base))
        mine = search.columns((payload,))
        self._own = np.searchsorted(self._columns, mine)
        A, self._b = search.G[np.ix_(self._columns, self._columns)], search.b[self._columns]
        self._inverse = inverse(A)
        self._solved = self._inverse @ self._b
        yy = float(search.weight @ search.yyc)
        self._left, self._rows = yy - float(self._b @ self._solved), float(search.rows.sum())
        self._edges = [_edges(log) for log in logs]
        self._log = np.repeat(np.arange(len(logs)), [len(e) - 1 for e in self._edges])
        K, k = len(self._columns), len(mine)
        self._cross, self._square = np.zeros((len(self._log), k, K)), np.zeros((len(self._log), k, k))
        self._right = np.zeros((len(self._log), k))
        self._tables = [self._take(c) for c in range(len(search.rows))]
        wide = float(search.widening[payload])
        self.place = float(chi2.isf(ALPHA / len(self._log), 1)) * wide
        material = MATERIAL**2 * float(search.rows.mean())  # what a number has to explain, however sure it is
        numbers = k + 1  # its own, and a time
        self._price = max(chi2.isf(ALPHA / len(self._log), numbers) * wide, numbers * material)
        self._same = indistinct(search, wide, k)

    def _take(self, c: int) -> list[np.ndarray]:
        """Columns of one channel, (T, K) per log, and their products into the cells."""
        gram, w = self._search.gram, self._search.weight[c]
        at = np.searchsorted(gram.index[c], self._columns)
        at = np.minimum(at, len(gram.index[c]) - 1)
        here = gram.index[c][at] == self._columns
        out, cell = [], 0
        for log, table, edges in zip(self._logs, gram.tables[c], self._edges, strict=True):
            X = np.where(here, table[:, at], 0.0)
            y = log.residual[log.inner, c]
            out.append(X)
            for start, stop in pairwise(edges):
                P = X[start:stop, self._own]
                self._cross[cell] += w * P.T @ X[start:stop]
                self._square[cell] += w * P.T @ P
                self._right[cell] += w * P.T @ y[start:stop]
                cell += 1
        return out

    def _fit(self, labels: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
        """What each payload is beyond the first (S, k), the numbers beside (K,), and the squares that saves."""
        states = range(1, int(labels.max()) + 1)
        k = self._right.shape[1]
        if not len(states):
            return np.zeros((0, k)), self._solved, 0.0
        B = np.concatenate([self._cross[labels == s].sum(axis=0) for s in states])
        M = -B @ self._inverse @ B.T
        for i, s in enumerate(states):
            M[i * k : (i + 1) * k, i * k : (i + 1) * k] += self._square[labels == s].sum(axis=0)
        r = np.concatenate([self._right[labels == s].sum(axis=0) for s in states]) - B @ self._solved
        theta = inverse(M) @ r
        return theta.reshape(-1, k), self._solved - self._inverse @ (B.T @ theta), float(theta @ r)

    def _gain(self, labels: np.ndarray) -> float:
        return -self._rows * float(np.log(max(1.0 - self._fit(labels)[2] / self._left, 1e-9)))

    def labels(self) -> np.ndarray:
        """Which payload each cell carries, 0 for the first."""
        labels = np.zeros(len(self._log), dtype=int)
        gained = 0.0
        for _ in range(MOST):
            best, new = self._best_split(labels)
            if best - gained < self._price:
                break
            labels, gained = self._moved(new)
        return self._joined(labels)

    def _best_split(self, labels: np.ndarray) -> tuple[float, np.ndarray]:
        """The stretch of one payload cut in two where that gains most."""
        best, new = -np.inf, labels
        starts = [0, *(np.flatnonzero(np.diff(labels)) + 1), len(labels)]
        for a, b in pairwise(starts):
            for i in range(a + FEWEST, b - FEWEST + 1):
                tried = labels.copy()
                tried[i:b] = labels.max() + 1
                gain = self._gain(tried)
                if gain > best:
                    best, new = gain, tried
        return best, new

    def _moved(self, labels: np.ndarray) -> tuple[np.ndarray, float]:
        """Every change moved to where it gains most, the others as they are."""
        gained = self._gain(labels)
        for _ in range(3):
            before = gained
            for i in np.flatnonzero(np.diff(labels)) + 1:
                starts = [0, *(np.flatnonzero(np.diff(labels)) + 1), len(labels)]
                if i not in starts:
                    continue
                k = starts.index(i)
                for j in range(starts[k - 1] + FEWEST, starts[k + 1] - FEWEST + 1):
                    tried = labels.copy()
                    tried[starts[k - 1] : j], tried[j : starts[k + 1]] = labels[i - 1], labels[i]
                    gain = self._gain(tried)
                    if gain > gained:
                        gained, labels = gain, tried
            if gained <= before:
                break
        return labels, gained

    def _joined(self, labels: np.ndarray) -> np.ndarray:
        """Payloads that cannot be told apart made one."""
        while labels.any():
            gained = self._gain(labels)
            n = int(labels.max())
            tried = [_merged(labels, a, b) for a in range(n) for b in range(a + 1, n + 1)]
            lost = [gained - self._gain(x) for x in tried]
            if min(lost) > self._same:
                break
            labels = tried[int(np.argmin(lost))]
        return labels

    def loads(self, labels: np.ndarray) -> tuple[list[np.ndarray], list[np.ndarray]]:
        """Per log: what is left without the payloads beyond the first (T, C), and each of them, (S + 1, T, C)."""
        theta, beside, _ = self._fit(labels)
        theta = np.concatenate([np.zeros((1, theta.shape[1])), theta])
        left, loads = [], []
        for i, log in enumerate(self._logs):
            X = [table[i] for table in self._tables]
            left.append(log.residual[log.inner] - np.stack([x @ beside for x in X], axis=1))
            loads.append(np.stack([np.stack([x[:, self._own] @ th for x in X], axis=1) for th in theta]))
        return left, loads


def _edges(log: JointLog) -> np.ndarray:
    """Rows at which the cells of a log begin, and the end."""
    rows = len(log.t[log.inner])
    count = int(np.clip(round(rows * log.dt / CELL), 2 * FEWEST, MOST_CELLS))
    return np.linspace(0, rows, min(count, rows) + 1).astype(int)


def _merged(labels: np.ndarray, a: int, b: int) -> np.ndarray:
    out = np.where(labels == b, a, labels)
    return np.where(out > b, out - 1, out)
