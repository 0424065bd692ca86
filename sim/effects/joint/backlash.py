"""Play in a gear: after each reversal the motor moves through a gap while the load is not carried."""

from __future__ import annotations

import numpy as np

from ..effect import JointEffect, JointMotion, Parameter, Shape, Spread

TREMBLE = 0.1  # of the gap


def distance_since_reversal(q: np.ndarray, dead: float) -> np.ndarray:
    """How far the joint has moved since it last turned, (T,); turns smaller than `dead` do not count."""
    out = np.full(len(q), np.inf)  # before the first reversal the gap is taken as closed
    turn, best, sign, at = q[0], q[0], 0.0, 0
    seen = False
    for i, x in enumerate(q):
        if sign == 0.0:
            if abs(x - turn) > dead:
                sign, best, at = np.sign(x - turn), x, i
        elif sign * (x - best) >= 0:
            best, at = x, i
        elif abs(x - best) > dead:
            # the rows since the turn are known to be beyond it only now; slow as they are, they are many
            first = at if _turned(q, at) else at + 1
            out[first:i] = np.abs(q[first:i] - best)
            turn, sign, best, at, seen = best, -sign, x, i, True
        if seen:
            out[i] = abs(x - turn)
    return out


def _turned(q: np.ndarray, at: int) -> bool:
    """Whether the joint had turned by the row that lies farthest out: it came a shorter way to it than it goes on."""
    return at > 0 and abs(q[at] - q[at - 1]) < abs(q[at + 1] - q[at])


class Backlash(JointEffect):
    """Load `-fraction * load_model` while the joint is within `width` of its last reversal."""

    name = "backlash"
    linear = (Parameter(name="fraction", unit="1", lower=0.0, upper=1.5),)
    shape = (Parameter(name="width", unit="x", lower=0.0),)
    memoryless = False
    sharp = True
    sentence = "play: the load is not carried just after a reversal"

    def columns(self, motion: JointMotion, shape: Shape) -> np.ndarray:
        """Minus the rigid load inside the gap, (T, 1)."""
        width = max(shape["width"], 1e-12)
        # a joint that rests trembles, or its smoothed position does: a tenth of the gap is no turn
        travelled = distance_since_reversal(motion.q, max(1e-4 * float(np.ptp(motion.q)), TREMBLE * width, 1e-13))
        inside = 0.5 * (1.0 - np.tanh((travelled - width) / (0.1 * width)))
        return -(motion.load * inside)[:, None]

    def shapes(self, spread: Spread) -> list[Shape]:
        """Gaps from 0.2 % to 6 % of the range of motion."""
        reach = spread.q[1] - spread.q[0]
        return [{"width": reach * w} for w in (0.002, 0.005, 0.012, 0.025, 0.06)]
