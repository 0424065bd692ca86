"""Whole sets of effects that explain a log as well as the named one, from the search's own columns and noise.

Prices are not counted here: a price says which explanation is likelier beforehand, not which the log rules out.  A set
with one effect more fits better by construction; it is a rival where it does so by more than noise would, and yet not
by as much as a new effect has to before it is named.  So what the named effects may have swallowed is told too, and so
is what could act beside them, as large as the noise, without the log showing it: an offset beside friction that differs
between the directions, in a log that never rests.

The search takes the best of very many hypotheses, so on the logs it searched a set that it wrongly took fits noticeably
better than the right one: it would not have been taken otherwise.  On other logs, with the numbers of the first, that
advantage is gone, and what a real effect explains is there again.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import islice

import numpy as np
from scipy.stats import chi2, norm

from .alternatives import SAME, forget
from .block import Block
from .gram import Gram, assemble
from .log import JointLog
from .search import Search, Set

SWALLOWED = 0.05  # chance that noise alone gains as much as an effect that is told as perhaps swallowed
HIDES = 1.0  # load over the noise from which on an effect that the log would not show is told
TRIED = 6  # of the effects that could take the place of others, those that gain most
PAIRED = 2  # and of those that could join one of them
LEVEL = 0.05  # chance that noise alone makes the logs not searched prefer the right one of two sets by as little
DECISIVE = 3.0  # what the searched logs have against a set, over the price of what it lacks, that settles it
MOST = 6


@dataclass
class Unsearched:
    """Logs nothing was chosen on, beside a search of others.

    Attributes:
        search: of the other logs.
        logs: those not searched.
    """

    search: Search
    logs: Sequence[JointLog]
    _kept: dict[Set, float] = field(default_factory=dict)

    def leaves_open(self, chosen: Set, other: Set, worse: float) -> bool:
        """Whether another set may be right although the searched logs prefer the chosen one.

        Args:
            chosen: the named set.
            other: the other.
            worse: by how much it fits the searched logs worse, in the search's criterion without prices.
        """
        lacks = [i for i in chosen if i not in other]
        if not lacks or not self.logs or worse > DECISIVE * float(self.search.price[lacks].sum()):
            return False
        least = float(chi2.isf(LEVEL, 1)) * max(float(self.search.widening[i]) for i in {*chosen, *other})
        return self._misfit(other) - self._misfit(chosen) < least

    def _misfit(self, chosen: Set) -> float:
        """The criterion without prices on these logs, with the numbers that suit the searched ones."""
        if chosen not in self._kept:
            theta, rows, squares = self.search.fit(chosen), 0, 0.0
            for log in self.logs:
                left, at = log.residual[log.inner].copy(), 0
                for block in (self.search.blocks[i] for i in chosen):
                    n = len(block.parameters)
                    left[:, list(block.channels)] -= block.build(log) @ theta[at : at + n]
                    at += n
                rows, squares = rows + len(left), squares + np.sum(left**2, axis=0)
            self._kept[chosen] = float(rows * np.log(squares + 1e-30).sum())
        return self._kept[chosen]

    def together(self, chosen: Set) -> Set:
        """The set that a search of all logs takes, begun at the chosen one."""
        if not self.logs:
            return chosen
        gram = _joined(self.search.gram, assemble(self.search.blocks, list(self.logs)))
        return Search(gram=gram, noise=self.search.noise, strict=self.search.strict).run(chosen)


def _joined(a: Gram, b: Gram) -> Gram:
    """The sums of both; columns remember as in the first."""
    later = [[(fold + len(a.G), start, stop) for fold, start, stop in log] for log in b.edges]
    return replace(
        a,
        G=np.concatenate([a.G, b.G]),
        b=np.concatenate([a.b, b.b]),
        yy=np.concatenate([a.yy, b.yy]),
        rows=np.concatenate([a.rows, b.rows]),
        edges=[*a.edges, *later],
        tables=[[*x, *y] for x, y in zip(a.tables, b.tables, strict=True)],
    )


def rivals(search: Search, chosen: Set, others: Unsearched | None = None, most: int = MOST) -> list[Set]:
    """Other sets that fit as well, best first.

    Args:
        search: knows all blocks and how well any set of them fits.
        chosen: the named set.
        others: logs that nothing was chosen on, where there are some.
        most: how many at most.
    """
    base, mine = _misfit(search, chosen), _named(search, chosen)
    found: dict[frozenset[tuple[str, str]], tuple[float, Set]] = {}
    for other in _neighbours(search, chosen):
        names = _named(search, other)
        if not names or names == mine:
            continue
        worse = _misfit(search, other) - base
        widest = max(float(search.widening[i]) for i in {*chosen, *other})
        numbers = _numbers(search, other) - _numbers(search, chosen)
        if len(names) > len(mine) and numbers > 0:
            keep = -worse > chi2.isf(SWALLOWED, numbers) * widest
        else:
            keep = worse < SAME * widest or (others is not None and others.leaves_open(chosen, other, worse))
        score = search.score(other)
        if keep and (names not in found or score < found[names][0]):
            found[names] = (score, other)
    found = {names: pair for names, pair in found.items() if not _padded(search, names, found)}
    every = chosen if others is None else others.together(chosen)
    if _named(search, every) not in (mine, frozenset()):
        found[_named(search, every)] = (-np.inf, every)
    return [other for _, other in sorted(found.values(), key=lambda pair: pair[0])][:most]


def _padded(
    search: Search,
    names: frozenset[tuple[str, str]],
    found: dict[frozenset[tuple[str, str]], tuple[float, Set]],
) -> bool:
    """Whether a set is another one of those found and something that noise alone would gain as much with."""
    other = found[names][1]
    for less, (_, part) in found.items():
        if less < names:
            numbers = max(_numbers(search, other) - _numbers(search, part), 1)
            widest = max(float(search.widening[i]) for i in {*other, *part})
            if _misfit(search, part) - _misfit(search, other) < chi2.isf(SWALLOWED, numbers) * widest:
                return True
    return False


def beside(search: Search, chosen: Set, most: int = MOST) -> list[Set]:
    """The named set with one effect more that could be as large as the noise unseen, the best hidden first.

    What of its column the chosen ones cannot imitate is all that the log shows of it.

    Args:
        search: knows all blocks.
        chosen: the named set.
        most: how many at most.
    """
    columns, found = search.columns(chosen), dict[tuple[str, str], tuple[float, Set]]()
    if not len(columns):
        return []
    inverse = np.linalg.pinv(search.G[np.ix_(columns, columns)], rcond=1e-10, hermitian=True)
    for i, block in enumerate(search.blocks):
        if block.recalibration or len(block.parameters) > 1 or i in chosen or search.clash(i, chosen):
            continue
        at = search.gram.spans[i].start
        whole, cross = search.G[at, at], search.G[at, columns]
        load = _unseen(search, i, float(1.0 - cross @ inverse @ cross / (whole + 1e-30)))
        if whole > 0.0 and load > max(HIDES, found.get(block.key, (0.0,))[0]):
            found[block.key] = load, (*chosen, i)
    return [other for _, other in sorted(found.values(), key=lambda pair: -pair[0])][:most]


def determined(search: Search, chosen: Set) -> np.ndarray:
    """Which numbers of a set the logs tell (k,): those that cannot carry a load as large as the noise unseen."""
    columns = search.columns(chosen)
    square = search.G[np.ix_(columns, columns)]
    size = np.sqrt(np.diag(square)) + 1e-30
    own = 1.0 / np.diag(np.linalg.pinv(square / np.outer(size, size), rcond=1e-12, hermitian=True))
    blocks = np.concatenate([[i] * len(search.blocks[i].parameters) for i in chosen])
    return np.array([_unseen(search, int(i), float(part)) <= HIDES for i, part in zip(blocks, own, strict=True)])


def _unseen(search: Search, index: int, own: float) -> float:
    """Load over the noise that a block may carry unseen where `own` of its column's energy is shared with no other."""
    rows = float(search.rows[list(search.blocks[index].channels)].sum())
    return float(norm.isf(SWALLOWED / 2) * np.sqrt(search.widening[index] / (rows * max(own, 1e-12))))


def _misfit(search: Search, chosen: Set) -> float:
    return float(search.rows @ np.log(search.rss(chosen)))


def _named(search: Search, chosen: Set) -> frozenset[tuple[str, str]]:
    """Keys of the effects in a set; the model's own numbers are none."""
    return frozenset(search.blocks[i].key for i in chosen if not search.blocks[i].recalibration)


def _numbers(search: Search, chosen: Set) -> int:
    """How many numbers a set has."""
    return sum(search.blocks[i].size for i in chosen)


def _neighbours(search: Search, chosen: Set) -> Iterator[Set]:
    """Sets with one or two members left out, one put in their place, or one more; one with two in its place."""
    dropped: list[Set] = [(), *((i,) for i in chosen)]
    dropped += [
        (i, j)
        for a, i in enumerate(chosen)
        for j in chosen[a + 1 :]
        if set(search.blocks[i].channels) & set(search.blocks[j].channels)
    ]
    for drop in dropped:
        rest = tuple(i for i in chosen if i not in drop)
        if drop:
            yield rest
        for other in _with_another(search, chosen, rest, drop):
            yield other
            if len(drop) == 1:
                yield from islice(_with_another(search, chosen, other, drop), PAIRED)
        yield from _other_forms(search, chosen, rest, drop)
    yield from _halves(search, chosen)


def _with_another(search: Search, chosen: Set, rest: Set, drop: Set) -> Iterator[Set]:
    """What is left of a set with one more, that gains most, where something was left out."""
    touched = {c for i in drop for c in search.blocks[i].channels}
    tried: set[tuple[str, str]] = set()
    for i in (int(k) for k in np.argsort(-search.gains(rest) / search.widening)):
        new = search.blocks[i]
        if i in chosen or new.key in tried or (drop and not touched & set(new.channels)):
            continue
        if len(tried) == TRIED:
            break
        tried.add(new.key)
        gone = search.clash(i, rest)
        yield (*(j for j in rest if j not in gone), i)


def _other_forms(search: Search, chosen: Set, rest: Set, drop: Set) -> Iterator[Set]:
    """What is left of a set with a richer or a plainer form of what was left out."""
    for i, new in enumerate(search.blocks):
        if drop and i not in chosen and {search.blocks[j].target for j in drop} == {new.target}:
            related = {search.blocks[j].name for j in drop} & new.contains
            related |= {new.name} & frozenset.union(*(search.blocks[j].contains for j in drop))
            if related and not search.clash(i, rest):
                yield (*rest, i)


def _halves(search: Search, chosen: Set) -> Iterator[Set]:
    """Unequal friction as a level and an offset."""
    at = {b.key: i for i, b in enumerate(search.blocks) if not b.shape}
    for i in chosen:
        block = search.blocks[i]
        parts = [at.get((n, block.target)) for n in ("coulomb_friction", "offset")]
        if block.name == "asymmetric_friction" and None not in parts:
            yield tuple(dict.fromkeys([*(j for j in chosen if j != i), *(p for p in parts if p is not None)]))


def parting(
    search: Search, chosen: Set, other: Set, motions: dict[str, JointLog], floor: np.ndarray
) -> tuple[str, float]:
    """The motion in which two sets part most, with the numbers this log gives both.

    Args:
        search: knows the blocks.
        chosen: the one set.
        other: the other.
        motions: what could be run next: the sentence for the reader and the log it would give.
        floor: (C,) noise.

    Returns:
        (sentence, difference in the channel that shows it best, over its noise).
    """
    best = ("", 0.0)
    pair = [([search.blocks[i] for i in s], search.fit(s)) for s in (chosen, other)]
    for text, log in motions.items():
        a, b = (_load(blocks, theta, log, len(floor)) for blocks, theta in pair)
        apart = float(np.max(np.sqrt(np.mean((a - b) ** 2, axis=0)) / floor))
        if apart > best[1]:
            best = (text, apart)
    return best


def _load(blocks: Sequence[Block], theta: np.ndarray, log: JointLog, channels: int) -> np.ndarray:
    """What a set adds to the model in a log that is not kept, (T_inner, C)."""
    out, at = np.zeros((len(log.t[log.inner]), channels)), 0
    for block in blocks:
        n = len(block.parameters)
        out[:, list(block.channels)] += block.build(log) @ theta[at : at + n]
        forget(block, log.name)
        at += n
    return out
