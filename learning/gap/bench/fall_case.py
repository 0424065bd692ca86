"""Hidden cases for a dropped body: integrated step by step, heights with camera noise."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from .case import STEPS, Truth, coloured_as, draw_kind, rounded
from .fall_oracle import apart, precision

INSIDE = ("linear_drag", "quadratic_drag", "buoyancy", "wind", "gain_error", "delay")
OUTSIDE = ("gust", "cubic_drag", "swing")
ALIKE = ({"buoyancy", "gain_error"}, {"quadratic_drag", "wind"})  # one is the other by construction
AIR = ("linear_drag", "quadratic_drag", "buoyancy", "wind", "gust", "cubic_drag", "swing")  # forces, not readings
UPDRAFT = (2.0, 6.0)  # [m/s] up or down
LARGEST = {
    "linear_drag": 3.0,
    "quadratic_drag": 1.0,
    "buoyancy": 0.9,
    "wind": 1.0,
    "gain_error": 0.5,
    "delay": 0.5,
    "gust": 60.0,
    "cubic_drag": 0.2,
    "swing": 30.0,
}  # values tried


@dataclass(frozen=True, kw_only=True)
class Drawn:
    """The fitted drops of a case and what an observer who drew it knows.

    Attributes:
        names: hidden effects.
        drops: time [s], measured height [m], and the matrix (T, T) that makes the noise white and of unit size.
        clean: heights without noise [m].
        lift: buoyancy a stated size and mass imply, or None.
        until: longest time since release that is needed [s].
        values: the truth's numbers, per mass of the body as it is.
        noise: root mean square [m].
        step: of the instrument [m], 0 for a perfect one.
        rate: samples per second.
        top: the highest release [m].
        mass: of the body as it is [kg].
    """

    names: tuple[str, ...]
    drops: tuple[tuple[np.ndarray, np.ndarray, np.ndarray], ...]
    clean: tuple[np.ndarray, ...]
    lift: float | None
    until: float
    values: dict[str, float]
    noise: float
    step: float
    rate: float
    top: float
    mass: float


def write_fall_case(seed: int, folder: Path) -> Truth:
    """Write one set for `fall` into `folder` and return what it hides."""
    truth, drawn = draw_fall(seed, folder)
    if drawn.names:
        seen = [(t, clean, white) for (t, _, white), clean in zip(drawn.drops, drawn.clean, strict=True)]
        truth.apart = apart(drawn.names, seen, lambda v: way_of(v, drawn.until), drawn.lift)
    return truth


def sizes_of(kind: str) -> tuple[float, float]:
    """Range the sizes of a kind of case are drawn from, over the noise.

    Two effects of a few times the noise are mostly one smooth curve, so pairs are drawn up to where they part, and what
    the registry lacks mostly looks like a set of it, so it is drawn as far.
    """
    return (2.0, 100.0) if kind in ("two", "outside") else (0.5, 8.0)


def way_of(values: dict[str, float], until: float) -> tuple[np.ndarray, np.ndarray]:
    """Time since release [s] and height above the release [m], from far enough up not to land."""
    grid, path = _path(values, 1e4, 0.005, until)
    return grid, path - 1e4


def draw_fall(seed: int, folder: Path) -> tuple[Truth, Drawn]:
    """Write one set into `folder`; return what it hides, and all that was drawn."""
    rng = np.random.default_rng([seed, 2])
    kind = draw_kind(rng)
    kind = "none" if kind == "recalibration" else kind
    truth = Truth(system="fall", seed=seed, kind=kind)
    rate, top = float(rng.choice([15.0, 30.0, 60.0, 120.0])), rng.uniform(8.0, 50.0)
    episodes = int(rng.integers(4, 8))
    noise = rng.uniform(0.01, 0.05)
    names = _draw_names(rng, kind)
    low, high = sizes_of(kind)
    size = {n: float(np.exp(rng.uniform(np.log(low), np.log(high)))) for n in names}
    values = {"updraft": float(rng.choice([-1, 1]) * rng.uniform(*UPDRAFT))} if "wind" in names else {}
    values |= _set_values(names, size, values, lambda v: _fly(v, top, rate), noise)
    truth.effects = [
        {"name": n, "target": "body", "size": size[n], "value": float(values[n]), "values": _parameters(n, values)}
        for n in names
    ]
    known, lift = _draw_ball(rng, values.get("buoyancy"))
    if known:
        values["buoyancy"] = lift  # of air: too small to see, and not missing from a model that knows size and mass
    step = noise * float(np.random.default_rng([seed, 2, 1]).choice(STEPS))
    entries, seen, cleans = [], [], []
    for e in range(episodes):
        clean = _fly(values, top * rng.uniform(0.85, 1.0), rate)
        t = np.arange(len(clean)) / rate
        wiggle, memory, slow = coloured_as(rng, len(clean), 1.0 / rate, noise)
        h = rounded(clean + wiggle, step)
        heldout = e >= episodes - max(1, episodes // 3)
        if not heldout:
            seen.append((t, h, precision(len(t), 1.0 / rate, noise, memory, slow)))
            cleans.append(clean)
        entries.append({**_write(folder, e + 1, rate, h), "role": "heldout" if heldout else "fit"})
    content = {"system": "fall", **known, "episodes": entries}
    (folder / "measurement.yaml").write_text(yaml.safe_dump(content, sort_keys=False))
    return truth, Drawn(
        names=tuple(names),
        drops=tuple(seen),
        clean=tuple(cleans),
        lift=lift if known and names else None,
        until=max(float(d[0][-1]) for d in seen) + 0.5,
        values=values,
        noise=noise,
        step=step,
        rate=rate,
        top=top,
        mass=known.get("mass", 0.5),
    )


def _draw_names(rng: np.random.Generator, kind: str) -> list[str]:
    """The effects a kind of case hides."""
    if kind == "none":
        return []
    pool = OUTSIDE if kind == "outside" else INSIDE
    names = [str(n) for n in rng.choice(pool, size=2 if kind == "two" else 1, replace=False)]
    return [names[0], "delay"] if set(names) in ALIKE else names


def _set_values(
    names: list[str],
    size: dict[str, float],
    air: dict[str, float],
    fly: Callable[[dict[str, float]], np.ndarray],
    noise: float,
) -> dict[str, float]:
    """Value of each effect at which the root mean square change of the drop, over the noise, is its size.

    Args:
        names: of the effects.
        size: of each; lowered where the largest value does not reach it.
        air: what acts beside them.
        fly: heights [m] under some values.
        noise: root mean square [m].
    """
    values, plain = {}, fly({})
    for n in names:
        low, high = 0.0, LARGEST[n]
        change = 0.0
        for _ in range(24):
            middle = 0.5 * (low + high)
            other = fly({**air, n: middle})
            both = min(len(other), len(plain))
            change = float(np.sqrt(np.mean((other[:both] - plain[:both]) ** 2)))
            low, high = (middle, high) if change < size[n] * noise else (low, middle)
        values[n] = high
        size[n] = min(size[n], 1.05 * change / noise)  # a body can only be braked so much
    return values


PARAMETERS = {
    "linear_drag": "rate",
    "quadratic_drag": "coefficient",
    "wind": "coefficient",
    "buoyancy": "fraction",
    "gain_error": "fraction",
    "delay": "time",
}  # the registry's name of each value


def _parameters(name: str, values: dict[str, float]) -> dict[str, float]:
    """The registry's parameters of a hidden effect; {} outside the registry."""
    if name not in PARAMETERS:
        return {}
    return {PARAMETERS[name]: float(values[name]), **({"speed": values["updraft"]} if name == "wind" else {})}


def _draw_ball(rng: np.random.Generator, lift: float | None) -> tuple[dict[str, float], float]:
    """Diameter [m] and mass [kg] of a ball that has this buoyancy, and the buoyancy; {} for a body of unknown size.

    Args:
        rng: draws.
        lift: buoyancy the case hides; None where it hides none, then half of the bodies are balls.
    """
    if lift is None and rng.random() >= 0.5:
        return {}, 0.0
    diameter = rng.uniform(0.05, 0.4)
    of_air = 1.2 / rng.uniform(8000.0, 20000.0)  # drawn in any case, so that the draws that follow stay the same
    lift = of_air if lift is None else lift
    mass = round(float(1.204 * np.pi / 6 * diameter**3 / lift), 6)
    return {"diameter": round(float(diameter), 4), "mass": mass}, lift


def drop_again(seed: int, asked: Sequence[dict[str, Any]], folder: Path) -> None:
    """Write the set of `seed` once more, with the drops asked for appended.

    Args:
        seed: of the set.
        asked: `follow_up` of a verdict: height_m, mass_factor and drops of each kind of drop.
        folder: for the set.
    """
    _, drawn = draw_fall(seed, folder)
    rng = np.random.default_rng([seed, 2, 2])
    file = folder / "measurement.yaml"
    content = yaml.safe_load(file.read_text())
    content["mass"] = drawn.mass  # ballast is weighed, and so is the body then
    for a in asked:
        values = ballasted(drawn.values, a["mass_factor"])
        for k in range(a["drops"]):
            h = _fly(values, a["height_m"] * rng.uniform(0.95, 1.0), drawn.rate)
            wiggle = coloured_as(rng, len(h), 1.0 / drawn.rate, drawn.noise)[0]
            entry = _write(folder, len(content["episodes"]) + 1, drawn.rate, rounded(h + wiggle, drawn.step))
            role = "heldout" if k == a["drops"] - 1 else "fit"
            content["episodes"].append({**entry, "role": role, "mass": drawn.mass * a["mass_factor"]})
    file.write_text(yaml.safe_dump(content, sort_keys=False))


def _write(folder: Path, number: int, rate: float, h: np.ndarray) -> dict[str, str]:
    file = folder / f"drop_{number}.csv"
    t = np.arange(len(h)) / rate
    np.savetxt(file, np.stack([t, h], axis=1), delimiter=",", header="t,h", comments="", fmt="%.7g")
    return {"file": file.name}


def ballasted(values: dict[str, float], factor: float) -> dict[str, float]:
    """The same body `factor` times as heavy: the air's forces stay as they are, per mass they shrink."""
    return {n: v / factor if n in AIR else v for n, v in values.items()}


def _fly(values: dict[str, float], h0: float, rate: float) -> np.ndarray:
    """Heights at every 1 / rate seconds down to 0.3 m, the release `delay` late."""
    grid, path = _path(values, h0)
    wait = values.get("delay", 0.0)
    t = np.arange(int((8.0 + wait) * rate)) / rate
    heights = np.interp(t - wait, grid, path)
    heights = heights[: int(np.argmax(heights <= 0.3)) or len(heights)]
    return heights * (1.0 + values.get("gain_error", 0.0))


def _path(values: dict[str, float], h0: float, dt: float = 0.002, until: float = 8.0) -> tuple[np.ndarray, np.ndarray]:
    """Time since release and height in steps of `dt`, by the midpoint rule (2 ms: within 10 micrometres)."""
    g = 9.81 * (1.0 - values.get("buoyancy", 0.0))
    linear, cubic = values.get("linear_drag", 0.0), values.get("cubic_drag", 0.0)
    square, moving = values.get("quadratic_drag", 0.0), values.get("wind", 0.0)
    air, gust, swing = values.get("updraft", 0.0), values.get("gust", 0.0), values.get("swing", 0.0)

    def pull(s: float, v: float) -> float:
        a = -g - linear * v - square * abs(v) * v - moving * abs(v - air) * (v - air) - cubic * v**3
        if gust:
            a += gust * np.exp(-(((s - 1.0) / 0.15) ** 2))
        return a + (swing * np.sin(9.0 * s) if swing else 0.0)

    h, v, s = h0, 0.0, 0.0
    grid, path = [0.0], [h0]
    while h > 0.0 and s < until:
        half = v + 0.5 * dt * pull(s, v)
        a = pull(s + 0.5 * dt, half)
        h += dt * (v + 0.5 * dt * a)
        v += dt * a
        s += dt
        grid.append(s)
        path.append(h)
    return np.array(grid), np.array(path)
