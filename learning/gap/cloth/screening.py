"""What hypotheses would explain at first order: one or two simulations each, at a size that can be compared.

A push that moves the cloth much farther than there is to explain says little of a small one: contact is lost, air
brakes with the square, cloth buckles.  Such a push is made smaller and simulated once more.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from .candidates import Candidate, is_moment
from .fitting import ClothFitter, ClothModel, scaled

FAR = 3.0  # times what is to be explained, beyond which a push is made smaller


@dataclass(frozen=True, kw_only=True)
class Probe:
    """One hypothesis beside a model.

    Attributes:
        candidate: with the push that was simulated last.
        start: (rows,) weighted residual with the hypothesis at zero size.
        columns: (rows, k) what each of its numbers takes out of that when pushed; of a moment, which has no size, what
            the push itself does.
    """

    candidate: Candidate
    start: np.ndarray
    columns: np.ndarray

    @property
    def moment(self) -> bool:
        """Whether it is an instant, of which the simulation itself is the answer."""
        return is_moment(self.candidate)


def probe(fitter: ClothFitter, model: ClothModel, pool: list[Candidate], most: float) -> list[Probe]:
    """Each hypothesis beside a model, pushed so far that it moves the cloth about as much as is to be explained.

    Args:
        fitter: of the recordings they are compared on.
        model: what acts already.
        pool: the hypotheses.
        most: root of the weighted sum of squares that is to be explained.
    """
    first = _pushed(fitter, model, pool)
    closer = [_nearer(p, most) for p in first]
    again = iter(_pushed(fitter, model, [c for c in closer if c is not None]))
    return [p if c is None else next(again) for p, c in zip(first, closer, strict=True)]


def _pushed(fitter: ClothFitter, model: ClothModel, pool: list[Candidate]) -> list[Probe]:
    runs = [model.joined(c.start.moved({f: c.push.value(f)})) for c in pool for f in c.start.free]
    fitter.sim.ahead([(e, m.acting, m.physics) for m in runs for e in fitter.episodes])
    out = []
    for c in pool:
        base = model.joined(c.start)
        start = fitter.flat(fitter.residuals(base))
        columns = [start - fitter.flat(fitter.residuals(base.moved({f: c.push.value(f)}))) for f in c.start.free]
        out.append(Probe(candidate=c, start=start, columns=np.stack(columns, axis=1)))
    return out


def _nearer(p: Probe, most: float) -> Candidate | None:
    """The hypothesis with a smaller push, or None where the one it had is small enough."""
    far = float(np.linalg.norm(p.columns, axis=0).max()) / (most + 1e-30)
    if p.moment or far < FAR:
        return None
    c, factor = p.candidate, far ** (-1.0 / p.candidate.power)
    return replace(c, push=scaled(c.push, factor, c.start), steps={f: factor * s for f, s in c.steps.items()})


def sized(p: Probe, rest: np.ndarray, start: np.ndarray) -> tuple[Candidate | None, float]:
    """A hypothesis at the size it wants beside other columns; None where it would have to act the wrong way round.

    Args:
        p: the hypothesis.
        rest: (rows, j) columns of numbers that move along.
        start: (rows,) weighted residual without it.

    Returns:
        The hypothesis, with that push and steps to go with it, and the weighted sum of squares left.
    """
    X, c = np.concatenate([rest, p.columns], axis=1), p.candidate
    theta = np.linalg.lstsq(X, start, rcond=1e-8)[0]
    left = float(np.sum((start - X @ theta) ** 2))
    mine = theta[rest.shape[1] :]
    mine = mine * max(float(np.linalg.norm(mine)), 1.0) ** (1.0 / c.power - 1.0)
    begin = {f: c.start.value(f) for f in c.start.free}
    push = c.push.moved(
        {
            f: x + float(np.clip(k, -30.0, 30.0)) * (c.push.value(f) - x)
            for (f, x), k in zip(begin.items(), mine, strict=True)
        }
    )
    moved = {f: abs(push.value(f) - x) for f, x in begin.items()}
    if all(x < 1e-9 for x in moved.values()):
        return None, left
    steps = {f: max(0.3 * moved[f] + 1e-6, 0.1 * abs(s)) for f, s in c.steps.items()}
    return replace(c, push=push, steps=steps), left


def screened(
    fitter: ClothFitter, model: ClothModel, own: np.ndarray, pool: list[Candidate], most: float
) -> tuple[list[Candidate], dict[str, float]]:
    """Hypotheses by how much they would explain beside a model at first order, best first, one of each name.

    Args:
        fitter: of the recordings they are compared on.
        model: what acts already.
        own: (rows, j) columns of its numbers.
        pool: the hypotheses.
        most: root of the weighted sum of squares that is to be explained.

    Returns:
        The hypotheses, at the size that they want, and the weighted sum of squares that each would leave.
    """
    scored = []
    for p in probe(fitter, model, pool, most):
        if p.moment:
            scored.append((float(np.sum((p.start - p.columns[:, 0]) ** 2)), p.candidate))
            continue
        c, left = sized(p, own, p.start)
        if c is not None:
            scored.append((left, c))
    scored.sort(key=lambda pair: pair[0])
    firsts: dict[str, Candidate] = {}
    lefts: dict[str, float] = {}
    for left, c in scored:
        firsts.setdefault(c.name, c)
        lefts.setdefault(c.name, left)
    return list(firsts.values()), lefts
