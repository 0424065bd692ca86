"""Predictions of a user's system, each asked for once, with the numbers every recording has of its own fitted.

Where a system has `start` parameters (an offset of the first angle), they are what suits a recording best at any
values of the effects, and what they could explain is taken out of residuals and columns alike (variable projection).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType

import numpy as np

from ....sim.effects.effect import Parameter
from ..errors import GapError
from ..measurement import Episode
from .system import Columns, Effect, System

ROWS = 3000  # an episode is compared at no more than about this many rows
STEP = 0.05  # of the typical size, for derivatives by difference
ABSENT = 0.5  # the same where the effect is absent: what it does at a size that would matter is asked for
HUGE = 1e100  # of a prediction, in any unit
BAD = 1e3  # a prediction that is not finite is taken for an error of so many times the gap
ROUNDS = 6  # of fitting a recording's own numbers
LONGEST = 5.0  # typical sizes, of one such step: a prediction that is far off says little of where to start
DAMPED = (1.0, 0.3, 0.1)  # parts of a step that are tried
Values = dict[str, float]


@dataclass(frozen=True, kw_only=True)
class Recording:
    """One episode as the system sees it.

    Attributes:
        episode: the recording.
        columns: what `predict` is given, read-only.
        measured: (T, C) channels, thinned.
        pick: rows that are compared.
    """

    episode: Episode
    columns: Columns
    measured: np.ndarray
    pick: slice

    @property
    def t(self) -> np.ndarray:
        """Times that are compared, (T,) [s]."""
        return self.columns["t"][self.pick]


def recording(episode: Episode, system: System) -> Recording:
    """An episode made ready for `predict`."""
    columns = {}
    for name, x in episode.columns.items():
        columns[name] = x.view()
        columns[name].flags.writeable = False  # a simulator that changes its input would make answers depend on order
    pick = slice(None, None, max(1, -(-len(episode.t) // ROWS)))
    measured = np.stack([episode.columns[c] for c in system.channels], axis=1)[pick]
    return Recording(episode=episode, columns=MappingProxyType(columns), measured=measured, pick=pick)


class Simulation:
    """One system on a group of recordings.

    Attributes:
        system: the user's.
        recordings: what it is compared with.
        calls: how often `predict` was asked.
    """

    def __init__(self, system: System, recordings: Sequence[Recording]) -> None:
        self.system, self.recordings = system, tuple(recordings)
        self.calls = 0
        self._kept: dict[tuple, np.ndarray] = {}
        self._starts: dict[tuple, Values] = {}
        self.parameters: dict[str, Parameter] = {p.name: p for e in system.effects for p in e.parameters}
        self._own = {p.name: p for p in system.start}
        self.none: Values = dict.fromkeys(self.parameters, 0.0)

    @cached_property
    def model_error(self) -> np.ndarray:
        """(C,) what the model leaves although nothing is missing, in the channels' units."""
        return np.array([self.system.model_error.get(channel, 0.0) for channel in self.system.channels])

    @cached_property
    def scale(self) -> np.ndarray:
        """(C,) gap of the model as given: channels may differ in unit, and count alike until the noise is known."""
        left = np.concatenate([r.measured - self.raw(r, self.none) for r in self.recordings])
        reach = np.ptp(np.concatenate([r.measured for r in self.recordings]), axis=0)
        return np.sqrt(np.mean(left**2, axis=0)) + 1e-9 * reach + 1e-15

    @cached_property
    def _own_scale(self) -> np.ndarray:
        """(C,) what channels count by where a recording's own numbers are fitted: the model's own error, if any.

        Over the gap, a channel that is predicted well would outweigh the one that those numbers are about.
        """
        return np.where(self.model_error > 0.0, self.model_error, self.scale)

    def raw(self, r: Recording, values: Values, own: Values | None = None) -> np.ndarray:
        """What the system predicts at one set of numbers, thinned (T, C).

        Raises:
            GapError: the user's code raises, or gives an array of another shape, or numbers that are not finite for the
                model as given.
        """
        own = own or dict.fromkeys(self._own, 0.0)
        key = (r.episode.name, *values.values(), *own.values())
        if key not in self._kept:
            self._kept[key] = self._predicted(r, values, own)
        return self._kept[key]

    def _predicted(self, r: Recording, values: Values, own: Values) -> np.ndarray:
        simulated = {p.name: 0.0 if e.regressor else values[p.name] for e in self.system.effects for p in e.parameters}
        key = (r.episode.name, *simulated.values(), *own.values())
        x = self._kept[key] if key in self._kept else self._asked(r, {**simulated, **own})
        for e in self.system.effects:
            theta = np.array([values[p.name] for p in e.parameters])
            if e.regressor and np.any(theta):
                x = x + self.regressor(r, e) @ theta
        return x

    def _asked(self, r: Recording, values: Values) -> np.ndarray:
        self.calls += 1
        where = f"{type(self.system).__name__}.predict"
        try:
            x = np.asarray(self.system.predict(r.columns, MappingProxyType(values)), dtype=float)
        except (Exception, SystemExit) as error:  # whatever a user's simulator raises
            says = " ".join(str(error).split())[:160]
            raise GapError(f"{where} raised {type(error).__name__} on {r.episode.name}: {says}") from None
        rows, channels = len(r.columns["t"]), len(self.system.channels)
        x = x[:, None] if x.ndim == 1 else x
        if x.shape != (rows, channels):
            raise GapError(
                f"{where} returned an array of shape {x.shape} on {r.episode.name}, ({rows}, {channels}) is needed"
            )
        x = x[r.pick]
        sound = np.abs(x) < HUGE  # its square is finite too
        if sound.all():
            return x
        if not any(values.values()):
            raise GapError(f"{where} is not finite, or huge, on {r.episode.name} for the model as given")
        return np.where(sound, x, r.measured + BAD * self.scale)

    def regressor(self, r: Recording, effect: Effect) -> np.ndarray:
        """Columns of an effect the prediction is linear in, thinned (T, C, p).

        Raises:
            GapError: the user's code raises, or gives another shape.
        """
        key = (r.episode.name, *effect.key)
        if key not in self._kept:
            assert effect.regressor is not None
            shape = (len(r.columns["t"]), len(self.system.channels), len(effect.parameters))
            try:
                x = np.asarray(effect.regressor(r.columns), dtype=float).reshape(shape)
            except Exception as error:
                says = " ".join(str(error).split())[:160]
                raise GapError(f"regressor of {effect.name}: {type(error).__name__}: {says}") from None
            if not np.isfinite(x).all():
                raise GapError(f"regressor of {effect.name} is not finite on {r.episode.name}")
            self._kept[key] = x[r.pick]
        return self._kept[key]

    def own(self, r: Recording, values: Values) -> Values:
        """The recording's own numbers that suit it best at these values."""
        if not self._own:
            return {}
        key = (r.episode.name, *values.values())
        if key not in self._starts:
            now = dict.fromkeys(self._own, 0.0)
            for _ in range(ROUNDS):
                new = self._nearer(r, values, now)
                small = all(abs(new[k] - now[k]) < 1e-3 * self._own[k].typical for k in now)
                now = new
                if small:
                    break
            self._starts[key] = now
        return self._starts[key]

    def _nearer(self, r: Recording, values: Values, now: Values) -> Values:
        """A recording's own numbers after one step of least squares, or as they are where none makes it better."""
        left = (r.measured - self.raw(r, values, now)) / self._own_scale
        N = self._own_columns(r, values, now) / self._own_scale[:, None]
        step = np.linalg.lstsq(N.reshape(-1, len(now)), left.ravel(), rcond=1e-8)[0]
        most = LONGEST * np.array([p.typical for p in self._own.values()])
        step = step / max(1.0, float(np.max(np.abs(step) / most)))
        for part in DAMPED:
            new = {
                k: float(np.clip(v + part * d, self._own[k].lower, self._own[k].upper))
                for (k, v), d in zip(now.items(), step, strict=True)
            }
            if np.sum(((r.measured - self.raw(r, values, new)) / self._own_scale) ** 2) < np.sum(left**2):
                return new
        return now

    def _own_columns(self, r: Recording, values: Values, own: Values) -> np.ndarray:
        """Change of the prediction per unit of each of the recording's own numbers, (T, C, s)."""
        base = self.raw(r, values, own)
        out = []
        for name, p in self._own.items():
            h = STEP * p.typical * (1.0 if own[name] + STEP * p.typical <= p.upper else -1.0)
            out.append((self.raw(r, values, {**own, name: own[name] + h}) - base) / h)
        return np.stack(out, axis=2)

    def predict(self, r: Recording, values: Values) -> np.ndarray:
        """Prediction with the recording's own numbers fitted, (T, C)."""
        return self.raw(r, values, self.own(r, values))

    def left(self, r: Recording, values: Values) -> np.ndarray:
        """Measured minus predicted, (T, C)."""
        return r.measured - self.predict(r, values)

    def tangent(self, r: Recording, values: Values, effect: Effect) -> np.ndarray:
        """Change of the prediction per unit of each parameter of an effect, (T, C, p), at these values.

        What the recording's own numbers could do instead is taken out.
        """
        own = self.own(r, values)
        if effect.regressor:
            return self._without_own(r, values, own, self.regressor(r, effect))
        out = []
        for p in effect.parameters:
            h = (STEP if values[p.name] else ABSENT) * p.typical
            ends = [values[p.name] + s * h for s in (-1.0, 1.0)]
            ends = [x if p.lower <= x <= p.upper else values[p.name] for x in ends]
            low, high = (self.raw(r, {**values, p.name: x}, own) for x in ends)
            out.append((high - low) / (ends[1] - ends[0]))
        return self._without_own(r, values, own, np.stack(out, axis=2))

    def _without_own(self, r: Recording, values: Values, own: Values, columns: np.ndarray) -> np.ndarray:
        """Columns (T, C, p) less what the recording's own numbers explain of them."""
        if not self._own:
            return columns
        s = self._own_scale[:, None]
        N = (self._own_columns(r, values, own) / s).reshape(-1, len(self._own))
        X = (columns / s).reshape(-1, columns.shape[2])
        return (X - N @ np.linalg.lstsq(N, X, rcond=1e-8)[0]).reshape(columns.shape) * s

    def repeats(self) -> bool:
        """Whether asking twice gives the same answer."""
        r = self.recordings[0]
        first = self.raw(r, self.none)
        values = {**self.none, **dict.fromkeys(self._own, 0.0)}
        return bool(np.array_equal(first, self._asked(r, values)))
