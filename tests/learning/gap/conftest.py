"""Small measurement sets, made from the physics and nothing of the workflow."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import yaml


@pytest.fixture
def axis_set(tmp_path):
    """Write an axis set whose force is 10 kg times acceleration plus `extra(q, v, a)` plus noise."""

    def make(extra=lambda q, v, a: 0.0 * q, noise=0.4, mass=10.0, episodes=3, name="set") -> Path:
        folder = tmp_path / name
        folder.mkdir()
        t = np.arange(0.0, 8.0, 0.01)
        listed = []
        for k in range(episodes):
            rng = np.random.default_rng([7, k])
            w = 2 * np.pi * 0.15 * np.arange(1, 5)
            amplitude, phase = rng.normal(size=4) / np.arange(1, 5) * 0.1, rng.uniform(0, 6, 4)
            arg = t[:, None] * w + phase
            q, v = np.sin(arg) @ amplitude, np.cos(arg) @ (amplitude * w)
            a = -np.sin(arg) @ (amplitude * w**2)
            force = 10.0 * a + extra(q, v, a) + noise * rng.normal(size=len(t))
            np.savetxt(
                folder / f"e{k}.csv",
                np.column_stack([t, q, v, force]),
                delimiter=",",
                header="t,q,dq,force",
                comments="",
            )
            listed.append({"file": f"e{k}.csv", "role": "heldout" if k == episodes - 1 else "fit"})
        (folder / "measurement.yaml").write_text(yaml.safe_dump({"system": "axis", "mass": mass, "episodes": listed}))
        return folder

    return make


@pytest.fixture
def drop_set(tmp_path):
    """Write a set of drops from 20 m with quadratic drag `coefficient` [1/m] and 1 cm of noise.

    `ballast` is the mass in each episode over the 0.2 kg of the body; `steep` adds a drag with the cube [s/m^2]; `held`
    is for how long the body is held in each episode before it is let go of [s]; faster than `crisis` [m/s] it has 0.4
    of its drag.
    """

    def make(coefficient=0.0, episodes=4, ballast=(), steep=0.0, held=(), crisis=float("inf")) -> Path:
        folder = tmp_path / "drops"
        folder.mkdir()
        listed = []
        for k in range(episodes):
            h, v, heights = 20.0, 0.0, []
            for step in range(1700):
                if step % 33 == 0:
                    heights.append(h)
                drag = coefficient * (0.4 if abs(v) > crisis else 1.0)
                a = -9.81 - (drag * abs(v) * v + steep * v**3) / (ballast[k] if ballast else 1.0)
                h += 1e-3 * (v + 0.5e-3 * a)
                v += 1e-3 * a
            heights = [20.0] * (round(held[k] / 0.033) if held else 0) + heights
            t = 0.033 * np.arange(len(heights))
            noise = 0.01 * np.random.default_rng([3, k]).normal(size=len(t))
            np.savetxt(
                folder / f"d{k}.csv",
                np.column_stack([t, np.array(heights) + noise]),
                delimiter=",",
                header="t,h",
                comments="",
            )
            listed.append({"file": f"d{k}.csv", "role": "heldout" if k == episodes - 1 else "fit"})
            if ballast:
                listed[-1]["mass"] = 0.2 * ballast[k]
        mass = {"mass": 0.2} if ballast else {}
        (folder / "measurement.yaml").write_text(yaml.safe_dump({"system": "fall", **mass, "episodes": listed}))
        return folder

    return make
