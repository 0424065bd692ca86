"""Effects on cloth: forces on proxy bodies, changes of the soft body's settings, or of how markers are read.

`applyExternalForce` does nothing on a PyBullet soft body, so forces act on small rigid proxy bodies anchored to
vertices spread over the cloth (`proxy_bodies.py`).  An effect overrides one of `forces`, `settings`, `release` and
`read`.
"""

from __future__ import annotations

import abc
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..effect import Parameter, check_values


@dataclass(frozen=True, kw_only=True)
class ProxyState:
    """The proxy bodies at one instant, N of them.

    Attributes:
        t: [s].
        x, v: (N, 3) position [m] and velocity [m/s], world frame.
        start: (N, 3) position in the start pose [m].
        mass: (N,) mass of cloth each stands for [kg].
        area: (N,) area of cloth each stands for [m^2].
        pairs: (P, 2) neighbours.
        lengths: (P,) distance of neighbours in the start pose [m].
        capsules: (K, 7) a, b, radius of each capsule [m].
        gravity: (3,) [m/s^2].
    """

    t: float
    x: np.ndarray
    v: np.ndarray
    start: np.ndarray
    mass: np.ndarray
    area: np.ndarray
    pairs: np.ndarray
    lengths: np.ndarray
    capsules: np.ndarray
    gravity: np.ndarray


@dataclass(frozen=True, kw_only=True)
class ClothSettings:
    """What a soft body is loaded with.  friction: coefficient; gravity: (3,) [m/s^2]."""

    friction: float
    gravity: tuple[float, float, float]


class ClothEffect(abc.ABC):
    """One effect on cloth."""

    name: ClassVar[str]
    parameters: ClassVar[tuple[Parameter, ...]]
    needs_proxies: ClassVar[bool] = False  # acts on proxy bodies
    contains: ClassVar[frozenset[str]] = frozenset()
    sentence: ClassVar[str]

    def forces(self, state: ProxyState, values: dict[str, float]) -> np.ndarray:
        """Forces on the proxy bodies (N, 3) [N]."""
        return np.zeros_like(state.x)

    def settings(self, given: ClothSettings, values: dict[str, float]) -> ClothSettings:
        """Settings the soft body is loaded with."""
        return given

    def release(self, values: dict[str, float]) -> float | None:
        """Time at which the first pin lets go [s], or None."""
        return None

    def read(self, t: np.ndarray, markers: np.ndarray, values: dict[str, float]) -> np.ndarray:
        """How marker positions (T, M, 3) are recorded."""
        return markers

    def check(self, values: dict[str, float]) -> None:
        """Refuse values this effect cannot have.

        Raises:
            EffectError: a parameter is missing, unknown or outside its bounds.
        """
        check_values(self.name, values, self.parameters)
