"""What a model file for dressing makes of the robot's sensors."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np


@dataclass(frozen=True, kw_only=True, eq=False)
class SensorChanges:
    """Errors of a run's sensors besides those that its kind of world has.

    Attributes:
        bias: (2, 3) what both wrists' sensors add along the hands' axes [N].
        delay: by which they tell late what pulls on the hands [s].
        camera: (3,) where the head's camera sits, along its own axes x right, y down, z forward, from where the robot
            takes it to be [m].
    """

    bias: np.ndarray = field(default_factory=lambda: np.zeros((2, 3)))
    delay: float = 0.0
    camera: np.ndarray = field(default_factory=lambda: np.zeros(3))
