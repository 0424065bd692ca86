"""Numbers of views and actions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..quantity import Quantities, quantity


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


@dataclass(frozen=True, kw_only=True)
class PolicyNumbers(Quantities):
    """How the pictures' votes on the place of the corner count."""

    same_place: float = quantity(0.03, "m", "of two votes, standard deviation", "choice: two pixels")
    least_vote: float = quantity(1e-3, "1", "of a picture that is counted", "choice: a thousandth of its one vote")
    agreeing: float = quantity(1.0, "1", "weight of the votes' logarithm beside the logit of success", "choice: odds")


VIEWS, ACTION, POLICY = ViewNumbers(), ActionNumbers(), PolicyNumbers()
PRIMITIVES = ("move_left", "direct", "move_right")
DIRECT = PRIMITIVES.index("direct")
