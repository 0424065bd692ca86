"""Hidden cases for a dropped body: integrated step by step, heights with camera noise."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import yaml

from .case import Truth, coloured, draw_kind

INSIDE = ("linear_drag", "quadratic_drag", "buoyancy", "wind", "gain_error", "delay")
OUTSIDE = ("gust", "cubic_drag", "swing")


def write_fall_case(seed: int, folder: Path) -> Truth:
    """Write one set for `fall` into `folder` and return what it hides."""
    rng = np.random.default_rng([seed, 2])
    kind = draw_kind(rng)
    kind = "none" if kind == "recalibration" else kind
    truth = Truth(system="fall", seed=seed, kind=kind)
    rate, top = float(rng.choice([15.0, 30.0, 60.0, 120.0])), rng.uniform(8.0, 50.0)
    episodes = int(rng.integers(4, 8))
    noise = rng.uniform(0.01, 0.05)
    names = (
        []
        if kind == "none"
        else [
            str(n)
            for n in rng.choice(OUTSIDE if kind == "outside" else INSIDE, size=2 if kind == "two" else 1, replace=False)
        ]
    )
    if set(names) in ({"buoyancy", "gain_error"}, {"quadratic_drag", "wind"}):  # one is the other by construction
        names = [names[0], "delay"]
    size = {n: float(np.exp(rng.uniform(np.log(0.5), np.log(8.0)))) for n in names}
    if kind == "outside":
        size = {n: float(np.exp(rng.uniform(np.log(2.0), np.log(10.0)))) for n in names}
    air = {"updraft": float(rng.choice([-1, 1]) * rng.uniform(2.0, 6.0))} if "wind" in names else {}
    values, plain = dict(air), _fly({}, top, rate)
    for n in names:  # size: root mean square change of the drop over the noise
        low, high = (
            0.0,
            {
                "linear_drag": 3.0,
                "quadratic_drag": 1.0,
                "buoyancy": 0.9,
                "wind": 1.0,
                "gain_error": 0.5,
                "delay": 0.5,
                "gust": 9.0,
                "cubic_drag": 0.2,
                "swing": 3.0,
            }[n],
        )
        for _ in range(30):
            middle = 0.5 * (low + high)
            change = np.sqrt(np.mean((_fly({**air, n: middle}, top, rate)[: len(plain)] - plain) ** 2))
            low, high = (middle, high) if change < size[n] * noise else (low, middle)
        values[n] = high
    header: dict = {"system": "fall"}
    if "buoyancy" in values or rng.random() < 0.5:  # a ball whose lift is what its size and mass make it
        diameter = rng.uniform(0.05, 0.4)
        lift = values.get("buoyancy", 1.2 / rng.uniform(2000.0, 8000.0))
        header |= {
            "diameter": round(float(diameter), 4),
            "mass": round(float(1.204 * np.pi / 6 * diameter**3 / lift), 6),
        }
        if "buoyancy" not in values:
            values["buoyancy"] = lift  # too small to see, and not missing from a model that knows both
            header["mass"] = round(float(1.204 * np.pi / 6 * diameter**3 / lift), 6)
    entries = []
    for e in range(episodes):
        h0 = top * rng.uniform(0.85, 1.0)
        h = _fly(values, h0, rate)
        t = np.arange(len(h)) / rate
        h = h + coloured(rng, len(h), 1.0 / rate, noise)
        file = folder / f"drop_{e + 1}.csv"
        np.savetxt(file, np.stack([t, h], axis=1), delimiter=",", header="t,h", comments="", fmt="%.7g")
        entries.append({"file": file.name, "role": "heldout" if e >= episodes - max(1, episodes // 3) else "fit"})
    (folder / "measurement.yaml").write_text(yaml.safe_dump({**header, "episodes": entries}, sort_keys=False))
    truth.effects = [{"name": n, "target": "body", "size": size[n]} for n in names]
    return truth


def _fly(values: dict[str, float], h0: float, rate: float) -> np.ndarray:
    g = 9.81 * (1.0 - values.get("buoyancy", 0.0))
    wait, out, h, v, t, dt = values.get("delay", 0.0), [], h0, 0.0, 0.0, 0.002
    every = 1.0 / rate
    while h > 0.3 and t < 8.0:
        if t >= len(out) * every - 1e-9:
            out.append(h)
        if t >= wait:
            s = t - wait
            rel = v - values.get("updraft", 0.0)
            a = -g - values.get("linear_drag", 0.0) * v - values.get("quadratic_drag", 0.0) * abs(v) * v
            a -= values.get("wind", 0.0) * abs(rel) * rel + values.get("cubic_drag", 0.0) * v**3
            a += values.get("gust", 0.0) * np.exp(-(((s - 1.0) / 0.15) ** 2)) + values.get("swing", 0.0) * np.sin(
                9.0 * s
            )
            h += dt * (v + 0.5 * dt * a)
            v += dt * a
        t += dt
    heights = np.array(out)
    gain = 1.0 + values.get("gain_error", 0.0)
    return heights * gain
