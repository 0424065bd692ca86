"""A differential-drive base in the plane: wheel speeds commanded, pose measured by a camera above it.

Everything below is what a user writes: the kinematics they already have, with their unknowns at 0.
"""

import numpy as np

from caretree.gap import Effect, Parameter, System

RADIUS, TRACK = 0.05, 0.30  # [m] as on the drawing


def number(name: str, unit: str, typical: float, lower: float = -np.inf, upper: float = np.inf) -> tuple[Parameter]:
    return (Parameter(name=name, unit=unit, typical=typical, lower=lower, upper=upper),)


class Base(System):
    name = "base"
    channels = {"x": "m", "y": "m", "yaw": "rad"}
    inputs = {"left": "rad/s", "right": "rad/s"}
    effects = (
        Effect(name="left_radius", target="left wheel", recalibration=True, parameters=number("d_left", "m", 1e-3)),
        Effect(name="right_radius", target="right wheel", recalibration=True, parameters=number("d_right", "m", 1e-3)),
        Effect(name="track_width", recalibration=True, parameters=number("d_track", "m", 0.01, lower=-0.2)),
        Effect(name="turning_slip", parameters=number("turn_lost", "1", 0.05, 0.0, 0.9)),
        Effect(name="sideways_slip", parameters=number("skid", "s", 0.02, 0.0)),
        Effect(name="motor_lag", parameters=number("lag", "s", 0.05, 0.0, 2.0)),
    )
    start = (*number("x0", "m", 0.01), *number("y0", "m", 0.01), *number("yaw0", "rad", 0.01))

    def predict(self, log, values):
        t = log["t"]
        dt = np.diff(t, prepend=t[0])
        left = (RADIUS + values["d_left"]) * self.behind(log["left"], dt, values["lag"])
        right = (RADIUS + values["d_right"]) * self.behind(log["right"], dt, values["lag"])
        speed = (left + right) / 2
        turn = (1.0 - values["turn_lost"]) * (right - left) / (TRACK + values["d_track"])
        yaw = log["yaw"][0] + values["yaw0"] + np.cumsum(turn * dt)
        side = -values["skid"] * speed * turn  # drifts outwards in a bend
        x = np.cumsum((speed * np.cos(yaw) - side * np.sin(yaw)) * dt)
        y = np.cumsum((speed * np.sin(yaw) + side * np.cos(yaw)) * dt)
        return np.stack([log["x"][0] + values["x0"] + x, log["y"][0] + values["y0"] + y, yaw], axis=1)

    @staticmethod
    def behind(command, dt, lag):
        if lag <= 0.0:
            return command
        out, now = np.empty(len(command)), 0.0
        for i, (wanted, step) in enumerate(zip(command, dt, strict=True)):
            now += (wanted - now) * -np.expm1(-step / lag)
            out[i] = now
        return out
