"""Fit a set of effects and physics changes to cloth recordings by simulation (Gauss-Newton with finite differences).

Parameters carry a step: the change that moves the cloth about as much as the residual does.  Every simulation goes
through the `Simulator`, so that an interrupted run finds its results again.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from ....sim.effects.cloth.cloth_registry import CLOTH_EFFECTS
from ....sim.effects.model_file import EffectEntry
from .intervals import half_widths
from .scene import ClothEpisode
from .simulate import Simulator

ENOUGH = 0.003
IDLE = EffectEntry(name="air_drag", target="cloth", parameters={"coefficient": 0.0})
Free = tuple[str, str]  # (effect name or "physics", parameter)


@dataclass(frozen=True, kw_only=True)
class ClothModel:
    """Effects and physics changes with their values, and which of them may move.

    Attributes:
        effects: entries, in order.
        physics: changed physics parameters.
        free: parameters that are fitted.
        carried: the recording shows the mark of proxy bodies (they damp a swing a little), so every run has them.
    """

    effects: tuple[EffectEntry, ...] = ()
    physics: dict[str, float] = field(default_factory=dict)
    free: tuple[Free, ...] = ()
    carried: bool = False

    @property
    def acting(self) -> tuple[EffectEntry, ...]:
        """Effects to simulate, with idle proxy bodies where the model has them."""
        return (*self.effects, IDLE) if self.carried else self.effects

    def value(self, which: Free) -> float:
        """Value of one free parameter."""
        if which[0] == "physics":
            return self.physics[which[1]]
        return next(e for e in self.effects if e.name == which[0]).parameters[which[1]]

    def moved(self, changes: dict[Free, float]) -> ClothModel:
        """The model with some free parameters set to new values, kept inside their bounds."""
        physics = dict(self.physics)
        effects = []
        for (name, parameter), value in changes.items():
            if name == "physics":
                physics[parameter] = max(value, 1e-6)
        for e in self.effects:
            values = dict(e.parameters)
            for p in CLOTH_EFFECTS[e.name].parameters:
                if (e.name, p.name) in changes:
                    values[p.name] = float(np.clip(changes[(e.name, p.name)], p.lower, p.upper))
            effects.append(EffectEntry(name=e.name, target=e.target, parameters=values))
        return replace(self, effects=tuple(effects), physics=physics)

    def joined(self, other: ClothModel) -> ClothModel:
        """Both models' effects and physics."""
        return ClothModel(
            effects=(*self.effects, *other.effects),
            physics={**self.physics, **other.physics},
            free=(*self.free, *other.free),
            carried=self.carried or other.carried,
        )

    def without(self, name: str) -> ClothModel:
        """The model without one effect, or without one physics change."""
        return ClothModel(
            effects=tuple(e for e in self.effects if e.name != name),
            physics={k: v for k, v in self.physics.items() if k != name},
            free=tuple(f for f in self.free if name not in f),
            carried=self.carried,
        )


def predict(sim: Simulator, model: ClothModel, episodes: list[ClothEpisode]) -> list[np.ndarray]:
    """Markers (and load) of every episode under a model."""
    return [sim.run(e, model.acting, model.physics) for e in episodes]


def measured(episode: ClothEpisode) -> np.ndarray:
    """What was recorded, in the layout of `predict`."""
    flat = episode.markers.reshape(len(episode.t), -1)
    return flat if episode.load is None else np.concatenate([flat, episode.load], axis=1)


@dataclass(frozen=True, kw_only=True)
class ClothFit:
    """A fitted model.

    Attributes:
        model: with its free parameters fitted.
        rss: weighted sum of squares.
        residuals: measured minus predicted, per episode.
        half: (P,) half-widths of the 95 % intervals of the free parameters.
    """

    model: ClothModel
    rss: float
    residuals: list[np.ndarray]
    half: np.ndarray


class ClothFitter:
    """Fits models to a group of episodes.

    Attributes:
        weights: (columns,) one over the noise of each column.
    """

    def __init__(self, sim: Simulator, episodes: list[ClothEpisode], weights: np.ndarray) -> None:
        self.sim, self.episodes, self.weights = sim, episodes, weights
        self.data = [measured(e) for e in episodes]

    def residuals(self, model: ClothModel) -> list[np.ndarray]:
        """Measured minus predicted, per episode, unweighted."""
        return [y - x for y, x in zip(self.data, predict(self.sim, model, self.episodes), strict=True)]

    def with_bodies(self, model: ClothModel) -> list[np.ndarray]:
        """The same with proxy bodies on the cloth, as every local effect brings them."""
        return self.residuals(replace(model, carried=True))

    def rss(self, residuals: list[np.ndarray]) -> float:
        """Weighted sum of squares."""
        return float(sum(np.sum((r * self.weights) ** 2) for r in residuals))

    def fit(self, model: ClothModel, steps: dict[Free, float], rounds: int = 3, least: float = ENOUGH) -> ClothFit:
        """Gauss-Newton from the model's own values, each step halved until it helps.

        Args:
            model: where it starts.
            steps: finite difference of each free parameter.
            rounds: at most.
            least: part of the sum of squares that another round has to have gained.
        """
        residuals = self.residuals(model)
        best = self.rss(residuals)
        J = np.zeros((0, len(model.free)))
        for _ in range(rounds):
            if not model.free:
                break
            J = self.columns(model, residuals, steps)
            r = np.concatenate([(x * self.weights).ravel() for x in residuals])
            A = J.T @ J
            size = np.sqrt(np.diag(A)) + 1e-12
            inverse = np.linalg.pinv(A / np.outer(size, size) + 1e-6 * np.eye(len(A))) / np.outer(size, size)
            change = inverse @ (J.T @ r)
            for shrink in (1.0, 0.5, 0.2):
                tried = model.moved({f: model.value(f) + shrink * c for f, c in zip(model.free, change, strict=True)})
                left = self.residuals(tried)
                rss = self.rss(left)
                if rss < best:
                    break
            else:
                break
            gained = best - rss
            model, residuals, best = tried, left, rss
            if gained < least * best:
                break
        return ClothFit(model=model, rss=best, residuals=residuals, half=self._half_widths(J, residuals))

    def with_intervals(self, fit: ClothFit, free: tuple[Free, ...], steps: dict[Free, float]) -> ClothFit:
        """A fit with these numbers free, at the values that it has, and how sure they are together.

        Args:
            fit: the fit.
            free: those that were fitted, at whatever time.
            steps: finite difference of each of them.
        """
        model = replace(fit.model, free=free)
        return replace(
            fit, model=model, half=self._half_widths(self.columns(model, fit.residuals, steps), fit.residuals)
        )

    def _half_widths(self, J: np.ndarray, residuals: list[np.ndarray]) -> np.ndarray:
        """Half-widths (P,) from weighted columns (rows, P); not finite where nothing was fitted."""
        if not len(J) or not J.shape[1]:
            return np.full(J.shape[1], np.inf)
        ends = np.cumsum([r.size for r in residuals])[:-1]
        columns = [X.reshape(*r.shape, -1) for X, r in zip(np.split(J, ends), residuals, strict=True)]
        return half_widths(columns, [r * self.weights for r in residuals])

    def sized(self, models: list[ClothModel], without: ClothModel, which: Free) -> list[tuple[float, ClothModel]]:
        """Each model with one size scaled to what the recordings want, by one simulation; best first.

        Args:
            models: the models.
            without: the same with that size zero.
            which: the size.

        Returns:
            Predicted weighted sum of squares, and the model.
        """
        self.sim.ahead([(e, m.acting, m.physics) for m in (without, *models) for e in self.episodes])
        start = self.flat(self.residuals(without))
        out = []
        for model in models:
            left, factor = scaled_to(start, start - self.flat(self.residuals(model)))
            out.append((left, model.moved({which: factor * model.value(which)})))
        return sorted(out, key=lambda pair: pair[0])

    def flat(self, residuals: list[np.ndarray]) -> np.ndarray:
        """Weighted residuals of all episodes in a row."""
        return np.concatenate([(r * self.weights).ravel() for r in residuals])

    def columns(self, model: ClothModel, residuals: list[np.ndarray], steps: dict[Free, float]) -> np.ndarray:
        """Weighted change of the prediction with each free parameter, by finite differences, (rows, P).

        Args:
            model: where it is taken.
            residuals: of that model.
            steps: finite difference of each free parameter.
        """
        columns = []
        for f in model.free:
            step = steps[f] * 0.3
            x = model.value(f)
            moved = model.moved({f: x + step})
            if abs(moved.value(f) - x) < 0.5 * abs(step):
                moved = model.moved({f: x - step})
            change = moved.value(f) - x
            other = self.residuals(moved)
            columns.append(
                np.concatenate([((a - b) * self.weights).ravel() for a, b in zip(residuals, other, strict=True)])
                / (change if change else 1.0)
            )
        return np.stack(columns, axis=1) if columns else np.zeros((sum(r.size for r in residuals), 0))


def scaled_to(residual: np.ndarray, column: np.ndarray) -> tuple[float, float]:
    """Sum of squares left once as much of a column as helps is taken out, and how much that is (never negative)."""
    factor = max(float(column @ residual) / (float(column @ column) + 1e-30), 0.0)
    return float(np.sum((residual - factor * column) ** 2)), factor


def scaled(model: ClothModel, factor: float, start: ClothModel) -> ClothModel:
    """A model between `start` (0) and `model` (1): every free value moved by `factor`."""
    return replace(model).moved({f: start.value(f) + factor * (model.value(f) - start.value(f)) for f in model.free})
