"""The payloads of an arm that does not carry the same all the time, as blocks of the search."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, pairwise

import numpy as np
from scipy.stats import chi2

from .....sim.effects.joint.link_inertia import BODY_TERMS
from ...findings import Change
from ..block import Block, body_block
from ..log import JointLog
from ..rigid import During, RigidModel, Spell
from ..search import Search
from ..thresholds import MATERIAL
from .course import LEAST, Span, during_of, lengths, told

MASS = "mass"  # of a body, one of the model's own numbers
RIDGE = 1e-6  # of a column's own square: what the registry says twice is shared out
DIFFERENT = 0.01  # chance that two payloads that are one are taken for two


@dataclass(frozen=True, kw_only=True)
class Carried:
    """The payloads of a set of recordings.

    Attributes:
        during: of each payload, when it is carried, in the order in which they are first.
        price: of one change's place, in the units of the search's criterion.
    """

    during: tuple[During, ...]
    price: float

    @property
    def cost(self) -> float:
        """Price of all changes, those from one recording to the next included."""
        course = []
        for name in self.during[0].spells:
            course += [k for _, k in sorted((a, k) for k, d in enumerate(self.during) for a, _ in d.of(name))]
        return self.price * sum(a != b for a, b in pairwise(course))

    def joined(self, first: int, second: int) -> Carried:
        """The same with two payloads taken for one."""
        a, b = self.during[first], self.during[second]
        one = During(spells={n: _fused([*a.of(n), *b.of(n)]) for n in a.spells}, last=a.last or b.last)
        rest = (one if k == first else d for k, d in enumerate(self.during) if k != second)
        return replace(self, during=tuple(rest))


@dataclass(frozen=True, kw_only=True, eq=False)
class Fit:
    """What was named, with its numbers.

    Attributes:
        blocks: in the order of their numbers.
        theta: (K,) their parameters, concatenated.
        weight: (C,) of the channels.
        model: of the arm.
    """

    blocks: Sequence[Block]
    theta: np.ndarray
    weight: np.ndarray
    model: RigidModel

    def each(self) -> Iterator[tuple[Block, np.ndarray]]:
        """Every block with its own numbers."""
        ends = np.cumsum([0, *(len(b.parameters) for b in self.blocks)])
        for block, a, b in zip(self.blocks, ends, ends[1:], strict=False):
            yield block, self.theta[a:b]


def _fused(spells: list[Spell]) -> tuple[Spell, ...]:
    """Spells in order; one that begins where another ends goes on."""
    out: list[Spell] = []
    for a, b in sorted(spells):
        if out and out[-1][1] == a:
            out[-1] = (out[-1][0], b)
        else:
            out.append((a, b))
    return tuple(out)


def with_payloads(blocks: list[Block], found: Carried, model: RigidModel) -> list[Block]:
    """Blocks in which every payload has its own, which may be lighter than what the model carries already.

    A wrong tool is what is carried all the time and left out: what it would say, every payload says.  Where the mass of
    the body that carries them is asked for as well, that is with what is carried at first, and payloads are beside it.
    """
    free = tuple(replace(p, lower=-np.inf) for p in model.payload.parameters)
    rest = [b for b in blocks if b.name not in BODY_TERMS]
    told = found.during[1:] if any(b.key == (MASS, model.payload.target) for b in rest) else found.during
    return [*rest, *(body_block(replace(model.payload, parameters=free, during=d), model) for d in told)]


def alike(found: Carried, search: Search, chosen: Sequence[int]) -> tuple[int, int] | None:
    """Two payloads of a named set whose masses could as well be one, beside all that was named; None if there are none.

    Centres alone may part: a joint's load that depends on where it is, as no effect does, moves them about.
    """
    columns = np.sort(search.columns(tuple(chosen)))
    mass: dict[int, int] = {}  # of each payload that is named, where its mass stands
    for i in chosen:
        term = search.blocks[i].term
        if term is not None and term.during is not None:
            mass[found.during.index(term.during)] = int(np.searchsorted(columns, search.columns((i,))[0]))
    wide = max((search.widening[i] for i in chosen), default=1.0)
    whole = _misfit(search, columns, np.eye(len(columns)))
    best: tuple[float, tuple[int, int] | None] = (np.inf, None)
    for a, b in combinations(range(len(found.during)), 2):
        tie = np.eye(len(columns))
        if a in mass and b in mass:
            tie[mass[b], mass[a]] = 1.0
        gone = mass.get(b, mass.get(a))  # beside one that is not named, a payload has to weigh something
        loss = 0.0 if gone is None else _misfit(search, columns, np.delete(tie, gone, axis=1)) - whole
        best = min(best, (loss, (a, b)), key=lambda x: x[0])
    return best[1] if best[0] < indistinct(search, wide, 1) else None


def _misfit(search: Search, columns: np.ndarray, tie: np.ndarray) -> float:
    """The criterion's first part of some columns whose numbers are tied to fewer."""
    theta = tie @ inverse(tie.T @ search.G[np.ix_(columns, columns)] @ tie) @ (tie.T @ search.b[columns])
    inner = search.Gc[:, columns[:, None], columns[None, :]]
    rss = search.yyc - 2 * search.bc[:, columns] @ theta + np.einsum("i,cij,j->c", theta, inner, theta)
    return float(search.rows @ np.log(np.maximum(rss, 1e-12 * search.yyc + 1e-30)))


def indistinct(search: Search, widening: float, numbers: int) -> float:
    """What two payloads have to gain on one, if they differ in so many numbers."""
    sure = float(chi2.isf(DIFFERENT, numbers)) * widening
    return max(sure, numbers * MATERIAL**2 * float(search.rows.mean()))


def inverse(A: np.ndarray) -> np.ndarray:
    """Inverse of products of columns (K, K), those that are nearly one another's included."""
    size = np.sqrt(np.maximum(np.diag(A), 0.0)) + 1e-12
    return np.linalg.inv(A / np.outer(size, size) + RIDGE * np.eye(len(A))) / np.outer(size, size)


def asked_again(found: Carried, fit: Fit, logs: list[JointLog]) -> Carried:
    """Which payload is carried when in the logs that were fitted to, beside what was named, not all that could be.

    Args:
        found: the payloads; those that are carried no more, or too briefly, are left out.
        fit: what was named.
        logs: the logs.
    """
    every = _told_beside(found, fit, logs)
    during = [during_of(k, every, logs, every[-1][-1][0] == k) for k in range(len(found.during))]
    long = [max(lengths(every, logs, k), default=0.0) >= LEAST for k in range(len(during))]
    if all(long):
        return replace(found, during=tuple(during))
    return replace(found, during=tuple(d for d, kept in zip(found.during, long, strict=True) if kept))


def told_in(found: Carried, fit: Fit, logs: list[JointLog]) -> tuple[Carried, tuple[Block, ...]]:
    """Which payload is carried when in logs held out; nothing but the times is taken from them.

    Args:
        found: the payloads of the logs that were fitted to.
        fit: what was named there.
        logs: the logs held out.

    Returns:
        The payloads and the blocks, which know of these logs too.
    """
    every = _told_beside(found, fit, logs)
    during = tuple(
        replace(d, spells={**d.spells, **during_of(k, every, logs, d.last).spells}) for k, d in enumerate(found.during)
    )
    now = dict(zip(map(id, found.during), during, strict=True))
    changed = tuple(
        body_block(replace(b.term, during=now[id(b.term.during)]), fit.model)
        if b.term is not None and b.term.during is not None
        else b
        for b in fit.blocks
    )
    return replace(found, during=during), changed


def _told_beside(found: Carried, fit: Fit, logs: list[JointLog]) -> list[list[Span]]:
    """By log, from when on which payload explains best what all other blocks leave."""
    every = []
    for log in logs:
        left = log.residual[log.inner].copy()
        loads = np.zeros((len(found.during), *left.shape))
        for block, numbers in fit.each():
            if block.term is not None and block.term.during is not None:
                always = body_block(replace(block.term, during=None), fit.model)
                loads[found.during.index(block.term.during)] = always.build(log) @ numbers
            else:
                left[:, list(block.channels)] -= block.build(log) @ numbers
        every.append(told(log, left, loads, fit.weight, found.price))
    return every


def changes_of(found: Carried, blocks: Sequence[Block], theta: np.ndarray, names: Sequence[str]) -> list[Change]:
    """Every change within a recording, in order, with the mass before and after it.

    Args:
        found: the payloads.
        blocks: what was named; a payload that is not among them weighs nothing that could be told.
        theta: its numbers.
        names: of the recordings.
    """
    return [
        Change(episode=name, t=t, before=before, after=after)
        for name in names
        for (_, before), (t, after) in pairwise(_masses(found, blocks, theta, name))
    ]


def carried_at_first(
    found: Carried, blocks: Sequence[Block], theta: np.ndarray, names: Sequence[str]
) -> list[tuple[str, float]]:
    """Name of every recording and the mass that is carried as it begins [kg]."""
    return [(name, _masses(found, blocks, theta, name)[0][1]) for name in names]


def _masses(found: Carried, blocks: Sequence[Block], theta: np.ndarray, name: str) -> list[tuple[float, float]]:
    """From when on which mass is carried in one recording, [s] and [kg]."""
    ends = np.cumsum([0, *(len(b.parameters) for b in blocks)])
    weighs = [
        next((float(theta[a]) for b, a in zip(blocks, ends, strict=False) if b.term and b.term.during is d), 0.0)
        for d in found.during
    ]
    return sorted((a, mass) for d, mass in zip(found.during, weighs, strict=True) for a, _ in d.of(name))
