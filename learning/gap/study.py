"""One measurement set under study: the four steps, whatever the system."""

from __future__ import annotations

import abc
from typing import Any

from .findings import Change, EffectFinding, FollowUp, Gap, Placebo, Rival, Verdict, VerdictName, Where, doubted
from .measurement import MeasurementSet
from .pictures import Curve

UNNAMED = "something that has no name here acts too, and the interval does not know of it"


class Study(abc.ABC):
    """The workflow on one set.  Each step uses the ones before it and remembers what it found.

    Attributes:
        measured: the set.
        alpha: level of the tests.
        notes: sentences for the end of the report.
        source: where a simulator of the user's own comes from, or "".
    """

    source = ""

    def __init__(self, measured: MeasurementSet, alpha: float = 0.05) -> None:
        self.measured = measured
        self.alpha = alpha
        self.notes: list[str] = []

    @abc.abstractmethod
    def find(self) -> tuple[float, str, tuple[Where, ...]]:
        """Whether the model is adequate and where not: (p-value over all tried, floor's source, places)."""

    @abc.abstractmethod
    def name(self) -> tuple[VerdictName, tuple[EffectFinding, ...], tuple[EffectFinding, ...], str]:
        """What is missing: (verdict, effects, recalibrated parameters, symbolic guess where unknown)."""

    @abc.abstractmethod
    def patch(self) -> dict[str, Any]:
        """Content of model.yaml."""

    @abc.abstractmethod
    def show(self) -> tuple[Gap, Gap | None, tuple[Placebo, ...], dict[str, str]]:
        """Held-out gap, the same by forward rollouts, placebo controls, smallest detectable size per effect."""

    @abc.abstractmethod
    def curves(self) -> list[Curve]:
        """What to draw."""

    def rivals(self) -> tuple[Rival, ...]:
        """Other whole sets of effects this data cannot rule out, likeliest first."""
        return ()

    def changes(self) -> tuple[Change, ...]:
        """Instants at which a payload changes within a recording."""
        return ()

    def follow_up(self) -> tuple[FollowUp, ...]:
        """Recordings to make next, for the workflow to be run on again."""
        return ()

    def conclude(self, seconds: float = 0.0) -> Verdict:
        """All four steps as one verdict."""
        p_value, source, where = self.find()
        verdict, effects, recalibration, guess = self.name()
        if verdict == "unknown":
            effects, recalibration = (tuple(doubted(f, UNNAMED) for f in group) for group in (effects, recalibration))
        gap, forward, placebos, detectable = self.show()
        return Verdict(
            set=str(self.measured.folder.name),
            system=self.measured.system,
            verdict=verdict,
            where=where,
            effects=effects,
            recalibration=recalibration,
            gap=gap,
            alpha=self.alpha,
            p_value=p_value,
            floor_source=source,
            guess=guess,
            placebos=placebos,
            rivals=self.rivals(),
            follow_up=self.follow_up(),
            forward=forward,
            changes=self.changes(),
            detectable=detectable,
            notes=tuple(dict.fromkeys(self.notes)),
            seconds=seconds,
        )
