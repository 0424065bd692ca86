"""How small an effect this log could have shown: injected into the user's own measurements and searched for again."""

from __future__ import annotations

import numpy as np

from .search import Search


def smallest_found(search: Search, chosen: tuple[int, ...], index: int, theta: np.ndarray) -> float:
    """Smallest size at which block `index` is still chosen beside the others, in units of `theta`.

    The log with everything found taken out stands for a log without the effect; the effect is put into it at falling
    sizes and the search's own criterion is asked whether it would be named.

    Returns:
        Factor on `theta`; inf where even four times is not found.
    """
    rest = tuple(i for i in chosen if i != index)
    span = search.columns((index,))
    base = replace_residual(search, chosen)
    if index not in chosen:
        rest = chosen
    beside = np.maximum(search.yyc - base.yyc, 0.0)
    low, high = 0.0, 4.0
    if not _named(base, rest, index, span, theta * high, beside):
        return float("inf")
    for _ in range(9):
        middle = 0.5 * (low + high)
        if _named(base, rest, index, span, theta * middle, beside):
            high = middle
        else:
            low = middle
    return high


def replace_residual(search: Search, chosen: tuple[int, ...]) -> Search:
    """The same search on the residual with everything found taken out."""
    s, theta = search.columns(chosen), search.fit(chosen)
    gram = search.gram
    if not len(s):
        return search
    b = gram.b - gram.G[:, :, :, s] @ theta
    yy = (
        gram.yy
        - 2 * gram.b[:, :, s] @ theta
        + np.einsum("i,fcij,j->fc", theta, gram.G[:, :, s[:, None], s[None, :]], theta)
    )
    return search.with_residual(b, np.maximum(yy, 1e-12))


def _named(
    base: Search, rest: tuple[int, ...], index: int, span: np.ndarray, theta: np.ndarray, beside: np.ndarray
) -> bool:
    gram = base.gram
    extra = gram.G[:, :, :, span] @ theta
    inner = np.einsum("i,fcij,j->fc", theta, gram.G[:, :, span[:, None], span[None, :]], theta)
    yy = gram.yy + 2 * gram.b[:, :, span] @ theta + inner
    trial = base.with_residual(gram.b + extra, yy)
    with_it = (*rest, index)
    better = trial.score(with_it) < trial.score(rest) and trial.crossed(with_it, index, rest)
    return better and trial.weighty(with_it, index, rest, beside)
