"""A success rate with the interval that its number of trials supports."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ...sim.errors import CaretreeError

Z95 = 1.959964  # two-sided 95 % of the normal distribution


@dataclass(frozen=True, kw_only=True)
class SuccessRate:
    """Successes out of trials.

    Attributes:
        successes: at most `trials`.
        trials: may be 0, which says nothing.
    """

    successes: int
    trials: int

    def __post_init__(self) -> None:
        """Reject counts that cannot be."""
        if not 0 <= self.successes <= self.trials:
            raise CaretreeError(f"{self.successes} successes in {self.trials} trials cannot be")

    @property
    def rate(self) -> float | None:
        """Successes over trials; None without trials."""
        return self.successes / self.trials if self.trials else None

    def interval(self, z: float = Z95) -> tuple[float, float]:
        """Wilson's score interval, which stays inside [0, 1] and is honest for few trials."""
        n = self.trials
        if n == 0:
            return 0.0, 1.0
        share = self.successes / n
        middle = (share + z * z / (2 * n)) / (1 + z * z / n)
        half = z * math.sqrt(share * (1 - share) / n + z * z / (4 * n * n)) / (1 + z * z / n)
        return max(0.0, middle - half), min(1.0, middle + half)

    def __str__(self) -> str:
        """`9/10 = 90% [60, 98]`, or `-` without trials."""
        if self.rate is None:
            return "-"
        low, high = self.interval()
        return f"{self.successes}/{self.trials} = {100 * self.rate:.0f}% [{100 * low:.0f}, {100 * high:.0f}]"
