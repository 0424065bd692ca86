"""What a physical effect is: a name, parameters with units and sign bounds, and the load it adds to a joint.

An effect on a joint (of an arm or an axis) says how the measured load differs from the rigid model,

    load_measured = load_model(q, dq, ddq) + sum_k theta_k * column_k(motion; shape),

so `columns` is at once the regressor the effect leaves in the residual and the way it enters inverse dynamics.
`theta` are the linear parameters; `shape` holds the few that enter nonlinearly (a Stribeck speed, a threshold).
"""

from __future__ import annotations

import abc
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..errors import CaretreeError


class EffectError(CaretreeError):
    """An effect, or a file of effects, does not fit; the message is one sentence for the user."""


@dataclass(frozen=True, kw_only=True)
class Parameter:
    """One number of an effect.

    Attributes:
        name: as written in model.yaml.
        unit: SI; `F` stands for N or N m and `x` for m or rad, as the joint is prismatic or revolute.
        lower: smallest physical value.
        upper: largest physical value.
        typical: a size that would matter; a simulator of one's own is tried there and around it.
    """

    name: str
    unit: str
    lower: float = -np.inf
    upper: float = np.inf
    typical: float = 1.0

    def unit_for(self, prismatic: bool) -> str:
        """The unit spelled out for one kind of joint."""
        return self.unit.replace("F", "N" if prismatic else "N m").replace("x", "m" if prismatic else "rad")


@dataclass(frozen=True, kw_only=True)
class JointMotion:
    """The motion of one joint over one episode, all arrays (T,).

    Attributes:
        t: time [s], uniform.
        q: position [m or rad].
        dq: velocity.
        ddq: acceleration.
        load: load the rigid model predicts [N or N m].
        measured: measured load, smoothed [N or N m].
        slow: speed below which the sign of the velocity is not known.
    """

    t: np.ndarray
    q: np.ndarray
    dq: np.ndarray
    ddq: np.ndarray
    load: np.ndarray
    measured: np.ndarray
    slow: float = 1e-3

    @classmethod
    def instant(
        cls, *, q: float, dq: float, load: float = 0.0, measured: float = 0.0, slow: float = 1e-3
    ) -> JointMotion:
        """One instant as a motion of one sample, at no acceleration."""
        t, at, speed, given, seen = (np.array([x]) for x in (0.0, q, dq, load, measured))
        return cls(t=t, q=at, dq=speed, ddq=np.zeros(1), load=given, measured=seen, slow=slow)

    @property
    def direction(self) -> np.ndarray:
        """Sign of the velocity, passing smoothly through zero within `slow`, (T,)."""
        return self.direction_within(0.0)

    def direction_within(self, width: float) -> np.ndarray:
        """Sign of the velocity, passing smoothly through zero within `width` or within `slow`, if that is more."""
        return np.tanh(2.0 * self.dq / max(self.slow, width, 1e-12))


@dataclass(frozen=True, kw_only=True)
class Spread:
    """What the motions of all episodes cover, from which an effect lays out the shapes worth trying.

    Attributes:
        q: (lowest, highest) position.
        speed: 95th percentile of |velocity|.
        slow: speed below which the sign of the velocity is not known.
        dt: time step [s].
    """

    q: tuple[float, float]
    speed: float
    slow: float
    dt: float


Shape = dict[str, float]


class JointEffect(abc.ABC):
    """One effect on one joint.  Subclasses are stateless; values come with each call."""

    name: ClassVar[str]
    linear: ClassVar[tuple[Parameter, ...]]
    shape: ClassVar[tuple[Parameter, ...]] = ()
    optional: ClassVar[tuple[Parameter, ...]] = ()  # shape that a file may leave out, 0 then
    systems: ClassVar[frozenset[str]] = frozenset({"arm", "axis"})
    contains: ClassVar[frozenset[str]] = frozenset()  # effects that are special cases of this one
    memoryless: ClassVar[bool] = True  # the load depends on this instant alone
    sharp: ClassVar[bool] = False  # the load jumps or has a kink where the motion is smooth
    sentence: ClassVar[str]

    @abc.abstractmethod
    def columns(self, motion: JointMotion, shape: Shape) -> np.ndarray:
        """Regressors of the linear parameters in the measured load, (T, len(linear))."""

    def shapes(self, spread: Spread) -> list[Shape]:
        """Shapes to screen before one is refined; one empty shape when there is nothing nonlinear."""
        return [{}]

    def load(self, motion: JointMotion, values: dict[str, float]) -> np.ndarray:
        """Load this effect adds to the model's, (T,) [N or N m]."""
        theta = np.array([values[p.name] for p in self.linear])
        shape = {p.name: values.get(p.name, 0.0) for p in (*self.shape, *self.optional)}
        return self.columns(motion, shape) @ theta

    def check(self, values: dict[str, float]) -> None:
        """Refuse values this effect cannot have.

        Raises:
            EffectError: a parameter is missing, unknown or outside its physical bounds.
        """
        check_values(self.name, values, (*self.linear, *self.shape), self.optional)


def check_values(
    name: str, values: dict[str, float], needed: tuple[Parameter, ...], optional: tuple[Parameter, ...] = ()
) -> None:
    """Refuse values an effect cannot have.

    Args:
        name: of the effect.
        values: parameter -> value.
        needed: parameters that must be there.
        optional: parameters that may be there.

    Raises:
        EffectError: a parameter is missing, unknown or outside its physical bounds.
    """
    wanted = {p.name: p for p in (*needed, *optional)}
    if not {p.name for p in needed} <= set(values) <= set(wanted):
        raise EffectError(f"effect {name} has parameters {sorted(values)}, it takes {sorted(wanted)}")
    for key, value in values.items():
        p = wanted[key]
        if not p.lower <= value <= p.upper:
            raise EffectError(f"effect {name}: {key} = {value:g} is outside {p.lower:g} to {p.upper:g}")
