"""Hidden cases of an arm that does not stand or read as its model has it: a tilted base, an encoder's zero that is off.

In half of those that hide either, one effect on a joint acts beside it; a third of the sets hide nothing.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import yaml

from ....sim.effects.joint.arm_geometry import BASE, with_tilted_base
from .arm_log import ArmReading, write_arm_log
from .case import Truth
from .joint_case import LEAST, ROBOTS, arm_motions, hidden_effect, inverse_dynamics

KINDS = ("none", "single", "two")
ANGLES = (0.01, 0.15)  # of tilts and zeros [rad]
NOT_BESIDE = {
    "delay",
    "payload",
    "wrong_tool",
}  # late is late for everything; tools have tables


def write_placement_case(seed: int, folder: Path) -> Truth:
    """Write one set of system `arm` into `folder` and return what it hides."""
    rng = np.random.default_rng([seed, 4])
    kind, robot = str(rng.choice(KINDS)), str(rng.choice(ROBOTS))
    rate, episodes = float(rng.choice([100.0, 200.0, 250.0])), int(rng.integers(3, 6))
    t = np.arange(0.0, rng.uniform(10.0, 20.0), 1.0 / rate)
    motions, names, arm = arm_motions(rng, robot, t, episodes)
    loads = [inverse_dynamics(*arm, m) for m in motions]
    clean = np.sqrt(np.mean(np.concatenate(loads) ** 2, axis=0))
    noise = np.maximum(clean, 0.1 * clean.max()) * rng.uniform(0.02, 0.06)
    truth = Truth(system="placement", seed=seed, kind=kind, robot=robot)
    added = [np.zeros_like(u) for u in loads]
    if kind != "none":
        effect, added = _placed(rng, motions, loads, noise, names, arm)
        truth.effects.append(effect)
    if kind == "two":
        size, name, target, values = 0.0, "", "", {}
        more: list[np.ndarray] = []
        while size < LEAST:
            name, target, _, more, size, values = hidden_effect(
                rng, "arm", kind, NOT_BESIDE, t, motions, loads, noise, names, arm
            )
        truth.effects.append({"name": name, "target": target, "size": size, "values": values})
        added = [x + y for x, y in zip(added, more, strict=True)]
    reading = ArmReading.drawn(rng, noise)
    entries = []
    for e, ((q, v, _), load, more_load) in enumerate(zip(motions, loads, added, strict=True)):
        file = folder / f"episode_{e + 1}.csv"
        write_arm_log(file, rng, t, (q, v), load + more_load, reading)
        entries.append({"file": file.name, "role": "heldout" if e >= episodes - max(1, episodes // 3) else "fit"})
    content = {"system": "arm", "robot": robot, "episodes": entries}
    (folder / "measurement.yaml").write_text(yaml.safe_dump(content, sort_keys=False))
    return truth


def _placed(
    rng: np.random.Generator,
    motions: list[tuple[np.ndarray, ...]],
    loads: list[np.ndarray],
    noise: np.ndarray,
    names: list[str],
    arm: tuple[Any, Any],
) -> tuple[dict[str, Any], list[np.ndarray]]:
    """A tilt or a zero that shows, and what it changes of the loads."""
    pin, model = arm
    while True:
        angle = float(np.exp(rng.uniform(*np.log(ANGLES))) * rng.choice((-1.0, 1.0)))
        if rng.random() < 0.5:
            about = rng.uniform(0.0, np.pi)
            values = {"about_x": angle * float(np.cos(about)), "about_y": angle * float(np.sin(about))}
            name, target = "base_tilt", BASE
            turned = [inverse_dynamics(pin, with_tilted_base(model, values), m) for m in motions]
        else:
            joint = int(rng.integers(len(names)))
            name, target, values = "encoder_offset", names[joint], {"angle": angle}
            at = angle * np.eye(len(names))[joint]
            turned = [inverse_dynamics(pin, model, (q + at, v, a)) for q, v, a in motions]
        added = [x - u for x, u in zip(turned, loads, strict=True)]
        size = float(np.max(np.sqrt(np.mean(np.concatenate(added) ** 2, axis=0)) / noise))
        if size >= LEAST:
            return {"name": name, "target": target, "size": size, "values": values}, added
