"""Recordings of the example systems with something hidden in them, as tables in memory."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from caretree.learning.gap.own.find_system import find_system
from caretree.learning.gap.own.system import System

EXAMPLES = Path(__file__).resolve().parents[4] / "docs" / "own-simulator"
EXAMPLE = {name: f"{EXAMPLES / file}:{kind}" for name, file, kind in (
    ("base", "base.py", "Base"), ("gripper", "gripper.py", "Gripper"),
    ("pendulum", "pendulum.py", "Pendulum"), ("arm", "arm.py", "Arm"),
)}  # fmt: skip
NOISE = {
    "base": (0.002, 0.002, 0.004),
    "gripper": (1e-4,),
    "pendulum": (1e-3,),
    "two_joints": (5e-4, 5e-4),
}


def waves(t, rng, *parts):
    """Sines of (size, frequency [Hz]) with phases of their own."""
    return sum(size * np.sin(2 * np.pi * f * t + rng.uniform(0, 6)) for size, f in parts)


def commands(name, rng):
    """Commands of one recording, and a start to predict from."""
    if name == "base":
        t = np.arange(0.0, 12.0, 0.05)
        left, right = 4.0 + waves(t, rng, (2, 0.11), (1.5, 0.3)), 4.0 + waves(t, rng, (2, 0.095), (1.5, 0.27))
        return {"t": t, "left": left, "right": right, **{c: np.zeros(len(t)) for c in ("x", "y", "yaw")}}
    if name == "gripper":
        t = np.arange(0.0, 10.0, 0.01)
        return {"t": t, "command": 0.04 + waves(t, rng, (0.02, 0.23), (0.012, 0.61)), "width": np.zeros(len(t))}
    t = np.arange(0.0, 5.0, 0.02)
    if name == "pendulum":
        torque = waves(t, rng, (1.2, 0.45), (0.8, 1.1))
        return {"t": t, "torque": torque, "q": np.full(len(t), 0.1 * rng.normal())}
    c1, c2 = waves(t, rng, (0.5, 0.3), (0.3, 0.69)), waves(t, rng, (0.5, 0.43), (0.3, 0.99))
    return {"t": t, "c1": c1, "c2": c2, "q1": np.full(len(t), c1[0]), "q2": np.full(len(t), c2[0])}


def tables(system: System, hidden, count=3, seed=100, extra=None):
    """`count` recordings with the hidden values; `extra(log, prediction)` adds what no effect of the class makes."""
    out = []
    for k in range(count):
        rng = np.random.default_rng([seed, k])
        log = commands(system.name, rng)
        none = {p.name: 0.0 for p in (*(p for e in system.effects for p in e.parameters), *system.start)}
        x = np.asarray(system.predict(log, none | hidden)).reshape(len(log["t"]), -1)
        for e in system.effects:
            for p in e.parameters:
                if e.regressor and hidden.get(p.name):
                    x = x + hidden[p.name] * np.asarray(e.regressor(log)).reshape(x.shape)
        if extra is not None:
            x = x + extra(log, x)
        for c, channel in enumerate(system.channels):
            log[channel] = x[:, c] + NOISE[system.name][c] * rng.normal(size=len(x))
        out.append(log)
    return out


def example(name: str) -> System:
    """One of the example systems."""
    return find_system(EXAMPLE[name])
