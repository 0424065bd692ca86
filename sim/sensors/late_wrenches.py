"""Force sensors that tell late what pulls on the hands."""

from __future__ import annotations

from collections import deque

import numpy as np


class LateWrenches:
    """Loads on the hands as they were a while ago.

    Args:
        delay: how long ago [s].
    """

    def __init__(self, delay: float) -> None:
        self._delay = delay
        self._kept: deque[tuple[float, np.ndarray]] = deque()

    def measured(self, wrench: np.ndarray, time: float) -> np.ndarray:
        """(2, 6) what the sensors tell at `time` [s], straight between what pulled whenever this was asked.

        Args:
            wrench: (2, 6) what pulls on the hands now [N], [N m].
            time: world clock, not earlier than at the last call [s].
        """
        self._kept.append((time, wrench.copy()))
        ago = time - self._delay
        while len(self._kept) > 1 and self._kept[1][0] <= ago:
            self._kept.popleft()
        (t0, before), (t1, after) = self._kept[0], self._kept[min(1, len(self._kept) - 1)]
        if t1 <= t0 or ago <= t0:
            return before.copy()
        return before + (after - before) * (ago - t0) / (t1 - t0)
