"""The rigid-body model a joint log is compared with: what the user's simulation believes before any effect."""

from __future__ import annotations

import abc
from dataclasses import dataclass

import numpy as np

from ....sim.effects.effect import Parameter
from ....sim.effects.joint.link_inertia import BODY_PARAMETERS

Spell = tuple[float, float]  # from when, to before when [s of the recording's clock]


@dataclass(frozen=True, kw_only=True)
class During:
    """When something that is not there all the time acts.

    Attributes:
        spells: of each recording, in order; the first begins and the last ends at infinity where a recording's end cuts
            it off.
        last: whether it acts at the end of the last recording that was fitted, and so in one nobody has looked at.
    """

    spells: dict[str, tuple[Spell, ...]]
    last: bool

    def of(self, recording: str) -> tuple[Spell, ...]:
        """Its spells in one recording, also of the copy that went through no filter."""
        always = ((-np.inf, np.inf),) if self.last else ()
        return self.spells.get(recording.rstrip("~"), always)

    def acts(self, recording: str, t: np.ndarray) -> np.ndarray:
        """Whether it acts at some times [s], (T,)."""
        out = np.zeros(len(t), dtype=bool)
        for a, b in self.of(recording):
            out |= (t >= a) & (t < b)
        return out


@dataclass(frozen=True, kw_only=True)
class BodyTerm:
    """Something that changes the rigid model itself rather than one joint: a link's mass, a tool, a payload.

    Attributes:
        name: effect name, or `mass` when it is one of the model's own parameters.
        target: the body.
        recalibration: one of the model's own uncertain parameters.
        parameters: what is fitted, in the order of the columns.
        shape: values that enter nonlinearly.
        deviation: how far the (first) parameter may plausibly be off, one standard deviation; inf where anything goes.
        during: when it acts; None for all the time.
    """

    name: str
    target: str
    recalibration: bool
    parameters: tuple[Parameter, ...]
    shape: dict[str, float]
    deviation: float = float("inf")
    during: During | None = None


class RigidModel(abc.ABC):
    """Inverse and forward dynamics of the model as the user gave it."""

    joints: tuple[str, ...]
    prismatic: tuple[bool, ...]

    @property
    def strongest(self) -> tuple[float, ...]:
        """Largest load each joint is made for [N or N m], inf where nothing says so."""
        return (float("inf"),) * len(self.joints)

    @abc.abstractmethod
    def load(self, q: np.ndarray, dq: np.ndarray, ddq: np.ndarray) -> np.ndarray:
        """Joint loads along a motion, (T, n) [N or N m]."""

    @abc.abstractmethod
    def acceleration(self, q: np.ndarray, dq: np.ndarray, load: np.ndarray) -> np.ndarray:
        """Joint acceleration at one instant, (n,)."""

    @abc.abstractmethod
    def body_terms(self) -> list[BodyTerm]:
        """Changes to the bodies that the search may propose."""

    def geometry_terms(self) -> list[BodyTerm]:
        """How else the whole may stand, and where else the zeros of its readings may be."""
        return []

    @property
    @abc.abstractmethod
    def payload(self) -> BodyTerm:
        """What the last body may carry beside its own mass, and take up or put down."""

    @abc.abstractmethod
    def body_columns(self, term: BodyTerm, q: np.ndarray, dq: np.ndarray, ddq: np.ndarray) -> np.ndarray:
        """Change of the joint loads per unit of each parameter of `term`, (T, n, p)."""

    @abc.abstractmethod
    def patched(self, term: BodyTerm, values: dict[str, float]) -> RigidModel:
        """The model with a body term applied."""

    def moments(self, term: BodyTerm, values: dict[str, float]) -> dict[str, float]:
        """Mass [kg] and first moments [kg m] of a payload or tool, as a model file has them; none of these without."""
        return {p.name: values.get(p.name, 0.0) for p in BODY_PARAMETERS}

    @abc.abstractmethod
    def with_armature(self, joint: int, inertia: float) -> RigidModel:
        """The model with a rotor's inertia on one joint, solved implicitly (an explicit one is unstable)."""
