"""What an arm's sensors make of a motion and its loads, as one file of a benchmark's set."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .case import STEPS, coloured


@dataclass(frozen=True)
class ArmReading:
    """How an arm is read.

    Attributes:
        noise: (n,) root mean square of the loads' noise [N m].
        step: (n,) to which loads are rounded [N m]; 0 for not at all.
        position_step: to which angles are rounded [rad]; 0 for not at all.
        speed: whether speeds are recorded too.
    """

    noise: np.ndarray
    step: np.ndarray
    position_step: float
    speed: bool

    @classmethod
    def drawn(cls, rng: np.random.Generator, noise: np.ndarray) -> ArmReading:
        """One of the readings there may be."""
        return cls(noise, noise * rng.choice(STEPS), float(rng.choice([0.0, 2e-5, 5e-5])), bool(rng.random() < 0.6))


def write_arm_log(
    file: Path,
    rng: np.random.Generator,
    t: np.ndarray,
    motion: tuple[np.ndarray, np.ndarray],
    loads: np.ndarray,
    reading: ArmReading,
) -> None:
    """Write what is read of a motion.

    Args:
        file: CSV.
        rng: of the noise.
        t: (T,) [s].
        motion: angles and speeds, (T, n) each [rad, rad/s].
        loads: (T, n) [N m].
        reading: how.
    """
    (q, v), step = motion, reading.step
    loads = loads + np.stack([coloured(rng, len(t), t[1], s) for s in reading.noise], axis=1)
    loads = np.where(step > 0, np.round(loads / np.where(step > 0, step, 1)) * step, loads)
    q = np.round(q / reading.position_step) * reading.position_step if reading.position_step > 0 else q
    v = v + 3e-4 * np.abs(v).max(axis=0) * rng.normal(size=v.shape)
    n = q.shape[1]
    table = {"t": t, **{f"q{j + 1}": q[:, j] for j in range(n)}}
    table |= {f"dq{j + 1}": v[:, j] for j in range(n)} if reading.speed else {}
    table |= {f"tau{j + 1}": loads[:, j] for j in range(n)}
    rows = np.stack(list(table.values()), axis=1)
    np.savetxt(file, rows, delimiter=",", header=",".join(table), comments="", fmt="%.8g")
