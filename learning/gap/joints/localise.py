"""Where the disagreement is: per effect the times it acts, per unexplained channel the times it stands out."""

from __future__ import annotations

import numpy as np

from ..findings import Where
from ..measurement import MeasurementSet
from ..regions import intervals, phase_of, scan, state_region
from .block import Block
from .log import JointLog
from .outcome import SIGNIFICANT, Outcome
from .thresholds import REMAINDER_SIZE
from .workflow import Named

ACTIVE = 0.05  # an effect acts where its load exceeds this part of its largest
LOCAL = 0.6  # an effect that acts in less of the time than this is localised


def places(
    measured: MeasurementSet,
    joints: tuple[str, ...],
    logs: list[JointLog],
    named: Named,
    outcome: Outcome,
    channels: tuple[str, ...],
) -> list[Where]:
    """Places of every named effect, burst and unexplained leftover, in all episodes.

    Args:
        measured: the set.
        joints: what each channel belongs to.
        logs: all recordings.
        named: the effects.
        outcome: what they leave.
        channels: names of the columns.
    """
    out: list[Where] = []
    phases = {e.name: e.phases for e in measured.episodes}
    p_values = _p_values(named)
    at = 0
    for k, block in enumerate(named.blocks):
        theta = named.theta[at : at + len(block.parameters)]
        at += len(block.parameters)
        for log in logs:
            out += _of_effect(block, theta, log, outcome, channels, phases[log.name], p_values[k])
    for b in outcome.bursts:
        log = next(x for x in logs if x.name == b.episode)
        rows = (log.t >= b.t0) & (log.t <= b.t1)
        out.append(
            Where(
                channel=channels[b.channel],
                target=joints[b.channel],
                episode=b.episode,
                t0=b.t0,
                t1=b.t1,
                state_region="contact",
                phase=phase_of(phases[b.episode], b.t0, b.t1),
                effect="contact",
                p_value=float(np.exp(-0.5 * b.strength**2)) * int(rows.sum()),
                size=b.strength,
            )
        )
    if outcome.verdict == "unknown":
        fitted = [log for log in logs if log.role != "heldout"]
        for r in outcome.remainders:
            if r.p_value >= SIGNIFICANT / len(channels) or r.energy < REMAINDER_SIZE * (r.base - r.energy):
                continue
            for log, left in zip(fitted, outcome.left, strict=True):
                energy = left[:, r.channel] ** 2
                t = log.t[log.inner]
                region = _region(energy, log, r.channel)
                spans = scan(energy, t, outcome.floor[r.channel] ** 2, 0.05 * (t[-1] - t[0])) or [
                    (float(t[0]), float(t[-1]))
                ]
                for a, b in spans:
                    out.append(
                        Where(
                            channel=channels[r.channel],
                            target=joints[r.channel],
                            episode=log.name,
                            t0=a,
                            t1=b,
                            state_region=region,
                            phase=phase_of(phases[log.name], a, b),
                            p_value=r.p_value,
                            size=float(np.sqrt(r.energy) / outcome.floor[r.channel]),
                        )
                    )
    return out


def _p_values(named: Named) -> list[float]:
    from scipy.stats import chi2

    search = named.search
    tried = len({b.key for b in search.blocks})
    out = []
    for i in named.chosen:
        rest = tuple(j for j in named.chosen if j != i)
        gain = float(search.rows @ (np.log(search.rss(rest)) - np.log(search.rss(named.chosen))))
        block = search.blocks[i]
        out.append(min(1.0, tried * block.trials * float(chi2.sf(gain / search.widening[i], block.size))))
    return out


def _region(energy: np.ndarray, log: JointLog, c: int) -> str:
    s = log.inner
    return state_region(energy, log.q[s][:, c], log.dq[s][:, c], log.ddq[s][:, c], log.rigid[s][:, c], log.dt)


def _of_effect(
    block: Block,
    theta: np.ndarray,
    log: JointLog,
    outcome: Outcome,
    channels: tuple[str, ...],
    phases,
    p_value: float,
) -> list[Where]:
    load = block.build(log) @ theta  # (T, channels of the block)
    sizes = np.sqrt(np.mean(load**2, axis=0)) / outcome.floor[list(block.channels)]
    k = int(np.argmax(sizes))
    c = block.channels[k]
    t = log.t[log.inner]
    mine = np.abs(load[:, k])
    peak = mine.max()
    if peak <= 1e-12:
        return []
    active = mine > ACTIVE * peak
    region = "contact" if block.name == "contact" else _region(load[:, k] ** 2, log, c)
    span = float(t[-1] - t[0])
    found = [(float(t[0]), float(t[-1]))]
    if block.term is not None and block.term.during is not None:
        found = [(max(a, float(log.t[0])), min(b, float(log.t[-1]))) for a, b in block.term.during.of(log.name)]
    elif block.name == "contact" or (
        active.mean() < LOCAL and block.name not in ("coulomb_friction", "viscous_friction")
    ):
        found = intervals(active, t, 0.004 * span, 2.0 * log.dt)
    return [
        Where(
            channel=channels[c],
            target=block.body,
            episode=log.name,
            t0=a,
            t1=b,
            state_region=region,
            phase=phase_of(phases, a, b),
            p_value=p_value,
            size=float(sizes[k]),
            effect=block.name,
        )
        for a, b in found
    ]
