"""What recordings that nothing was chosen on say of two sets of effects.

The search takes the best of very many hypotheses, so on the logs it searched a set it wrongly took fits noticeably
better than the right one: it would not have been taken otherwise.  On other logs, with the numbers of the first, that
advantage is gone, and what a real effect explains is there again.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.stats import chi2

from .gram import Gram, assemble
from .log import JointLog
from .search import Search, Set

LEVEL = 0.05  # chance that noise alone makes the logs not searched prefer the right one of two sets by as little
DECISIVE = 3.0  # what the searched logs have against a set, over the price of what it lacks, that settles it


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
