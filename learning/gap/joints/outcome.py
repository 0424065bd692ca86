"""From a set of effects and what it leaves to a verdict: adequate, recalibration, effects or unknown."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import chi2

from ..findings import EffectFinding, Value, VerdictName
from .block import Block
from .log import JointLog
from .remains.events import Burst, burst_share, bursts, stands_out
from .remains.remainder import Remainder, leftover
from .remains.symbolic import guess
from .thresholds import BURST_SHARE, MOST, REMAINDER, REMAINDER_SIZE, SHARE, TRANSFER
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


REFIT_GAIN = 0.2  # part of what is left on held-out logs that other numbers for the same effects have to remove
MET_ONCE = "repeat the motion: a contact with something in the way comes back at the same place"
SIGNIFICANT = 0.01  # level of the test on leftovers, all channels together


def judge(
    named: Named,
    logs: list[JointLog],
    heldout: list[JointLog],
    joints: tuple[str, ...],
    unit: str,
    worse: str = "",
    model_error: np.ndarray | None = None,
    doubts: str = "",
    unsteady: str = "",
) -> Outcome:
    """Look at what the named effects leave and decide.

    Args:
        named: the effects the search chose, with their values.
        logs: the logs they were fitted to.
        heldout: logs nothing was fitted to.
        joints: names, one per channel.
        unit: of the load.
        worse: what had been named before the held-out logs were seen to be worse with it, or "".
        model_error: (C,) what the model leaves although nothing is missing, root mean square, or None.
        doubts: why the loads cannot be those of the model, or "".
        unsteady: which effect is not the same all the time, or "".
    """
    error2 = np.zeros(logs[0].residual.shape[1]) if model_error is None else model_error**2
    left = unexplained(named, logs)
    broad = [log.wide() for log in logs]
    wide = unexplained(named, broad)
    found = [b for b in _contact_bursts(logs, broad, wide, left) if b.load**2 > error2[b.channel]]
    calm, calm_wide = _without(logs, left, found), _without(logs, wide, found)
    remainders = tuple(leftover(logs, calm, calm_wide, c, named.blocks) for c in range(left[0].shape[1]))
    total = np.mean(np.concatenate([log.residual[log.inner] for log in logs]) ** 2, axis=0)
    rest = np.mean(np.concatenate(calm) ** 2, axis=0)
    floor2 = np.maximum(_squared_floor(named, remainders, rest), error2)
    explains = np.maximum(total - rest, 0.0)
    missing = _Missing(remainders=remainders, weight=1.0 / floor2, explained=explains, error2=error2)
    strange = bool(named.blocks) and _strange(named, heldout, left, error2) > REMAINDER
    unknown = (bool(missing.energy.any()) and missing.much) or strange
    text = ""
    unknown = unknown or bool(worse) or bool(doubts) or bool(unsteady)
    if doubts:
        text = doubts
    elif worse:
        text = f"{worse} would explain the fitted recordings and make the held-out ones worse"
    elif unsteady:
        text = unsteady
    elif strange:
        text = "the effects that explain the fitted recordings do not hold on the held-out ones"
    elif unknown:
        text = guess(logs, calm, missing.worst)
    return Outcome(
        verdict=_verdict(named, found, unknown),
        p_value=min(missing.p_value, 1.0),
        floor=np.sqrt(floor2),
        left=left,
        bursts=(*found, *_bursts_in_held_out(named, heldout, found)),
        contacts=_contacts(found, joints, unit),
        remainders=remainders,
        guess=text,
    )


def makes_worse(named: Named, heldout: list[JointLog]) -> bool:
    """Whether held-out logs are farther from the model with the effects, in the load's unit or against the noise."""
    return farther([log.residual[log.inner] for log in heldout], unexplained(named, heldout), named.noise.rms)


def farther(before: list[np.ndarray], after: list[np.ndarray], noise: np.ndarray) -> bool:
    """Whether what is left afterwards (T, C) is more than before, as it is or against the noise (C,)."""
    b, a = (np.mean(np.concatenate(x) ** 2, axis=0) for x in (before, after))
    weight = 1.0 / noise**2
    return bool(a.sum() > b.sum() or weight @ a > weight @ b)


def louder(heldout: list[np.ndarray], fitted: list[np.ndarray]) -> bool:
    """Whether some channel of what is left (T, C) is more in logs held out than in the worst one fitted to."""
    worst = np.max([np.mean(x**2, axis=0) for x in fitted], axis=0)
    return bool(np.any(np.mean(np.concatenate(heldout) ** 2, axis=0) > worst))


def inadequacy(named: Named, outcome: Outcome, alpha: float) -> float:
    """p-value of the model as given over every effect tried, or of what the effects leave, if that is smaller."""
    search = named.search
    gains = search.gains(())
    tried = len({b.key for b in search.blocks})
    single = [
        min(1.0, tried * b.trials * float(chi2.sf(gains[i] / search.widening[i], b.size)))
        for i, b in enumerate(search.blocks)
    ]
    if outcome.verdict == "adequate":  # a gain that is significant but not material, or does not repeat
        return max(min(single), alpha) if not named.blocks else min(single)
    return float(min([*single, outcome.p_value]))


def unexplained(named: Named, logs: list[JointLog]) -> list[np.ndarray]:
    """Residual the named effects leave, (T_inner, C) per log."""
    blocks = list(named.blocks)
    return [log.residual[log.inner] - explained(blocks, named.theta, log) for log in logs]


def _verdict(named: Named, found: list[Burst], unknown: bool) -> VerdictName:
    if unknown:
        return "unknown"
    if any(not b.recalibration for b in named.blocks) or found:
        return "effects"
    return "recalibration" if named.blocks else "adequate"


def _bursts_of_channel(broad: list[JointLog], wide: list[np.ndarray], channel: int) -> list[Burst]:
    """Bursts of one channel; they carry the names of the logs before `JointLog.wide`."""
    return [replace(b, episode=b.episode.rstrip("~")) for b in bursts(broad, wide, channel)]


def _contact_bursts(
    logs: list[JointLog], broad: list[JointLog], wide: list[np.ndarray], left: list[np.ndarray]
) -> list[Burst]:
    """Bursts of the channels in which they hold a material part of what is left.

    A short contact is broader in frequency than the motion, so bursts are looked for without the shared filter.  But
    there the model's own load is smoother than the one measured, so a burst has to stand out behind that filter too.

    Args:
        logs: the logs the effects were fitted to.
        broad: the same logs without the shared filter.
        wide: (T_inner, C) per log, what the effects leave of `broad`.
        left: the same of `logs`.
    """
    found: list[Burst] = []
    for c in range(wide[0].shape[1]):
        mine = [b for b in _bursts_of_channel(broad, wide, c) if stands_out(b, logs, left)]
        total = np.mean(np.concatenate([w.residual[w.inner][:, c] for w in broad]) ** 2)
        rest = np.mean(np.concatenate([x[:, c] for x in wide]) ** 2)
        share = burst_share(logs, wide, c, mine) if mine else 0.0
        # next to a large effect, a burst may be no more than that effect's own form being a little wrong
        if share > BURST_SHARE and share * rest > REMAINDER * (total - rest + share * rest):
            found += mine
    return found


def _bursts_in_held_out(named: Named, heldout: list[JointLog], found: list[Burst]) -> list[Burst]:
    """Bursts of the same channels in the held-out logs, to say where; nothing is fitted to them."""
    channels = sorted({b.channel for b in found})
    if not channels:
        return []
    broad = [log.wide() for log in heldout]
    wide = unexplained(named, broad)
    return [b for c in channels for b in _bursts_of_channel(broad, wide, c)]


def _squared_floor(named: Named, remainders: tuple[Remainder, ...], rest: np.ndarray) -> np.ndarray:
    """(C,) squared noise floor: what no prediction removes, or what repeats say.

    Args:
        named: the effects and the noise they were found in.
        remainders: per channel.
        rest: (C,) mean square left without the bursts.
    """
    floor2 = np.array(
        [
            max(
                rest[c] - (r.energy if r.p_value < SIGNIFICANT / len(rest) and r.kind != "time wave" else 0.0),
                0.05 * rest[c],
            )
            for c, r in enumerate(remainders)
        ]
    )
    if named.noise.source == "repeats":
        return np.minimum(named.noise.rms**2, np.maximum(rest, 1e-30))
    return floor2


@dataclass(frozen=True, kw_only=True)
class _Missing:
    """What significant remainders say about effects that were not named.

    Attributes:
        remainders: per channel.
        weight: (C,) one over the squared noise floor.
        explained: (C,) mean square the named effects and the bursts explain.
        error2: (C,) mean square that the model leaves although nothing is missing.
    """

    remainders: tuple[Remainder, ...]
    weight: np.ndarray
    explained: np.ndarray
    error2: np.ndarray

    @property
    def energy(self) -> np.ndarray:
        """(C,) mean square that can be predicted, 0 where that may be chance or is small."""
        channels = len(self.remainders)
        return np.array(
            [
                max(r.energy - e2, 0.0)
                if r.p_value < SIGNIFICANT / channels and r.energy > REMAINDER_SIZE * (r.base - r.energy)
                else 0.0
                for r, e2 in zip(self.remainders, self.error2, strict=True)
            ]
        )

    @property
    def share(self) -> float:
        """Part of everything that can be explained."""
        energy = self.energy
        return float(self.weight @ energy / (self.weight @ (energy + self.explained) + 1e-30))

    @property
    def much(self) -> bool:
        """Whether that is much of what can be explained, or some of it and most of what is left of a channel."""
        most = any(e > MOST * r.base for e, r in zip(self.energy, self.remainders, strict=True))
        return self.share > REMAINDER or (most and self.share > SHARE)

    @property
    def _counted(self) -> list[Remainder]:
        return [r for r, e in zip(self.remainders, self.energy, strict=True) if e > 0]

    @property
    def p_value(self) -> float:
        """Of the most significant one, all channels together; 1 where there is none."""
        return float(min([r.p_value * len(self.remainders) for r in self._counted], default=1.0))

    @property
    def worst(self) -> Remainder:
        """The largest against its noise."""
        return max(self._counted, key=lambda r: self.weight[r.channel] * r.energy)


def _strange(named: Named, heldout: list[JointLog], fitted: list[np.ndarray], error2: np.ndarray) -> float:
    """Part of the explainable held-out energy that is left there beyond what the fit left on the worst of its own logs.

    It counts where other numbers for the same effects would remove a good part of it, or where the state, the way or
    the clock foretell it; the rest is a louder log.

    Args:
        named: the effects.
        heldout: logs nothing was fitted to.
        fitted: (T, C) residual left on each log it was fitted to.
        error2: (C,) mean square that the model leaves although nothing is missing.
    """
    blocks = list(named.blocks)
    before = [log.residual[log.inner] for log in heldout]
    after = unexplained(named, heldout)
    given = np.mean(np.concatenate(before) ** 2, axis=0)
    left = np.mean(np.concatenate(after) ** 2, axis=0)
    rest = np.maximum(np.max([np.mean(x**2, axis=0) for x in fitted], axis=0), error2)
    loud = np.flatnonzero(left > TRANSFER * rest)
    if not len(loud):
        return 0.0
    broad = [log.wide() for log in heldout]
    wide = unexplained(named, broad)
    again = np.mean(np.concatenate(_refitted(blocks, heldout, after, rest)) ** 2, axis=0)
    excess = np.zeros(len(rest))
    for c in loud:
        if again[c] < (1.0 - REFIT_GAIN) * left[c]:
            excess[c] = left[c] - rest[c]
            continue
        found = leftover(heldout, after, wide, int(c))
        if found.p_value < SIGNIFICANT / len(rest):
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
        # of one burst nobody knows how much the next would differ
        spread = 1.96 * load.std(ddof=1) / np.sqrt(len(load)) if len(load) > 1 else np.inf
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
                experiment=MET_ONCE,
            )
        )
    return tuple(out)
