"""A gripper: the motor is commanded a width, the fingers are measured.

Everything below is what a user writes: a model of first order, and what may sit between motor and fingers.
"""

import numpy as np

from caretree.gap import Effect, Parameter, System

LAG = 0.04  # [s] of the motor's controller, as its data sheet says


def number(name: str, unit: str, typical: float, lower: float = 0.0, upper: float = np.inf) -> tuple[Parameter]:
    return (Parameter(name=name, unit=unit, typical=typical, lower=lower, upper=upper),)


class Gripper(System):
    name = "gripper"
    channels = {"width": "m"}
    inputs = {"command": "m"}
    effects = (
        Effect(name="backlash", target="fingers", parameters=number("gap", "m", 1e-3)),
        Effect(name="slower_motor", target="motor", recalibration=True, parameters=number("lag", "s", 0.02, -0.03)),
        Effect(name="delay", target="motor", parameters=number("time", "s", 0.02)),
        Effect(name="scale_error", target="fingers", parameters=number("scale", "1", 0.02, -0.5)),
        Effect(name="offset", target="fingers", parameters=number("shift", "m", 1e-3, -np.inf),
               regressor=lambda log: np.ones(len(log["t"]))),
        Effect(name="creep", target="fingers", parameters=number("rate", "m/s", 1e-4, -np.inf),
               regressor=lambda log: log["t"] - log["t"][0]),
    )  # fmt: skip

    def predict(self, log, values):
        t = log["t"]
        command = np.interp(t - values["time"], t, log["command"])
        keep = np.exp(-np.diff(t, prepend=t[0]) / (LAG + values["lag"]))
        half = 0.5 * values["gap"]
        motor = finger = command[0]
        out = np.empty(len(t))
        for i, (wanted, k) in enumerate(zip(command, keep, strict=True)):
            motor = wanted + (motor - wanted) * k
            finger = min(max(finger, motor - half), motor + half)  # dragged at either end of the gap
            out[i] = finger
        return (1.0 + values["scale"]) * out
