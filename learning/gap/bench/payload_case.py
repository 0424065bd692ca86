"""Hidden cases of an arm that takes up, puts down or exchanges its payload while it is recorded.

Masses are drawn up to what the robot is made to carry.  Half of the arms have friction on every joint beside, and a
third of the sets hide no change: then one payload, or none, is carried all the time.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from .arm_log import ArmReading, write_arm_log
from .case import Truth
from .joint_case import ROBOTS, arm_motions, inverse_dynamics

CARRIES = {"ur5": 5.0, "ur10": 10.0, "panda": 3.0, "z1": 2.0, "xarm7": 3.5}  # [kg], makers' data sheets
KINDS = ("constant", "change")
SHARES = (1 / 3, 2 / 3)
EMPTY = 0.5  # of the sets begin or end with an empty hand
APART = 0.15  # masses of one set differ by this part of what the robot carries, at least
KEPT = 0.5  # of the changes last through the recordings that follow, the others are undone before the next
AGAIN = 1 / 3  # of the held-out recordings of a change that lasts undo it half way
EDGE = 0.2  # a change lies this part of a recording away from its ends


@dataclass(frozen=True)
class _Body:
    """Something carried.  mass: [kg]; com: (3,) in the last joint's frame [m]."""

    mass: float
    com: np.ndarray


def write_payload_case(seed: int, folder: Path) -> Truth:
    """Write one set of system `arm` into `folder` and return what it hides.

    A change within a recording is told as `[episode, t, kg before, kg after]` in `changes`.
    """
    rng = np.random.default_rng([seed, 3])
    kind = str(rng.choice(KINDS, p=SHARES))
    robot = str(rng.choice(ROBOTS))
    rate, episodes = float(rng.choice([100.0, 200.0, 250.0])), int(rng.integers(2, 5))
    t = np.arange(0.0, rng.uniform(12.0, 40.0), 1.0 / rate)
    motions, names, (pin, model) = arm_motions(rng, robot, t, episodes)
    loads = [inverse_dynamics(pin, model, m) for m in motions]
    clean = np.sqrt(np.mean(np.concatenate(loads) ** 2, axis=0))
    noise = np.maximum(clean, 0.1 * clean.max()) * rng.uniform(0.02, 0.06)
    heldout = max(1, episodes // 3)
    bodies = _bodies(rng, robot, kind)
    spells, changes = _spells(rng, kind, t[-1], episodes, heldout, bodies)
    dry, viscous = (rng.uniform(0.5, 4.0, len(names)) * noise * (rng.random() < 0.5) for _ in range(2))
    speed = np.sqrt(np.mean(np.concatenate([v for _, v, _ in motions]) ** 2, axis=0)) + 1e-12
    reading = ArmReading.drawn(rng, noise)
    entries = []
    for e, ((q, v, a), load) in enumerate(zip(motions, loads, strict=True)):
        carried = [_carrying(pin, model, b, (q, v, a)) for b in bodies]
        held = np.searchsorted([at for at, _ in spells[e]], t, side="right") - 1
        which = np.array([body for _, body in spells[e]])[held]
        total = np.where((which == 1)[:, None], carried[1], carried[0]) + load
        total = total + dry * np.sign(v) + viscous * v / speed
        file = folder / f"episode_{e + 1}.csv"
        write_arm_log(file, rng, t, (q, v), total, reading)
        entries.append({"file": file.name, "role": "heldout" if e >= episodes - heldout else "fit"})
    content = {"system": "arm", "robot": robot, "episodes": entries}
    (folder / "measurement.yaml").write_text(yaml.safe_dump(content, sort_keys=False))
    effects = [
        {"name": "payload", "target": names[-1], "size": float("nan"), "values": {"mass": m}}
        for m in dict.fromkeys(b.mass for b in bodies)
        if m > 0.0
    ]
    return Truth(system="payload", seed=seed, kind=kind, robot=robot, effects=effects, changes=changes)


def _bodies(rng: np.random.Generator, robot: str, kind: str) -> list[_Body]:
    """What is carried first and then; without a change the same."""
    most = CARRIES[robot]
    masses = rng.uniform(0.1, 0.9, 2) * most
    masses[int(rng.integers(2))] *= float(rng.random() >= EMPTY)
    while kind == "change" and abs(masses[0] - masses[1]) < APART * most:
        masses[int(np.argmax(masses))] = rng.uniform(0.1, 0.9) * most
    reach = np.array([0.03, 0.03, 0.15])
    bodies = [_Body(float(m), rng.uniform([-1, -1, 0], 1) * reach) for m in masses]
    return bodies if kind == "change" else [bodies[0], bodies[0]]


def _spells(
    rng: np.random.Generator, kind: str, end: float, episodes: int, heldout: int, bodies: list[_Body]
) -> tuple[list[list[tuple[float, int]]], list[list[Any]]]:
    """Per recording from when on which body is carried [(s, 0 or 1)], and the changes."""
    spells: list[list[tuple[float, int]]] = [[(0.0, 0)] for _ in range(episodes)]
    if kind == "constant":
        return spells, []
    at = int(rng.integers(episodes - heldout))
    spells[at].append((float(rng.uniform(EDGE, 1.0 - EDGE) * end), 1))
    if rng.random() < KEPT:
        for e in range(at + 1, episodes):
            spells[e] = [(0.0, 1)]
            if e >= episodes - heldout and rng.random() < AGAIN:
                spells[e].append((float(rng.uniform(EDGE, 1.0 - EDGE) * end), 0))
    changes = [
        [f"episode_{e + 1}", t, bodies[a].mass, bodies[b].mass]
        for e, spell in enumerate(spells)
        for (_, a), (t, b) in pairwise(spell)
    ]
    return spells, changes


def _carrying(pin: Any, model: Any, body: _Body, motion: tuple[np.ndarray, ...]) -> np.ndarray:
    """What a body adds to the loads along a motion, (T, n)."""
    heavier = model.copy()
    last = model.njoints - 1
    heavier.inertias[last] = model.inertias[last] + pin.Inertia(body.mass, body.com, np.zeros((3, 3)))
    return inverse_dynamics(pin, heavier, motion) - inverse_dynamics(pin, model, motion)
