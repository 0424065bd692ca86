"""A small system for tests: position of a slider pushed by a command, with effects by simulation and by regressor."""

from typing import ClassVar

import numpy as np

from caretree.gap import Effect, Parameter, System

STEP = 0.03  # [s]


class Slider(System):
    name = "slider"
    channels: ClassVar = {"x": "m"}
    inputs: ClassVar = {"push": "N"}
    effects = (
        Effect(name="viscous", parameters=(Parameter(name="rate", unit="1/s", lower=0.0, typical=0.2),)),
        Effect(name="wind", parameters=(Parameter(name="force", unit="N", typical=0.1),)),
        Effect(
            name="tilt",
            parameters=(Parameter(name="slope", unit="1", typical=0.1),),
            regressor=lambda log: 0.5 * (log["t"] - log["t"][0]) * (log["t"] - log["t"][0] + STEP),  # as wind does
        ),
        Effect(
            name="ripple",
            parameters=(Parameter(name="size", unit="m", typical=0.02),),
            regressor=lambda log: np.sin(3.0 * log["push"]),
        ),
    )
    start = (Parameter(name="x0", unit="m", typical=0.01),)

    def predict(self, log, values):
        dt = np.diff(log["t"], prepend=log["t"][0])
        x, v = values["x0"], 0.0
        out = np.empty(len(dt))
        for i, h in enumerate(dt):
            v += h * (log["push"][i] + values["force"] - values["rate"] * v)
            x += h * v
            out[i] = x
        return out


class Plain(Slider):
    """The same without a start of its own, and with two effects alone."""

    name = "plain"
    effects = (Slider.effects[0], Slider.effects[3])
    start = ()

    def predict(self, log, values):
        return super().predict(log, {"x0": 0.0, "force": 0.0, **values})


def pushes(count=3, hidden=None, noise=0.002, seed=100, kind=Slider, extra=None):
    """Recordings of the slider, each from a place of its own."""
    out = []
    for k in range(count):
        rng = np.random.default_rng([seed, k])
        t = np.arange(0.0, 6.0, STEP)
        log = {"t": t, "push": np.sin(1.3 * t + rng.uniform(0, 6)) + np.sin(3.1 * t + rng.uniform(0, 6))}
        none = {p.name: 0.0 for p in (*(p for e in kind.effects for p in e.parameters), *kind.start)}
        own = {"x0": 0.05 * rng.normal()} if kind.start else {}
        values = none | (hidden or {}) | own
        x = kind().predict(log, values)
        for e in kind.effects:
            if e.regressor:
                x = x + values[e.parameters[0].name] * e.regressor(log)
        if extra is not None:
            x = x + extra(log, k)
        out.append({**log, "x": x + noise * rng.normal(size=len(t))})
    return out
