"""What a user writes to put a simulator of their own through the workflow: a `System` with its `Effect`s.

class Pendulum(System):
    name = "pendulum"
    channels = {"q": "rad"}
    inputs = {"torque": "N m"}
    effects = (
        Effect(name="viscous_friction", target="hinge", exports="damping",
               parameters=(Parameter(name="damping", unit="N m s/rad", lower=0.0, typical=0.02),)),
    )

    def predict(self, log, values):
        ...  # simulate with values["damping"]; 0 is the model as given
        return q  # (T,) at the times log["t"]
"""

from __future__ import annotations

import abc
import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from ....sim.effects.effect import Parameter
from ..errors import GapError

Columns = Mapping[str, np.ndarray]  # column -> (T,), with `t`; read-only
Regressor = Callable[[Columns], np.ndarray]  # -> (T,), (T, C) or (T, C, p): change of the prediction per parameter
EXPORTS = ("damping", "friction", "armature", "mass")
NAME = re.compile(r"[A-Za-z]\w*")


@dataclass(frozen=True, kw_only=True)
class Effect:
    """Something the real system may have that the model lacks.  With every parameter at 0 it changes nothing.

    Attributes:
        name: for instance `viscous_friction`.
        parameters: its numbers; the bounds must let 0 be, and `typical` must be a size that would matter.
        target: what it acts on, for instance a joint's name in the robot file; else the system.
        recalibration: a number of the model's own that was off, rather than physics it lacks.
        contains: names of effects on the same target that are special cases of this one.
        regressor: where the prediction is linear in the parameters, its change per unit of each; None where only
            simulating tells.
        exports: what the (single) parameter is in a URDF or MJCF: `damping`, `friction` or `armature` of the joint
            `target`, or added `mass` of the body `target`.  "" where such a file cannot say it.
    """

    name: str
    parameters: tuple[Parameter, ...]
    target: str = "system"
    recalibration: bool = False
    contains: frozenset[str] = field(default=frozenset())
    regressor: Regressor | None = None
    exports: str = ""

    @property
    def key(self) -> tuple[str, str]:
        """Name and target."""
        return self.name, self.target


class System(abc.ABC):
    """A simulator of one's own.  It is constructed without arguments.

    Attributes:
        name: what `system:` in measurement.yaml says.
        channels: column that is predicted -> its unit, SI.
        inputs: column that was commanded -> its unit; `experiments` varies them.
        effects: what may be missing.
        model_error: predicted channel -> what the model leaves of a recording although nothing is missing, root mean
            square in the channel's unit: slow, and another in every recording.  Left out, it is none.
        start: numbers every recording has of its own, such as an offset of its first angle; they are fitted to each
            recording, held-out ones too, and are no finding.
    """

    name: ClassVar[str]
    channels: ClassVar[dict[str, str]]
    inputs: ClassVar[dict[str, str]] = {}
    effects: ClassVar[tuple[Effect, ...]]
    model_error: ClassVar[dict[str, float]] = {}
    start: ClassVar[tuple[Parameter, ...]] = ()

    @abc.abstractmethod
    def predict(self, log: Columns, values: Mapping[str, float]) -> np.ndarray:
        """What the channels would read.

        Args:
            log: columns of one recording, among them `t` (T,) [s], the inputs and the measured channels.
            values: every parameter of every effect (and of `start`) -> its value, 0 where the effect is absent.

        Returns:
            (T, C) in the order of `channels`, or (T,) where there is one.
        """

    def experiments(self, log: Columns) -> dict[str, Columns]:
        """Recordings that could be made next, as a sentence and the columns `predict` would be given.

        Unless a class says otherwise: half and twice the commands, turned round, and held twice as long.
        """
        if not self.inputs:
            return {}
        t = np.asarray(log["t"], dtype=float)

        def scaled(factor: float) -> Columns:
            return {k: factor * x if k in self.inputs else x for k, x in log.items()}

        return {
            "repeat it with commands half as large": scaled(0.5),
            "repeat it with commands twice as large": scaled(2.0),
            "repeat it with the commands turned round": scaled(-1.0),
            "repeat it with every command held twice as long": {**log, "t": t[0] + 2.0 * (t - t[0])},
        }


def check_system(system: System) -> System:
    """Refuse a class the workflow cannot work with.

    Raises:
        GapError: one sentence that names the class and what is wrong with it.
    """
    where = type(system).__name__
    for attribute in ("name", "channels", "effects"):
        if not getattr(system, attribute, None):
            raise GapError(f"{where}: `{attribute}` is missing, a System needs name, channels, effects and predict")
    if not _is_name(system.name):
        raise GapError(f"{where}: name is {system.name!r}, it must be letters, digits and _")
    for attribute in ("channels", "inputs"):
        given = getattr(system, attribute)
        if not isinstance(given, dict) or not all(isinstance(x, str) and x for x in (*given, *given.values())):
            raise GapError(f'{where}: {attribute} is {given!r}, it must be a dict such as {{"q": "rad"}}')
    _check_model_error(where, system)
    for attribute, kind in (("effects", "Effect"), ("start", "Parameter")):
        given = getattr(system, attribute)
        if not isinstance(given, tuple | list):
            raise GapError(f"{where}: {attribute} is {given!r:.60}, it must be a tuple: ({kind}(...),) with its comma")
    seen: dict[str, str] = {}
    for e in system.effects:
        _check_effect(where, e, seen)
    keys = [e.key for e in system.effects]
    doubled = [k for k in keys if keys.count(k) > 1]
    if doubled:
        raise GapError(f"{where}: effect {doubled[0][0]} on {doubled[0][1]} is there twice")
    for p in system.start:
        _check_parameter(f"{where}: start", p, seen)
        seen[p.name] = "start"
    return system


def _check_model_error(where: str, system: System) -> None:
    """A finite size of each channel that it names."""
    known = ", ".join(system.channels)
    if not isinstance(system.model_error, dict):
        raise GapError(f"{where}: model_error is {system.model_error!r:.60}, it must be a dict of sizes of {known}")
    for channel, error in system.model_error.items():
        if channel not in system.channels or not _is_number(error) or not (math.isfinite(error) and error >= 0.0):
            raise GapError(f"{where}: model_error {channel!r}: {error!r} must be a finite size of one of {known}")


def _is_name(given: object) -> bool:
    return isinstance(given, str) and NAME.fullmatch(given) is not None


def _is_number(given: object) -> bool:
    return isinstance(given, int | float | np.integer | np.floating) and not isinstance(given, bool)


def _check_effect(where: str, e: Effect, seen: dict[str, str]) -> None:
    if not isinstance(e, Effect) or not _is_name(e.name) or not e.parameters:
        raise GapError(f"{where}: {e!r:.80} is no Effect with a name and parameters")
    if not isinstance(e.target, str) or not e.target:
        raise GapError(f"{where}: effect {e.name} acts on {e.target!r}, the target must be a name")
    if not isinstance(e.parameters, tuple | list):
        raise GapError(f"{where}: parameters of effect {e.name} must be a tuple: (Parameter(...),) with its comma")
    if e.regressor is not None and not callable(e.regressor):
        raise GapError(f"{where}: regressor of effect {e.name} is {e.regressor!r:.60}, it must be a function")
    if e.exports and (e.exports not in EXPORTS or len(e.parameters) != 1):
        raise GapError(
            f"{where}: effect {e.name} exports {e.exports!r} with {len(e.parameters)} parameters, "
            f"one parameter can be {', '.join(EXPORTS)}"
        )
    for p in e.parameters:
        _check_parameter(f"{where}: effect {e.name}", p, seen)
        seen[p.name] = e.name


def _check_parameter(where: str, p: Parameter, seen: dict[str, str]) -> None:
    if not isinstance(p, Parameter) or not _is_name(p.name):
        raise GapError(f"{where}: {p!r:.80} is no Parameter with a name")
    for attribute in ("lower", "upper", "typical"):
        if not _is_number(value := getattr(p, attribute)):
            raise GapError(f"{where}: {attribute} of {p.name} is {value!r}, a number is needed")
    if not p.lower <= 0.0 <= p.upper or p.lower == p.upper:
        raise GapError(f"{where}: the bounds of {p.name!r} must let 0 be, which is the model as given")
    if not (math.isfinite(p.typical) and p.typical > 0.0):
        raise GapError(f"{where}: typical of {p.name} is {p.typical}, a positive size that would matter is needed")
    if p.name in seen:
        raise GapError(f"{where}: parameter {p.name} is already one of {seen[p.name]}, names must differ")
