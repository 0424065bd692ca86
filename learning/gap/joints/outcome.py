"""From a set of effects and what it leaves to a verdict: adequate, recalibration, effects or unknown."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..findings import EffectFinding, Value, VerdictName
from .block import Block
from .events import Burst, burst_share, bursts
from .log import JointLog
from .remainder import Remainder, leftover
from .symbolic import guess
from .thresholds import BURST_SHARE, REMAINDER, REMAINDER_SIZE, TRANSFER
from .workflow import Named, explained


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """The judgement.

    Attributes:
        verdict: one of the four.
        p_value: of the leftover, where it speaks for a missing effect; else 1.
        floor: (C,) noise floor: repeats, or what no prediction removes.
        left: residual after the effects, per log.
        bursts: contacts in time, in held-out logs too.
        contacts: the same as findings.
        remainders: per channel.
        guess: formula for an unknown effect, or "".
    """

    verdict: VerdictName
    p_value: float
    floor: np.ndarray
    left: list[np.ndarray]
    bursts: tuple[Burst, ...]
    contacts: tuple[EffectFinding, ...]
    remainders: tuple[Remainder, ...]
    guess: str


OTHERWISE = 0.2  # part of what is left on held-out logs that other numbers for the same effects have to remove
SURE = 0.01  # level of the test on leftovers, all channels together


def judge(named: Named, logs: list[JointLog], heldout: list[JointLog], joints: tuple[str, ...], unit: str) -> Outcome:
    """Look at what the named effects leave and decide."""
    blocks = list(named.blocks)
    left = [log.residual[log.inner] - explained(blocks, named.theta, log) for log in logs]
    channels = left[0].shape[1]
    broad = [log.wide() for log in logs]
    wide = [w.residual[w.inner] - explained(blocks, named.theta, w) for w in broad]
    found: list[Burst] = []
    for c in range(channels):
        # a short contact is broader in frequency than the motion, so bursts are looked for without the shared filter
        mine = [replace(b, episode=b.episode.rstrip("~")) for b in bursts(broad, wide, c)]
        total = np.mean(np.concatenate([w.residual[w.inner][:, c] for w in broad]) ** 2)
        rest = np.mean(np.concatenate([x[:, c] for x in wide]) ** 2)
        share = burst_share(logs, wide, c, mine) if mine else 0.0
        # next to a large effect, a burst may be no more than that effect's own form being a little wrong
        if share > BURST_SHARE and share * rest > REMAINDER * (total - rest + share * rest):
            found += mine
    kept = [log.wide() for log in heldout]
    spare = [w.residual[w.inner] - explained(blocks, named.theta, w) for w in kept]
    seen = list(found)  # the same channels in the held-out logs, to say where; nothing is fitted to them
    for c in sorted({b.channel for b in found}):
        seen += [replace(b, episode=b.episode.rstrip("~")) for b in bursts(kept, spare, c)]
    calm = _without(logs, left, found)
    wide = _without(logs, wide, found)
    remainders = tuple(leftover(logs, calm, wide, c) for c in range(channels))
    total = np.mean(np.concatenate([log.residual[log.inner] for log in logs]) ** 2, axis=0)
    rest = np.mean(np.concatenate(calm) ** 2, axis=0)
    floor2 = np.array(
        [
            max(rest[c] - (r.energy if r.p_value < SURE / channels and r.kind != "time wave" else 0.0), 0.05 * rest[c])
            for c, r in enumerate(remainders)
        ]
    )
    if named.noise.source == "repeats":
        floor2 = np.minimum(named.noise.rms**2, np.maximum(rest, 1e-30))
    weight = 1.0 / floor2
    energy = np.array(
        [
            r.energy if r.p_value < SURE / channels and r.energy > REMAINDER_SIZE * (r.base - r.energy) else 0.0
            for r in remainders
        ]
    )
    explained_energy = np.maximum(total - rest, 0.0)
    share = float(weight @ energy / (weight @ (energy + explained_energy) + 1e-30))
    p = float(min([r.p_value * channels for r, e in zip(remainders, energy, strict=True) if e > 0], default=1.0))
    strange = bool(blocks) and _strange(named, heldout, left) > REMAINDER
    unknown = (bool(energy.any()) and share > REMAINDER) or strange
    effects = any(not b.recalibration for b in blocks) or bool(found)
    verdict: VerdictName = "unknown" if unknown else "effects" if effects else "recalibration" if blocks else "adequate"
    text = ""
    if strange:
        text = "the effects that explain the fitted recordings do not hold on the held-out ones"
    elif unknown:
        worst = max(
            (r for r, e in zip(remainders, energy, strict=True) if e > 0), key=lambda r: weight[r.channel] * r.energy
        )
        text = guess(logs, calm, worst)
    return Outcome(
        verdict=verdict,
        p_value=min(p, 1.0),
        floor=np.sqrt(floor2),
        left=left,
        bursts=tuple(seen),
        contacts=_contacts(found, joints, unit),
        remainders=remainders,
        guess=text,
    )


def _strange(named: Named, heldout: list[JointLog], fitted: list[np.ndarray]) -> float:
    """Part of the explainable held-out energy that is left there beyond what the fit left on the worst of its own logs.

    It counts where other numbers for the same effects would remove a good part of it, or where the state, the way or
    the clock foretell it; the rest is a louder log.

    Args:
        named: the effects.
        heldout: logs nothing was fitted to.
        fitted: (T, C) residual left on each log it was fitted to.
    """
    blocks = list(named.blocks)
    before = [log.residual[log.inner] for log in heldout]
    after = [y - explained(blocks, named.theta, log) for y, log in zip(before, heldout, strict=True)]
    given = np.mean(np.concatenate(before) ** 2, axis=0)
    left = np.mean(np.concatenate(after) ** 2, axis=0)
    rest = np.max([np.mean(x**2, axis=0) for x in fitted], axis=0)
    loud = np.flatnonzero(left > TRANSFER * rest)
    if not len(loud):
        return 0.0
    broad = [log.wide() for log in heldout]
    wide = [w.residual[w.inner] - explained(blocks, named.theta, w) for w in broad]
    again = np.mean(np.concatenate(_refitted(blocks, heldout, after, rest)) ** 2, axis=0)
    excess = np.zeros(len(rest))
    for c in loud:
        if again[c] < (1.0 - OTHERWISE) * left[c]:
            excess[c] = left[c] - rest[c]
            continue
        found = leftover(heldout, after, wide, int(c))
        if found.p_value < SURE / len(rest):
            excess[c] = min(found.energy, left[c] - rest[c])
    weight = 1.0 / (rest + 1e-30)
    return float(weight @ excess / (weight @ (excess + np.maximum(given - left, 0.0)) + 1e-30))


def _refitted(blocks: list[Block], logs: list[JointLog], left: list[np.ndarray], noise: np.ndarray) -> list[np.ndarray]:
    """What remains of `left` (T, C) per log where the effects take the values that suit these logs best."""
    columns = []
    for log, y in zip(logs, left, strict=True):
        X = np.zeros((*y.shape, sum(len(b.parameters) for b in blocks)))
        at = 0
        for b in blocks:
            X[:, list(b.channels), at : at + len(b.parameters)] = b.build(log)
            at += len(b.parameters)
        columns.append(X)
    scale = 1.0 / np.sqrt(noise + 1e-30)
    rows = np.concatenate([(X * scale[:, None]).reshape(-1, X.shape[2]) for X in columns])
    theta = np.linalg.lstsq(rows, np.concatenate([(y * scale).ravel() for y in left]), rcond=None)[0]
    return [y - X @ theta for X, y in zip(columns, left, strict=True)]


def _without(logs: list[JointLog], left: list[np.ndarray], found: list[Burst]) -> list[np.ndarray]:
    out = [x.copy() for x in left]
    for b in found:
        for log, x in zip(logs, out, strict=True):
            if log.name == b.episode:
                t = log.t[log.inner]
                x[(t >= b.t0) & (t <= b.t1), b.channel] = 0.0
    return out


def _contacts(found: list[Burst], joints: tuple[str, ...], unit: str) -> tuple[EffectFinding, ...]:
    """Bursts of one joint as a contact with its mean load."""
    out = []
    for c in sorted({b.channel for b in found}):
        mine = [b for b in found if b.channel == c]
        load = np.array([b.load for b in mine])
        spread = 1.96 * load.std() / max(np.sqrt(len(load)), 1.0)
        out.append(
            EffectFinding(
                name="contact",
                target=joints[c],
                size=float(max(b.strength for b in mine)),
                parameters=(
                    Value(
                        name="load",
                        unit=unit,
                        value=float(load.mean()),
                        low=float(load.mean() - spread),
                        high=float(load.mean() + spread),
                    ),
                ),
                experiment="repeat the motion: a contact with something in the way comes back at the same place",
            )
        )
    return tuple(out)
