"""The rigid-body model a joint log is compared with: what the user's simulation believes before any effect."""

from __future__ import annotations

import abc
from dataclasses import dataclass

import numpy as np

from ....sim.effects.effect import Parameter


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
    """

    name: str
    target: str
    recalibration: bool
    parameters: tuple[Parameter, ...]
    shape: dict[str, float]
    deviation: float = float("inf")


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

    @abc.abstractmethod
    def body_columns(self, term: BodyTerm, q: np.ndarray, dq: np.ndarray, ddq: np.ndarray) -> np.ndarray:
        """Change of the joint loads per unit of each parameter of `term`, (T, n, p)."""

    @abc.abstractmethod
    def patched(self, term: BodyTerm, values: dict[str, float]) -> RigidModel:
        """The model with a body term applied."""

    @abc.abstractmethod
    def with_armature(self, joint: int, inertia: float) -> RigidModel:
        """The model with a rotor's inertia on one joint, solved implicitly (an explicit one is unstable)."""
