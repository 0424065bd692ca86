"""Which set of effects explains the residual: forward steps, swaps and removals under one criterion.

The criterion is sum_c n_c log(rss_c) over channels plus a price per effect.  A step lowers the first part by about its
Wald statistic (the noise is what the larger model leaves).  The price is what coloured noise alone would gain with
probability ALPHA over all hypotheses tried, or a material size, whichever is more.  A step must also pay off on
folds it was not fitted to.
"""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import chi2

from ....sim.effects.effect import Parameter
from .block import Block
from .gram import Gram
from .noise import NoiseModel
from .thresholds import ALPHA, CROSS, LEFT, MATERIAL, SHARE

Set = tuple[int, ...]
COLLINEAR = 1e-5
EQUAL_FRICTION = frozenset({"coulomb_friction", "stribeck_friction"})  # dry, the same in both directions


@dataclass
class Search:
    """The search over one Gram.

    Attributes:
        gram: normal equations per fold and channel.
        noise: weights the channels and says how much a row is worth.
        strict: factor on the material size (1 as frozen).
    """

    gram: Gram
    noise: NoiseModel
    strict: float = 1.0

    def __post_init__(self) -> None:
        self.blocks: list[Block] = self.gram.blocks
        self.weight = 1.0 / self.noise.rms**2  # (C,)
        self.Gc, self.rows = self.gram.G.sum(axis=0), self.gram.rows.sum(axis=0)
        self.G = np.einsum("c,cij->ij", self.weight, self.Gc)
        self.fold_G = np.einsum("c,fcij->fij", self.weight, self.gram.G)
        self._take_residual()
        single = [i for i, b in enumerate(self.blocks) if len(b.parameters) == 1 and len(b.channels) == 1]
        self._single = np.array(single, dtype=int)
        self._others = [i for i in range(len(self.blocks)) if i not in set(single)]
        self._single_columns = np.array([self.gram.spans[i].start for i in single], dtype=int)
        self._single_channel = np.array([self.blocks[i].channels[0] for i in single], dtype=int)
        self._single_low = np.array([self.blocks[i].parameters[0].lower for i in single])
        self._single_high = np.array([self.blocks[i].parameters[0].upper for i in single])
        tried = len({b.key for b in self.blocks})
        self.widening = np.array([self._widening(i) for i in range(len(self.blocks))])
        self.critical = np.array([chi2.isf(ALPHA / (tried * b.trials), b.size) for b in self.blocks])
        material = np.array([b.size * MATERIAL**2 * np.mean(self.rows[list(b.channels)]) for b in self.blocks])
        self.price = np.maximum(self.critical * self.widening, self.strict * material)
        self.ridge = np.zeros(self.G.shape[0])  # what is plausible for the model's own parameters, in the same units
        for i, b in enumerate(self.blocks):
            if b.term is not None and np.isfinite(b.term.deviation):
                self.ridge[self.gram.spans[i].start] = self.widening[i] / b.term.deviation**2
        d = np.arange(len(self.ridge))
        self.G[d, d] += self.ridge
        self.fold_G[:, d, d] += self.ridge / len(self.fold_G)
        self._price_unequal_friction()

    def _price_unequal_friction(self) -> None:
        """Unequal levels are a level and an offset: the same price, so that the data decides."""
        simple = {b.key: self.price[i] for i, b in enumerate(self.blocks)}
        for i, b in enumerate(self.blocks):
            parts = [(part, b.target) for part in ("coulomb_friction", "offset")]
            if b.name == "asymmetric_friction" and all(part in simple for part in parts):
                self.price[i] = sum(simple[part] for part in parts)

    def _take_residual(self) -> None:
        """Everything that depends on the residual; the rest depends on the blocks and the noise alone."""
        self.bc, self.yyc = self.gram.b.sum(axis=0), self.gram.yy.sum(axis=0)
        self.b = self.weight @ self.bc
        self.fold_b = np.einsum("c,fci->fi", self.weight, self.gram.b)

    def with_residual(self, b: np.ndarray, yy: np.ndarray) -> Search:
        """The same search, with the same prices, on another residual of the same logs.

        Args:
            b: (F, C, K) products of the columns with the residual, per fold and channel.
            yy: (F, C) its squares.
        """
        other = copy(self)
        other.gram = replace(self.gram, b=b, yy=yy)
        other._take_residual()
        return other

    def _widening(self, i: int) -> float:
        span, block = self.gram.spans[i], self.blocks[i]
        per = np.array([self.noise.widening(self.gram.acf[c][:, span], c).max() for c in block.channels])
        energy = np.array([self.weight[c] * np.trace(self.Gc[c][span, span]) for c in block.channels])
        return float(energy @ per / energy.sum()) if energy.sum() > 0 else 1.0

    def columns(self, chosen: Set) -> np.ndarray:
        """Column indices of a set of blocks."""
        spans = self.gram.spans
        return (
            np.concatenate([np.arange(spans[i].start, spans[i].stop) for i in chosen]) if chosen else np.zeros(0, int)
        )

    def fit(self, chosen: Set, folds: list[int] | None = None) -> np.ndarray:
        """Bounded least squares of the blocks' parameters, concatenated in the order of `chosen`."""
        s = self.columns(chosen)
        if not len(s):
            return np.zeros(0)
        G = self.G if folds is None else self.fold_G[folds].sum(axis=0)
        b = self.b if folds is None else self.fold_b[folds].sum(axis=0)
        return bounded_solve(G[np.ix_(s, s)], b[s], [p for i in chosen for p in self.blocks[i].parameters])

    def rss(self, chosen: Set, theta: np.ndarray | None = None) -> np.ndarray:
        """Residual sum of squares per channel after the bounded fit, (C,)."""
        if not chosen:
            return self.yyc
        s = self.columns(chosen)
        theta = self.fit(chosen) if theta is None else theta
        inner = self.Gc[:, s[:, None], s[None, :]]
        return np.maximum(
            self.yyc - 2 * self.bc[:, s] @ theta + np.einsum("i,cij,j->c", theta, inner, theta),
            1e-12 * self.yyc + 1e-30,
        )

    def score(self, chosen: Set) -> float:
        """The criterion, smaller is better."""
        theta = self.fit(chosen)
        implausible = float(self.ridge[self.columns(chosen)] @ theta**2) if chosen else 0.0
        return float(self.rows @ np.log(self.rss(chosen, theta))) + float(self.price[list(chosen)].sum()) + implausible

    def gains(self, chosen: Set) -> np.ndarray:
        """Approximate drop of the criterion's first part when each block joins, signs respected, (B,)."""
        s = self.columns(chosen)
        rss = self.rss(chosen)
        if len(s):
            size = np.sqrt(np.diag(self.G)[s]) + 1e-12
            inner = self.G[np.ix_(s, s)] / np.outer(size, size) + 1e-9 * np.eye(len(s))
            mix = np.linalg.solve(inner, np.column_stack([self.G[s], self.b[s]]) / size[:, None]) / size[:, None]
            rest = self.b - self.G[:, s] @ mix[:, -1]
        else:
            mix, rest = None, self.b
        out = np.zeros(len(self.blocks))
        left = float(self.weight @ rss)
        k = self._single_columns
        A = self.G[k, k] - (np.einsum("ij,ji->i", self.G[np.ix_(k, s)], mix[:, k]) if mix is not None else 0.0)
        r, size = rest[k], self.G[k, k]
        sound = COLLINEAR * size + 1e-12 < A
        theta = np.where(sound, r / np.where(sound, A, 1.0), 0.0)
        drop = np.where((theta >= self._single_low) & (theta <= self._single_high), theta * r, 0.0)
        whole = self.weight[self._single_channel] * rss[self._single_channel]
        out[self._single] = -self.rows[self._single_channel] * np.log(np.maximum(1.0 - drop / whole, 1e-9))
        for i in self._others:
            block = self.blocks[i]
            k = np.arange(self.gram.spans[i].start, self.gram.spans[i].stop)
            A = self.G[np.ix_(k, k)] - (self.G[np.ix_(k, s)] @ mix[:, k] if mix is not None else 0.0)
            free = np.diag(A) > COLLINEAR * np.diag(self.G)[k] + 1e-12
            gain = _bounded_gain(A, rest[k], free, block)
            if len(block.channels) == 1:
                c = block.channels[0]
                out[i] = -self.rows[c] * np.log(max(1.0 - gain / self.weight[c] / rss[c], 1e-9))
            else:  # several channels: shared out as the weighted residual is
                out[i] = -self.rows.sum() * np.log(max(1.0 - gain / left, 1e-9))
        out[list(chosen)] = 0.0
        return out

    def crossed(self, chosen: Set, added: int, base: Set) -> bool:
        """Whether `added` pays off on folds the parameters were not fitted to."""
        gain = self.held(base) - self.held(chosen)
        whole = float(self.weight @ (self.rss(base) - self.rss(chosen)))
        return gain > CROSS * whole

    def held(self, chosen: Set) -> float:
        """Weighted squares on every fold with the parameters fitted to the others, up to a constant."""
        s = self.columns(chosen)
        total = 0.0
        if len(s):
            every = list(range(len(self.fold_G)))
            for fold in every:
                theta = self.fit(chosen, [f for f in every if f != fold])
                total += float(-2 * theta @ self.fold_b[fold][s] + theta @ self.fold_G[fold][np.ix_(s, s)] @ theta)
        return total

    def weighty(self, chosen: Set, added: int, base: Set, beside: np.ndarray | float = 0.0) -> bool:
        """Whether `added` explains a fair share of what is explained, or was left, in the channel it helps most.

        Args:
            chosen: the set with it.
            added: the block.
            base: the set without it.
            beside: energy per channel (C,) that is explained by what has been taken out of the residual.
        """
        before, after = self.rss(base), self.rss(chosen)
        c = list(self.blocks[added].channels)
        gained, explained = (before - after)[c], np.maximum(self.yyc - after + beside, 1e-30)[c]
        return bool(np.max(gained / explained) > SHARE or np.max(gained / before[c]) > LEFT)

    def clash(self, i: int, chosen: Set) -> Set:
        """Members of `chosen` that block `i` replaces: itself in other shape, its special cases, what contains it."""
        new = self.blocks[i]
        return tuple(
            j
            for j in chosen
            if self.blocks[j].target == new.target
            and (
                self.blocks[j].name == new.name
                or self.blocks[j].name in new.contains
                or new.name in self.blocks[j].contains
                or (self.blocks[j].contains & new.contains)
            )
        )

    def run(self, start: Set = ()) -> Set:
        """Search until no single move improves the criterion."""
        chosen, best = start, self.score(start)
        for _ in range(150):
            move = self._best_move(chosen, best)
            if move is None:
                return chosen
            chosen, best = move
        return chosen

    def _best_move(self, chosen: Set, best: float) -> tuple[Set, float] | None:
        step = self._try(self._additions(chosen), chosen, best) or self._try(self._removals(chosen), chosen, best)
        return step or self._try(self._swaps(chosen), chosen, best)

    def _try(self, candidates: list[tuple[float, Set, int | None]], now: Set, best: float) -> tuple[Set, float] | None:
        for guess, chosen, added in sorted(candidates, key=lambda c: c[0])[:15]:
            if guess >= best - 1e-6:
                return None
            score = self.score(chosen)
            if score >= best - 1e-6:
                continue
            if added is not None:
                gone = tuple(i for i in now if i not in chosen)
                base = (
                    now
                    if len(gone) == 1 and self.blocks[gone[0]].name in self.blocks[added].contains
                    else tuple(i for i in chosen if i != added)
                )
                if not (self.crossed(chosen, added, base) and self.weighty(chosen, added, base)):
                    continue
            return chosen, score
        return None

    def _additions(self, chosen: Set) -> list[tuple[float, Set, int | None]]:
        base = self.score(chosen)
        out: list[tuple[float, Set, int | None]] = []
        net = self.gains(chosen) - self.price
        for i in (int(k) for k in np.argsort(-net)[:40]):
            if i not in chosen and not self.clash(i, chosen):
                out.append((base - net[i], (*chosen, i), i))
        for i, block in enumerate(self.blocks):  # a richer or reshaped version of something already chosen
            gone = self.clash(i, chosen)
            if gone and i not in chosen and (block.contains or block.shape):
                new = (*(j for j in chosen if j not in gone), i)
                out.append((self.score(new), new, i))
        return out

    def _removals(self, chosen: Set) -> list[tuple[float, Set, int | None]]:
        sets = [chosen[:k] + chosen[k + 1 :] for k in range(len(chosen))]
        return [(self.score(new), new, None) for new in sets]

    def _swaps(self, chosen: Set) -> list[tuple[float, Set, int | None]]:
        out: list[tuple[float, Set, int | None]] = []
        drops: list[Set] = [(i,) for i in chosen]
        drops += [
            (i, j)
            for a, i in enumerate(chosen)
            for j in chosen[a + 1 :]
            if set(self.blocks[i].channels) & set(self.blocks[j].channels)
            and min(len(self.blocks[i].channels), len(self.blocks[j].channels)) == 1
        ]
        for drop in drops:
            rest = tuple(i for i in chosen if i not in drop)
            base = self.score(rest)
            touched = {c for i in drop for c in self.blocks[i].channels}
            net = self.gains(rest) - self.price
            for i in (int(k) for k in np.argsort(-net)[:6]):
                if i not in chosen and touched & set(self.blocks[i].channels) and not self.clash(i, rest):
                    out.append((base - net[i], (*rest, i), i))
        return out + self._splits(chosen)

    def _splits(self, chosen: Set) -> list[tuple[float, Set, int | None]]:
        """One into two, where one is nearly the sum of two others: unequal friction is dry friction and an offset."""
        out: list[tuple[float, Set, int | None]] = []
        offsets = {b.target: i for i, b in enumerate(self.blocks) if b.name == "offset"}
        for i in chosen:
            zero = offsets.get(self.blocks[i].target)
            if self.blocks[i].name != "asymmetric_friction" or zero is None:
                continue
            rest = tuple(j for j in chosen if j not in (i, zero))
            for k, block in enumerate(self.blocks):
                if block.target == self.blocks[i].target and block.name in EQUAL_FRICTION:
                    out.append((self.score((*rest, k, zero)), (*rest, k, zero), k))
        return out


def bounded_solve(A: np.ndarray, r: np.ndarray, parameters: list[Parameter]) -> np.ndarray:
    """Minimiser of x A x / 2 - r x within the parameters' bounds, (k,)."""
    low, high = np.array([p.lower for p in parameters]), np.array([p.upper for p in parameters])
    held = np.zeros(len(r), dtype=bool)
    theta = np.zeros(len(r))
    for _ in range(len(r) + 1):  # active set: a value that wants to leave its bounds is held there
        free = ~held
        if free.any():
            theta[free] = _solve(A[np.ix_(free, free)], r[free] - A[np.ix_(free, held)] @ theta[held])
        out = free & ((theta < low) | (theta > high))
        if not out.any():
            return theta
        theta[out] = np.clip(theta[out], low[out], high[out])
        held |= out
    return theta


def _solve(A: np.ndarray, r: np.ndarray) -> np.ndarray:
    size = np.sqrt(np.diag(A)) + 1e-12
    return np.linalg.solve(A / np.outer(size, size) + 1e-9 * np.eye(len(A)), r / size) / size


def _ridge(A: np.ndarray) -> np.ndarray:
    return A + np.diag(1e-9 * np.diag(A) + 1e-14)


def _bounded_gain(A: np.ndarray, r: np.ndarray, free: np.ndarray, block: Block) -> float:
    """Gain of a block whose parameters may not leave their bounds; those that want to are held at zero."""
    free = free.copy()
    for _ in range(len(r)):
        if not free.any():
            return 0.0
        k = np.flatnonzero(free)
        theta = np.linalg.lstsq(_ridge(A[np.ix_(k, k)]), r[k], rcond=None)[0]
        bad = [
            j for j, x in zip(k, theta, strict=True) if not block.parameters[j].lower <= x <= block.parameters[j].upper
        ]
        if not bad:
            return float(theta @ r[k])
        free[bad] = False
    return 0.0
