"""A joint log made ready for comparison: uniform in time, smoothed within its own bandwidth, differentiated."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.interpolate import CubicSpline

from ....sim.effects.effect import JointEffect, JointMotion, Shape, Spread
from ..errors import GapError
from ..measurement import Episode
from ..smoothing import bandwidth, derivative, lowpass, lowpass_both, resample
from .readings import unsound, without_spikes
from .rigid import RigidModel

ROWS = 6000  # an episode is thinned to at most about this many rows
FINE = 16  # rows per period of the cutoff where the log has as many: a sign, a threshold has to be met when it happens
FEWEST = 10  # rows of an episode that the filters have to leave sound
THINNED = 0.4  # cutoff of the filter a log is thinned through, over the rate of the rows
SPEED = 0.98  # correlation with the slope of the position from which on a column is a speed
OFF_SCALE = 0.03  # by which a speed may be larger or smaller than the slope of the position; robots looked at: 0.013
OFF_PHASE = 0.4  # [rad] by which it may be late at the cutoff; robots looked at: 0.21, what was made late: 0.9 and more
RINGING = 5e-4  # of the usual speed: the error of a smoothed speed where a motion starts or ends, 99 of 100 samples
SMEARED = 0.75  # periods of the shared filter's cutoff by which one stretch reaches into the next
ENDS = 0.7  # the same at the ends of a log; two periods tell more equals and cost real logs of seconds too much
SHARED = 0.7  # cutoff of the filter both sides of the balance go through, relative to the motion's


@dataclass(frozen=True, kw_only=True)
class JointLog:
    """One episode.  Arrays are (T, n) over joints; `load` and `measured` went through the same filter.

    Attributes:
        name: of the episode.
        role: `fit`, `heldout` or `repeat`.
        t: time, uniform [s].
        dt: time step [s].
        cutoff: half-power frequency of the shared filter [Hz].
        q, dq, ddq: motion.
        rigid: load of the rigid model along the smoothed motion (T, n).
        measured: measured load, smoothed once like the motion (T, n).
        residual: what the model misses, `measured - rigid` after the shared filter (T, n).
        raw: measured load, thinned but not smoothed to the motion's bandwidth (T, n).
        slow: (n,) speed below which the sign of the velocity is not known.
        trim: rows at either end that the filters spoil.
        step: samples recorded per row.
        left_out: (T,) rows that say nothing; None where all count.
        odd_speeds: columns that are not the slope of their joint's position, and are not used.
    """

    name: str
    role: str
    t: np.ndarray
    dt: float
    cutoff: float
    q: np.ndarray
    dq: np.ndarray
    ddq: np.ndarray
    rigid: np.ndarray
    measured: np.ndarray
    residual: np.ndarray
    raw: np.ndarray
    slow: np.ndarray
    trim: int
    step: int = 1
    left_out: np.ndarray | None = None
    odd_speeds: tuple[str, ...] = ()

    @cached_property
    def inner(self) -> slice | np.ndarray:
        """Rows the filters left sound, without those that are left out."""
        rows = slice(self.trim, len(self.t) - self.trim)
        return rows if self.left_out is None else np.arange(len(self.t))[rows][~self.left_out[rows]]

    def motion(self, joint: int) -> JointMotion:
        """The motion of one joint, before the shared filter."""
        return JointMotion(
            t=self.t,
            q=self.q[:, joint],
            dq=self.dq[:, joint],
            ddq=self.ddq[:, joint],
            load=self.rigid[:, joint],
            measured=self.measured[:, joint],
            slow=float(self.slow[joint]),
        )

    def columns(self, effect: JointEffect, joint: int, shape: Shape) -> np.ndarray:
        """An effect's columns on one joint, through the shared filter, (T_inner, p).

        One that jumps or bends is asked at every sample that was recorded, filtered and thinned as the load was: rows
        alone would place each reversal wrongly by up to half a row, and just where the effect acts.
        """
        if not effect.sharp:
            return self.shared(effect.columns(self.motion(joint), shape))
        dt, cutoff = self.dt / self.step, min(self.cutoff, THINNED / self.dt if self.step > 1 else np.inf)
        fine = effect.columns(self._recorded[joint], shape)
        return lowpass_both(fine, dt, cutoff, self.cutoff / SHARED)[:: self.step][self.inner]

    @cached_property
    def _recorded(self) -> list[JointMotion]:
        """The motion of each joint at every sample recorded; smooth as it is, a spline through the rows has it."""
        motions = [self.motion(j) for j in range(self.q.shape[1])]
        if self.step == 1:
            return motions
        t = self.t[0] + self.dt / self.step * np.arange((len(self.t) - 1) * self.step + 1)
        table = CubicSpline(self.t, np.stack([self.q, self.dq, self.ddq, self.rigid, self.measured], axis=2))(t)
        names = ("q", "dq", "ddq", "load", "measured")
        return [
            replace(m, t=t, **{name: table[:, j, k] for k, name in enumerate(names)}) for j, m in enumerate(motions)
        ]

    def without(self, stretches: list[tuple[float, float]]) -> JointLog:
        """The log without some stretches [s], and what the filters smear of them; as it is if too little is left."""
        if not stretches:
            return self
        reach = SMEARED / self.cutoff
        left_out = np.zeros(len(self.t), dtype=bool) if self.left_out is None else self.left_out.copy()
        for a, b in stretches:
            left_out |= (self.t >= a - reach) & (self.t <= b + reach)
        out = replace(self, left_out=left_out)
        return out if len(self.t[out.inner]) >= FEWEST else self

    def wide(self) -> JointLog:
        """The same log without the shared filter, to see what lies outside the motion's bandwidth."""
        return replace(self, name=f"{self.name}~", cutoff=float("inf"), residual=self.raw - self.rigid)

    def shared(self, columns: np.ndarray, sharp: bool = False) -> np.ndarray:
        """Columns through the filter both sides of the balance go through, ends trimmed.

        Args:
            columns: (T, ...) made from the smoothed motion.
            sharp: they jump or bend where the motion is smooth; then they also go through the filter that smoothed
                the load, as a jump in the load did.
        """
        if sharp:
            return lowpass_both(columns, self.dt, self.cutoff, self.cutoff / SHARED)[self.inner]
        return lowpass(columns, self.dt, self.cutoff)[self.inner]


@dataclass(frozen=True, kw_only=True)
class JointColumns:
    """Which columns of the CSV hold what, per joint."""

    q: tuple[str, ...]
    dq: tuple[str, ...]
    load: tuple[str, ...]


def _matrix(episode: Episode, names: tuple[str, ...]) -> np.ndarray:
    return np.stack([episode.columns[name] for name in names], axis=1)


@dataclass(frozen=True, kw_only=True)
class _Raw:
    """One episode on a uniform grid: arrays (T, n); `dq` is None where the file has no speeds.

    `unsound` are the stretches [s] in which the sensor of some load stands still or is cut off.
    """

    t: np.ndarray
    dt: float
    q: np.ndarray
    load: np.ndarray
    dq: np.ndarray | None
    unsound: list[tuple[float, float]]


def read_logs(episodes: list[Episode], names: JointColumns, model: RigidModel) -> list[JointLog]:
    """Smooth and differentiate all episodes with one bandwidth, and compare each with the model.

    Raises:
        GapError: an episode is too short for that.
    """
    raw = [_resampled(episode, names) for episode in episodes]
    cut, noise_q = _bandwidth_of([(r.q, r.dt) for r in raw])
    noise_v, use_speed, odd = _speed_noise(raw, cut, noise_q)
    logs = [_prepare(episode, r, cut, use_speed, noise_v, model) for episode, r in zip(episodes, raw, strict=True)]
    return [replace(log, odd_speeds=tuple(np.array(names.dq)[odd])) for log in logs]


def _resampled(episode: Episode, names: JointColumns) -> _Raw:
    n = len(names.q)
    load = np.stack([without_spikes(episode.columns[name]) for name in names.load], axis=1)
    parts = [_matrix(episode, names.q), load]
    has_dq = all(name in episode.columns for name in names.dq)
    if has_dq:
        parts.append(_matrix(episode, names.dq))
    t, table, dt = resample(episode.t, np.concatenate(parts, axis=1))
    columns = [(episode.columns[q], episode.columns[load]) for q, load in zip(names.q, names.load, strict=True)]
    return _Raw(
        t=t,
        dt=dt,
        q=table[:, :n],
        load=table[:, n : 2 * n],
        dq=table[:, 2 * n :] if has_dq else None,
        unsound=[span for q, load in columns for span in unsound(episode.t, q, load)],
    )


def _bandwidth_of(series: list[tuple[np.ndarray, float]]) -> tuple[float, np.ndarray]:
    """Bandwidth of the fastest joint [Hz] and (n,) noise of each, medians over episodes.

    Args:
        series: (T, n) samples and their time step [s], per episode.
    """
    per = [[bandwidth(x[:, j], dt) for j in range(x.shape[1])] for x, dt in series]
    cut = float(np.max(np.median([[c for c, _ in row] for row in per], axis=0)))
    return cut, np.median([[s for _, s in row] for row in per], axis=0)


def _speed_noise(raw: list[_Raw], cut: float, noise_q: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Of each joint's speed, (n,): its noise, whether the measured one is used, and whether that is none at all.

    Else it is the slope of the position, the same speed by another route; the quieter is taken.
    """
    dt = float(np.median([r.dt for r in raw]))
    noise_v = noise_q * 2 * np.pi * cut * np.sqrt(2 * cut * dt / 3)
    speeds = [(r.q, r.dq, r.dt) for r in raw if r.dq is not None]
    if len(speeds) < len(raw):
        return noise_v, np.zeros(len(noise_q), dtype=bool), np.zeros(len(noise_q), dtype=bool)
    sensor = _bandwidth_of([(dq, step) for _, dq, step in speeds])[1] * np.sqrt(2 * cut * dt)
    agree = np.median(
        [[_agree(q[:, j], dq[:, j], step, cut) for j in range(dq.shape[1])] for q, dq, step in speeds], axis=0
    )
    use_speed = (sensor < noise_v) & (agree > SPEED)
    return np.where(use_speed, sensor, noise_v), use_speed, (sensor < noise_v) & (agree <= SPEED)


def _agree(q: np.ndarray, dq: np.ndarray, dt: float, cut: float) -> float:
    """Correlation of a speed with the slope of the position within the motion's bandwidth; 0 where it is no such speed.

    It is none where it is late, early, too large or too small by more than a little: then something between the two
    would be called a delay, a friction or a mass.
    """
    slope, speed = (lowpass(x, dt, cut) for x in (np.gradient(q, dt), dq))
    if dq.std() == 0 or slope.std() == 0:
        return 1.0 if slope.std() == dq.std() else 0.0
    # fitted from the speed, which is taken only where it is the quieter one: noise in what is fitted from would bias it
    columns = np.column_stack([speed, np.gradient(speed, dt), np.ones(len(q))])
    scale, late = np.linalg.lstsq(columns, slope, rcond=None)[0][:2]
    phase = 2.0 * np.pi * cut * late
    return float(np.corrcoef(slope, speed)[0, 1]) * bool(abs(scale - 1.0) < OFF_SCALE and abs(phase) < OFF_PHASE)


def _prepare(
    episode: Episode, raw: _Raw, cut: float, use_speed: np.ndarray, noise_v: np.ndarray, model: RigidModel
) -> JointLog:
    t, dt, q, load, dq = raw.t, raw.dt, raw.q, raw.load, raw.dq
    step = max(1, int(np.ceil(len(t) / ROWS)), int(1.0 / (FINE * cut * dt)))
    cut = min(cut, THINNED / (dt * step))
    position = lowpass(q, dt, cut)
    speed, acceleration = derivative(q, dt, cut, 1), derivative(q, dt, cut, 2)
    if dq is not None and use_speed.any():
        speed[:, use_speed] = lowpass(dq, dt, cut)[:, use_speed]
        acceleration[:, use_speed] = derivative(dq, dt, cut, 1)[:, use_speed]
    smooth = lowpass(load, dt, cut)
    thinned = lowpass(load, dt, THINNED / (dt * step)) if step > 1 else load
    pick = slice(None, None, step)
    t, position, speed, acceleration, smooth = t[pick], position[pick], speed[pick], acceleration[pick], smooth[pick]
    thinned = thinned[pick]
    dt = dt * step
    rigid = model.load(position, speed, acceleration)
    # the motion was smoothed before the model saw it, the load was smoothed once: one more filter for both
    shared = min(SHARED * cut, 0.5 / dt)
    residual = lowpass(smooth - rigid, dt, shared)
    slow = np.maximum(4.0 * noise_v, RINGING * np.quantile(np.abs(speed), 0.95, axis=0) + 1e-9)
    trim = int(min(len(t) // 10, np.ceil(ENDS / (shared * dt))))
    if len(t) - 2 * trim < FEWEST:
        raise GapError(
            f"{episode.file}: rows 2 to {len(episode.t) + 1} last {t[-1] - t[0]:.3g} s, too short to be differentiated "
            f"at {shared:.3g} Hz, which this set's motion needs"
        )
    log = JointLog(
        name=episode.name,
        role=episode.role,
        t=t,
        dt=dt,
        cutoff=shared,
        q=position,
        dq=speed,
        ddq=acceleration,
        rigid=rigid,
        measured=smooth,
        residual=residual,
        raw=thinned,
        slow=slow,
        trim=trim,
        step=step,
    )
    return log.without(raw.unsound)


def spread(logs: list[JointLog], joint: int) -> Spread:
    """What the logs cover of one joint's motion."""
    q = np.concatenate([log.q[:, joint] for log in logs])
    dq = np.concatenate([log.dq[:, joint] for log in logs])
    return Spread(
        q=(float(q.min()), float(q.max())),
        speed=float(np.quantile(np.abs(dq), 0.95)),
        slow=float(np.max([log.slow[joint] for log in logs])),
        dt=float(np.max([log.dt for log in logs])),
    )
