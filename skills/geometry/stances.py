"""Where to stand beside the bed to dress an arm, mirrored between its two sides.

Found with inverse kinematics over arms at rest of all sizes and poses in `sim.scene`: from `LIFT` the head-side hand
lifts the arm and the feet-side hand takes the sleeve and pulls it up to the elbow, from `SHOULDER` up to the neck.
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from ...sim.world import Side

LIFT = (1.05, -0.38)  # from the middle of the bed, for the person's right side [m]
SHOULDER = (0.97, -0.62)
# Sliding along the bed: distance of the base from its middle, its deck under the mattress edge, and of the hands before
# the base's centre [m]; towards the head of the bed [rad].
LANE, AHEAD, FACING = 0.77, 0.55, -np.pi / 2
Stand = Literal["lift", "shoulder"]
LIFTING: dict[Side, Side] = {"right": "left", "left": "right"}  # arm -> the robot's hand on the head side
PULLING: dict[Side, Side] = {"right": "right", "left": "left"}  # arm -> the robot's hand on the feet side
HEADWARD = np.array((0.0, -1.0, 0.0))  # in the map, where the bed's head is at the lower y


def stance(arm: Side, stand: Stand) -> np.ndarray:
    """Base pose (3,) beside one of the person's arms, facing the bed [m, m, rad]."""
    x, y = LIFT if stand == "lift" else SHOULDER
    return np.array((x, y, np.pi)) if arm == "right" else np.array((-x, y, 0.0))


def outwards(arm: Side) -> np.ndarray:
    """Unit vector (3,) from the body's middle to that side of the bed, where the robot stands."""
    return np.array((1.0 if arm == "right" else -1.0, 0.0, 0.0))
