"""Which drops to record next: those under which the named set, its rivals and a drag outside the registry part most.

Every set predicts a drop with the numbers it was fitted with, as uncertain as the recorded drops leave them, and two
sets are as far apart as the nearest of what they could still predict, in standard deviations.  A drag outside the
registry bends over the speed as it likes; what a drop would tell of it is counted in nats.  Two kinds of drop are asked
for, the best of all pairs among these heights and masses.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from ....sim.effects.body.body_registry import BODY_EFFECTS
from ..findings import FollowUp
from .colour import colour
from .drop import GRAVITY, height
from .experiment import kinds, lateness
from .fit import DropFit, table_of, unpack
from .leftover import Fall, drag_ways
from .search import DropSearch

KINDS = 2
EACH = 3  # drops of a kind; two to fit and one to hold out
SAMPLES = 120  # of a drop thought of
LONGEST = 8.0  # [s]
WIDTH = {"rate": 1.0, "coefficient": 0.2, "fraction": 0.3, "speed": 6.0}  # of what a number may be beforehand
LATE = 0.3  # [s]
FORCE = 0.05 * GRAVITY  # [m/s^2] a piece of a drag outside the registry


@dataclass(frozen=True, kw_only=True)
class Look:
    """A drop, recorded or thought of.  t: (T,) [s]; white: (T, T) to standard deviations; when: its release [s]."""

    t: np.ndarray
    white: np.ndarray
    factor: float
    when: float | None = None


def follow_up(found: DropSearch, named: DropFit, rivals: Sequence[DropFit]) -> tuple[FollowUp, ...]:
    """The drops to record next.

    Args:
        found: the search.
        named: the set named.
        rivals: sets that fit as well.
    """
    sd = float(np.sqrt(named.rss / found.worth))
    # a drop of a body that would float under one of the sets is no drop
    wanted = [k for k in kinds(found.drops) if all(_sinks(f, k[1]) for f in (named, *rivals))]
    # all sampled alike and no longer than need be, so that one factor whitens them all
    ends = [_lands(named, h, f) for h, f in wanted]
    times = [np.linspace(0.0, max(ends), SAMPLES)[: max(int(SAMPLES * e / max(ends)), 8)] for e in ends]
    whites = colour(times, found.colour.memory, found.colour.slow).white
    new = [
        Look(t=t, white=w * np.sqrt(EACH) / sd, factor=f) for t, w, (_, f) in zip(times, whites, wanted, strict=True)
    ]
    old = [
        Look(t=d.t, white=np.eye(len(d.t)) if d.white is None else d.white / sd, factor=d.factor, when=r)
        for d, r in zip(found.drops, named.releases[:, 1], strict=True)
    ]
    before, after = _known(named, old), [_column(named, x) for x in new]
    grams = []
    for other in rivals:
        prior = _block(before, _known(other, old))
        both = zip(after, (_column(other, x) for x in new), strict=True)
        apart = [np.column_stack([a[:, 1:], b[:, 1:], a[:, 0] - b[:, 0]]) for a, b in both]
        grams.append((prior, np.stack([x.T @ x for x in apart])))
    free = _free(named, old, new)

    def tells(pair: tuple[int, ...]) -> float:
        parted = sum(np.log1p(_apart(prior, g[list(pair)].sum(axis=0))) for prior, g in grams)
        return float(parted) + _gain(*free, pair)

    best = max(combinations(range(len(new)), KINDS), key=tells)
    far = [np.sqrt(_apart(prior, g[list(best)].sum(axis=0))) for prior, g in grams]
    return tuple(
        FollowUp(
            kind="drop",
            height_m=float(f"{wanted[k][0]:.3g}"),
            mass_factor=wanted[k][1],
            drops=EACH,
            apart=float(min(far)) if far else None,
        )
        for k in best
    )


def _sinks(fit: DropFit, factor: float) -> bool:
    """Whether the body `factor` times as heavy is still falling at the end."""
    return bool(table_of(fit.values, LONGEST, factor)[0][-1, 2] > 0.0)


def _lands(fit: DropFit, top: float, factor: float) -> float:
    """How long a fall from `top` [m] takes [s]."""
    table, _ = table_of(fit.values, LONGEST, factor)
    return float(np.interp(top, table[:, 1], table[:, 0]))


def _column(fit: DropFit, look: Look) -> np.ndarray:
    """What a fit predicts of a drop and how that changes with its numbers, (T, 1 + p) in standard deviations."""
    late = fit.mode == "late"
    when = lateness(fit) if look.when is None else look.when

    def curve(theta: np.ndarray, when: float) -> np.ndarray:
        table, scale = table_of(unpack(fit.names, theta), float(look.t[-1]) + 1.0, look.factor)
        return scale * height(look.t, table, 0.0, when)[0]

    base = curve(fit.theta, when)
    columns = [base]
    for j in range(len(fit.theta)):
        step = np.eye(len(fit.theta))[j] * 1e-4 * max(abs(fit.theta[j]), 0.05)
        columns.append((curve(fit.theta + step, when) - base) / step[j])
    slip = (curve(fit.theta, when + 1e-4) - base) / 1e-4
    if late:
        columns.append(slip)
    lost = [np.ones(len(base))] + ([slip] if fit.mode == "free" else [])
    return _without(look.white @ np.column_stack(lost), look.white @ np.column_stack(columns))


def _without(lost: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """Columns without what every drop's own release takes up."""
    return columns - lost @ np.linalg.lstsq(lost, columns, rcond=None)[0]


def _known(fit: DropFit, old: Sequence[Look]) -> np.ndarray:
    """Information on a fit's numbers (p, p): from the recorded drops, and what they may be beforehand."""
    widths = [WIDTH[p.name] for n in fit.names for p in BODY_EFFECTS[n].parameters]
    widths += [LATE] if fit.mode == "late" else []
    info = np.diag(1.0 / np.array(widths) ** 2) if widths else np.zeros((0, 0))
    for look in old:
        J = _column(fit, look)[:, 1:]
        info = info + J.T @ J
    return info


def _block(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    out = np.zeros((len(a) + len(b), len(a) + len(b)))
    out[: len(a), : len(a)], out[len(a) :, len(a) :] = a, b
    return out


def _apart(prior: np.ndarray, gram: np.ndarray) -> float:
    """Squared distance between two sets, numbers of both at their nearest."""
    across = gram[:-1, -1]
    return max(float(gram[-1, -1] - across @ np.linalg.solve(prior + gram[:-1, :-1], across)), 0.0)


def _free(named: DropFit, old: Sequence[Look], new: Sequence[Look]) -> tuple[np.ndarray, np.ndarray, int]:
    """Information on a set's numbers and a free drag: what there is, what each new look adds, the set's count."""
    looks = [*old, *new]
    falls = [Fall(since=np.maximum(x.t - (x.when or 0.0), 0.0), factor=x.factor) for x in looks]
    pieces = drag_ways(named.values, falls)
    grams, at = [], 0
    for look in looks:
        rows = slice(at, at + len(look.t))
        at += len(look.t)
        force = _without(look.white @ np.ones((len(look.t), 1)), look.white @ pieces[rows])
        both = np.column_stack([_column(named, look)[:, 1:], force])
        grams.append(both.T @ both)
    own = len(grams[0]) - pieces.shape[1]
    prior = _block(_known(named, []), np.eye(pieces.shape[1]) / FORCE**2)
    return prior + np.sum(grams[: len(old)], axis=0), np.stack(grams[len(old) :]), own


def _gain(known: np.ndarray, added: np.ndarray, own: int, pair: tuple[int, ...]) -> float:
    """Nats some new looks tell of a free drag."""
    after = known + added[list(pair)].sum(axis=0)
    return 0.5 * (_volume(after) - _volume(known) - _volume(after[:own, :own]) + _volume(known[:own, :own]))


def _volume(information: np.ndarray) -> float:
    return float(np.linalg.slogdet(information)[1]) if len(information) else 0.0
