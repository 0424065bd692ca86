"""A set of effects with one member left out, or another in its place, fitted by simulation.

A search that takes one effect after another may take first what stands for two, or for one whose place and instant
nobody has looked for yet, and never leaves it again.  Here each member is taken out of the final set, every hypothesis
is screened beside the rest, and the best are fitted in its place as carefully as the named ones were.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .candidates import Candidate, candidates, clash
from .fitting import ClothFit, ClothFitter, ClothModel
from .polish import begun, polish, settled, steps_of
from .scene import ClothScene
from .screening import screened

SAME = 12.0  # criterion within which two explanations fit alike
HOPELESS = 5.0  # those screened so many times farther off are fitted only where they are among the
TRIED = 3  # best so many
PROMISING = 0.5  # part of what a member explains from which on what stands in for it is fitted carefully,
CAREFUL = 2  # at most so many
SOUGHT = {"added_mass": 2, "snag": 3, "strain_stiffening": 1, "grip_slip": 0}  # places and instants that are looked for


@dataclass(frozen=True, kw_only=True)
class Other:
    """Another set.

    Attributes:
        chosen: its members.
        fit: on the same recordings.
    """

    chosen: tuple[Candidate, ...]
    fit: ClothFit

    @property
    def numbers(self) -> int:
        """How many numbers were looked for."""
        return len(self.fit.model.free) + sum(SOUGHT.get(c.name, 0) for c in self.chosen)


@dataclass(frozen=True, kw_only=True)
class Exchange:
    """Changes one member of a set.

    Attributes:
        fitter: of all recordings that are searched.
        scene: the cloth.
        named: the set.
        worth: independent samples.
    """

    fitter: ClothFitter
    scene: ClothScene
    named: Other
    worth: float

    def worse(self, other: Other) -> float:
        """By how much another set fits worse than the named one."""
        return float(self.worth * np.log((other.fit.rss + 1e-30) / (self.named.fit.rss + 1e-30)))

    def without(self, member: Candidate) -> Other:
        """The set without a member."""
        rest = self._rest(member)
        return Other(chosen=rest, fit=self.fitter.fit(self._model(member), steps_of(rest), rounds=2))

    def joined(self, c: Candidate) -> Other:
        """The set with a hypothesis more."""
        model = self.named.fit.model
        c = begun(self.fitter, model, c, self.named.fit.rss)
        chosen = (*self.named.chosen, c)
        return Other(chosen=chosen, fit=self.fitter.fit(model.joined(c.push), steps_of(chosen), rounds=2))

    def instead(self, member: Candidate) -> list[Other]:
        """The set with the hypotheses that are likeliest in a member's place."""
        rest, model = self._rest(member), self._model(member)
        held, bare = self.fitter.residuals(model), self.without(member).fit.rss
        out = []
        for likely in self._likely(rest, model, held):
            c = begun(self.fitter, model, likely, self.fitter.rss(held))
            fit = self.fitter.fit(model.joined(c.push), steps_of((*rest, c)), rounds=2)
            out.append(Other(chosen=(*rest, c), fit=fit))
        out.sort(key=self.worse)
        promising = bare - PROMISING * (bare - self.named.fit.rss)
        return [self._careful(o) if k < CAREFUL and o.fit.rss < promising else o for k, o in enumerate(out)]

    def _rest(self, member: Candidate) -> tuple[Candidate, ...]:
        return tuple(c for c in self.named.chosen if c is not member)

    def _model(self, member: Candidate) -> ClothModel:
        return self.named.fit.model.without(member.name)

    def _likely(self, rest: tuple[Candidate, ...], model: ClothModel, held: list[np.ndarray]) -> list[Candidate]:
        """Hypotheses by what they would explain of the recording that the rest leaves most of, the best first."""
        worst = int(np.argmax([np.mean((r * self.fitter.weights) ** 2) for r in held]))
        alone = ClothFitter(self.fitter.sim, [self.fitter.episodes[worst]], self.fitter.weights)
        seen, named = [held[worst]], alone.rss([self.named.fit.residuals[worst]]) + 1e-30
        pool = self._pool(rest, model)
        own = alone.columns(model, seen, steps_of(rest))
        ranked, left = screened(alone, model, own, pool, float(np.sqrt(alone.rss(seen))))
        worth = self.worth * held[worst].size / sum(r.size for r in held)
        near = [c for c in ranked if worth * np.log((left[c.name] + 1e-30) / named) < HOPELESS * SAME]
        return ranked[: max(TRIED, len(near))]

    def _pool(self, rest: tuple[Candidate, ...], model: ClothModel) -> list[Candidate]:
        taken, others = {c.name for c in self.named.chosen}, {c.name for c in rest}
        every = candidates(self.scene, self.fitter.episodes, self.fitter.with_bodies(model))
        return [c for c in every if c.name not in taken and not clash(c.name, others)]

    def _careful(self, other: Other) -> Other:
        """A set whose last member's place and instants are looked for, as those of the named ones were."""
        if other.chosen[-1].name in SOUGHT:
            fit = polish(self.fitter, other.fit, other.chosen, self.scene, anew=False)
            return Other(chosen=other.chosen, fit=fit)
        return Other(chosen=other.chosen, fit=settled(self.fitter, other.fit, other.chosen))
