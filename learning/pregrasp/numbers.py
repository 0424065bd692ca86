"""Numbers of states, views, actions and roll-outs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity


@dataclass(frozen=True, kw_only=True)
class HangNumbers(Quantities):
    """How a gown comes to hang from one hand."""

    step: float = quantity(0.0025, "s", "of the springs", "choice: the step of the dressing room")
    swing: float = quantity(0.8, "m/s", "standard deviation of the speeds with which it is let go", "choice: it folds")
    bulges: int = quantity(4, "1", "waves of that speed over the gown", "choice: folds of a hand's width and more")
    air_drag: float = quantity(1.5, "N s^2/m^4", "while it swings out", "choice: five times air, to wait less")
    calm: float = quantity(0.8, "s", "in which the swing is damped to 37 %", "choice: less than half a swing")
    time: float = quantity(3.5, "s", "that it swings out", "choice: then all gowns move by 1 cm/s at most")
    deepest: float = quantity(
        0.25, "1", "share of the neckline at each end that a deep grasp spares", "choice: its middle half"
    )
    gather: float = quantity(0.3, "1", "share of their distance at which held vertices are pinched", "choice: fingers")


@dataclass(frozen=True, kw_only=True)
class ViewNumbers(Quantities):
    """Six pictures around the hanging gown."""

    views: int = quantity(6, "1", "around the gown", "paper: 6")
    turn: float = quantity(float(np.deg2rad(30.0)), "rad", "from one to the next", "paper: 30 degrees")
    distance: float = quantity(1.2, "m", "of the camera from the vertical through the holding hand", "choice: head")
    pixel: float = quantity(0.015, "m", "side of a pixel at that distance", "choice: the gown fits into the picture")
    width: int = quantity(64, "1", "pixels", "choice: 0.96 m, a gown that hangs from one hand")
    height: int = quantity(88, "1", "pixels", "choice: 1.32 m")
    above: float = quantity(0.06, "m", "of the picture's upper border over the hand", "choice: the hand shows")


@dataclass(frozen=True, kw_only=True)
class ActionNumbers(Quantities):
    """The three primitives."""

    sweep: float = quantity(0.05, "m", "to the left or right before the grasp", "paper: 5 cm")
    yaw: float = quantity(
        float(np.deg2rad(15.0)), "rad", "of the approach against the view, about the vertical", "paper: 15 degrees"
    )
    depth: float = quantity(0.014, "m", "of the fingertips beyond the pixel's place", "choice: as the skill's")
    opening: float = quantity(0.05, "m", "between the fingertips until they close", "choice: as the skill's")
    run_up: float = quantity(0.10, "m", "from which the hand comes straight in", "choice: as the skill's")
    approach_speed: float = quantity(0.25, "m/s", "of the hand on its way in", "measured: cloth stays stable")
    sweep_speed: float = quantity(0.15, "m/s", "of the hand that sweeps", "choice: the cloth gives way")
    margin: float = quantity(
        0.0065, "m", "that cloth keeps from fingers in the spring engine", "measured: a loose triangle in PyBullet"
    )
    friction: float = quantity(0.2, "1", "of fingers on cloth", "choice: 0.4 on cloth times 0.5 of the fingers")


HANG, VIEWS, ACTION = HangNumbers(), ViewNumbers(), ActionNumbers()
PRIMITIVES = ("move_left", "direct", "move_right")
