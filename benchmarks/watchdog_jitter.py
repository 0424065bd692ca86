"""How evenly the watchdog looks, and how soon it stops a robot whose tree no longer ticks.

    python benchmarks/watchdog_jitter.py [SECONDS]

The tree's thread meanwhile rests, computes in Python, multiplies matrices, or sorts a list, which holds the
interpreter.
"""

import sys
import time
from collections.abc import Callable

import numpy as np
from caretree.trees.guard.limits import DEFAULT
from caretree.trees.guard.tick_watchdog import PERIOD, TickWatchdog

SECONDS = float(sys.argv[1]) if len(sys.argv) > 1 else 5.0
BLOCKS = 10
A = np.random.default_rng(100).standard_normal((400, 400))
NUMBERS = A.ravel().tolist()
LOADS: dict[str, Callable[[], object]] = {
    "rests": lambda: time.sleep(0.05),
    "computes in Python": lambda: sum(k * k for k in range(100_000)),
    "multiplies matrices": lambda: A @ A,
    "sorts 160 000 numbers": lambda: sorted(NUMBERS),
}


def measure(work: Callable[[], object]) -> tuple[np.ndarray, list[float]]:
    """Times between two looks [s], and from the last tick to the first stop [s]."""
    looks: list[float] = []
    stops: list[float] = []
    after: list[float] = []

    class Watched(TickWatchdog):
        def look(self) -> bool:
            looks.append(time.monotonic())
            return super().look()

    with Watched(lambda: stops.append(time.monotonic())) as dog:
        for _ in range(BLOCKS):
            dog.ticked()
            dog.sampled()
            began = time.monotonic()
            stops.clear()
            while time.monotonic() - began < SECONDS / BLOCKS:
                work()
            after.append(stops[0] - began if stops else float("nan"))
    return np.diff(looks), after


for name, work in LOADS.items():
    gaps, after = measure(work)
    p50, p99, longest = 1e3 * np.percentile(gaps, (50, 99, 100))
    print(
        f"the tree {name:22} looks every {p50:5.2f} ms (99 %: {p99:6.2f} ms, longest {longest:6.2f} ms, asked for "
        f"{1e3 * PERIOD:g} ms); stopped {min(after):.3f} to {max(after):.3f} s after the last tick (limit "
        f"{DEFAULT.late_tick:g} s)"
    )
