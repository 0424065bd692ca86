"""Numbers of states and oracles."""

from __future__ import annotations

from dataclasses import dataclass

from ...sim.quantity import Quantities, quantity


@dataclass(frozen=True, kw_only=True)
class HangNumbers(Quantities):
    """How a gown comes to hang from one hand."""

    step: float = quantity(0.0025, "s", "of the springs", "choice: the step of the dressing room")
    swing: float = quantity(0.8, "m/s", "standard deviation of the speeds with which it is let go", "choice: it folds")
    bulges: int = quantity(4, "1", "waves of that speed over the gown", "choice: folds of a hand's width and more")
    air_drag: float = quantity(1.5, "N s^2/m^4", "while it swings out", "choice: five times air, to wait less")
    calm: float = quantity(0.8, "s", "in which the swing is damped to 37 %", "choice: less than half a swing")
    time: float = quantity(3.5, "s", "that it swings out", "choice: then all gowns move by 1 cm/s at most")
    deepest: float = quantity(
        0.25, "1", "share of the neckline at each end that a deep grasp spares", "choice: its middle half"
    )
    gather: float = quantity(0.3, "1", "share of their distance at which held vertices are pinched", "choice: fingers")


HANG = HangNumbers()
# which actions are tried: every one; no more than tells the ceiling; some near the corner, drawn by seed; none
ORACLES = ("all", "ceiling", "drawn", "none")
# whose cloth a gown has: what was identified from a clip of it, what the clip was made with, what the paper's
# baseline 4 takes for it, and one that the seed draws from the whole range (baseline 5)
PHYSICS = ("identified", "true", "tuned", "random")
