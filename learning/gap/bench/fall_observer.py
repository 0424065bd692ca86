"""What an ideal observer would name from a benchmark drop: the most any method could.

It knows the noise's covariance, how often each kind of case is drawn, from what range its sizes come, and even the
forms outside the registry, and picks the set with the largest evidence.  Nobody who measures knows any of this, so what
this observer misses is not in the data.

The evidence is Laplace's, over the logarithm of each effect's value; a direction the drops say nothing about is worth
the whole range it was drawn from.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path

import numpy as np
from scipy.optimize import least_squares

from .case import KINDS, SHARES
from .fall_case import ALIKE, INSIDE, LARGEST, OUTSIDE, UPDRAFT, Drawn, draw_fall, sizes_of, way_of
from .score import interval

SPAN = 12.0  # natural logarithm of the largest value over the smallest tried
Set = tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class Seen:
    """What the observer says.  named: the set, or () for none; right: whether that is the truth (`unknown` outside)."""

    named: Set
    right: bool
    chance: float


def report(seeds: Sequence[int], out: Path, say: Callable[[str], None]) -> list[str]:
    """Rates of the observer on pairs, single effects of size 2 and more and effects outside the registry."""
    tally: dict[str, list[float]] = {}
    for seed in seeds:
        folder = out / "observer" / f"fall_{seed:05d}"
        file = folder / "seen.json"
        if not file.is_file():
            folder.mkdir(parents=True, exist_ok=True)
            truth, drawn = draw_fall(seed, folder)
            asked = truth.kind in ("two", "outside") or (truth.kind == "single" and truth.effects[0]["size"] >= 2.0)
            if asked:
                seen = observe(truth.kind, drawn)
                row = {"kind": truth.kind, "named": seen.named, "right": seen.right, "chance": seen.chance}
            else:
                row = {"kind": ""}
            file.write_text(json.dumps(row))
        row = json.loads(file.read_text())
        if row["kind"]:
            say(f"observer fall {seed} {row['kind']}: {' + '.join(row['named']) or 'nothing'}, right {row['right']}")
            tally.setdefault(row["kind"], []).append(float(row["right"]))
    lines = []
    for kind, hits in tally.items():
        low, high = interval(int(sum(hits)), len(hits))
        lines.append(
            f"{'ideal observer, ' + kind:52s} fall   {int(sum(hits)):4d}/{len(hits):4d}  "
            f"{np.mean(hits):.3f} ({low:.3f} to {high:.3f})"
        )
    return lines


def observe(kind: str, drawn: Drawn) -> Seen:
    """Weigh every set the benchmark could have hidden.

    Args:
        kind: of the case, to judge the answer.
        drawn: the drops and what is hidden in them.
    """
    share = dict(zip(KINDS, SHARES, strict=True))
    pairs = [p for p in combinations(INSIDE, 2) if set(p) not in ALIKE]
    prior: dict[Set, tuple[str, float]] = {(): ("none", share["none"] + share["recalibration"])}
    prior |= {(n,): ("single", share["single"] / len(INSIDE)) for n in INSIDE}
    prior |= {p: ("two", share["two"] / len(pairs)) for p in pairs}
    prior |= {(n,): ("outside", share["outside"] / len(OUTSIDE)) for n in OUTSIDE}
    weight = {s: _evidence(s, k, drawn) + np.log(p) for s, (k, p) in prior.items()}
    total = np.logaddexp.reduce(list(weight.values()))
    named = max(weight, key=lambda s: weight[s])
    foreign = [weight[(n,)] for n in OUTSIDE]
    if kind == "outside":
        return Seen(named=named, right=named[:1] in [(n,) for n in OUTSIDE], chance=_part(foreign, total))
    mine = [w for s, w in weight.items() if set(s) == set(drawn.names)]
    return Seen(named=named, right=set(named) == set(drawn.names), chance=_part(mine, total))


def _part(weights: list[float], total: float) -> float:
    return float(np.exp(np.logaddexp.reduce(weights) - total)) if weights else 0.0


def _evidence(names: Set, kind: str, drawn: Drawn) -> float:
    """Logarithm of the evidence of one set, up to a constant."""
    free = [n for n in names if not (n == "buoyancy" and drawn.lift)]
    windy = "wind" in names
    count = len(free) + windy
    low, high = sizes_of(kind)
    width = np.array([np.log(high / low) / SPAN] * len(free) + [1.0] * windy)  # of each range drawn from
    best = -np.inf
    for sign in (1.0, -1.0) if windy else (1.0,):

        def values(u: np.ndarray, sign: float = sign) -> dict[str, float]:
            out = {n: LARGEST[n] * float(np.exp(-SPAN * (1.0 - x))) for n, x in zip(free, u, strict=False)}
            if "buoyancy" in names and drawn.lift:
                out["buoyancy"] = drawn.lift
            if windy:
                out["updraft"] = sign * float(UPDRAFT[0] + (UPDRAFT[1] - UPDRAFT[0]) * u[-1])
            return out

        def residual(u: np.ndarray, values: Callable[[np.ndarray], dict[str, float]] = values) -> np.ndarray:
            return _residual(values(u), drawn)

        if not count:
            return -0.5 * float(np.sum(residual(np.zeros(0)) ** 2))
        for start in (0.6, 0.75, 0.88) if count <= 2 else (0.65, 0.82):
            first = np.full(count, start)
            if windy:
                first[-1] = 0.5
            solved = least_squares(residual, first, bounds=(0.0, 1.0), max_nfev=40, diff_step=1e-4)
            J = solved.jac * width
            curved = np.maximum(np.linalg.eigvalsh(J.T @ J), 1e-9)
            occam = float(np.sum(np.minimum(0.0, 0.5 * np.log(2.0 * np.pi / curved))))
            best = max(best, -float(solved.cost) + occam - (np.log(2.0) if windy else 0.0))
    return best


def _residual(values: dict[str, float], drawn: Drawn) -> np.ndarray:
    """What remains of all drops in independent units of the noise, every height of release free."""
    since, way = way_of(values, drawn.until)
    out = []
    for t, h, white in drawn.drops:
        model = (1.0 + values.get("gain_error", 0.0)) * np.interp(t - values.get("delay", 0.0), since, way)
        a, b = white @ (h - model), white @ np.ones(len(t))
        out.append(a - b * (a @ b) / (b @ b))
    return np.concatenate(out)
