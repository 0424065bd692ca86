"""What the four steps say, as frozen values that become verdict.json."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

VISIBLE = 0.5  # of the noise floor; an experiment that parts two explanations by less is none

VerdictName = Literal["adequate", "recalibration", "effects", "unknown"]


@dataclass(frozen=True, kw_only=True)
class Where:
    """A place where model and measurement disagree beyond noise.

    Attributes:
        channel: column of the measurement (joint load, height, marker).
        target: joint or region it belongs to.
        episode: name of the episode.
        t0, t1: interval [s].
        state_region: what the system was doing.
        phase: named phase that covers most of it, or "".
        p_value: after correction for everything tried.
        size: root mean square disagreement there over the noise floor.
        effect: effect that explains it, or "".
    """

    channel: str
    target: str
    episode: str
    t0: float
    t1: float
    state_region: str
    phase: str
    p_value: float
    size: float
    effect: str = ""


@dataclass(frozen=True, kw_only=True)
class Change:
    """A payload that is another one from some instant of a recording on.

    Attributes:
        episode: name of the recording.
        t: when [s].
        before, after: mass, beyond what the model carries [kg].
    """

    episode: str
    t: float
    before: float
    after: float


@dataclass(frozen=True, kw_only=True)
class Value:
    """A fitted number with its 95 % interval.

    Attributes:
        doubt: why the interval is not to be trusted, or "".
    """

    name: str
    unit: str
    value: float
    low: float
    high: float
    doubt: str = ""


@dataclass(frozen=True, kw_only=True)
class EffectFinding:
    """One effect, named.

    Attributes:
        name: from the registry, or `mass` and the like under recalibration.
        target: joint, body, region.
        parameters: values with units and intervals.
        equivalent: other names this data cannot tell from it.
        experiment: what would tell them apart, computed.
        size: root mean square of its load over the floor, in the channel it changes most.
        smallest: smallest size of this effect this data could have shown, as a factor of the size found.
        confidence: part of the bootstrap resamples in which it keeps paying its price; NaN where none were drawn.
        when: recording, from and to [s], of every stretch in which it acts; empty where that is all the time.
    """

    name: str
    target: str
    parameters: tuple[Value, ...]
    equivalent: tuple[str, ...] = ()
    experiment: str = ""
    size: float = 0.0
    smallest: float = float("nan")
    confidence: float = float("nan")
    when: tuple[tuple[str, float, float], ...] = ()


def doubted(finding: EffectFinding, why: str) -> EffectFinding:
    """The same finding, none of whose intervals is to be trusted; a doubt of a number's own is kept."""
    values = (v if v.doubt else dataclasses.replace(v, doubt=why) for v in finding.parameters)
    return dataclasses.replace(finding, parameters=tuple(values))


@dataclass(frozen=True, kw_only=True)
class Rival:
    """Another set of effects that explains the data as well as the named one.

    Attributes:
        effects: name and target of each.
        experiment: what would tell it from the named set, computed.
    """

    effects: tuple[tuple[str, str], ...]
    experiment: str


@dataclass(frozen=True, kw_only=True)
class FollowUp:
    """Recordings to make next, for this workflow to be run on again.

    Attributes:
        kind: `drop`.
        height_m: to release from [m].
        mass_factor: mass over that of the body as it is.
        drops: how many; the last is held out.
        apart: how far the named set and the nearest of its rivals would then be apart, all recordings asked for
            together [standard deviations]; None where it has no rival.
    """

    kind: str
    height_m: float
    mass_factor: float
    drops: int
    apart: float | None = None

    @property
    def sentence(self) -> str:
        """For a reader."""
        return f"{released(self.height_m, self.mass_factor)}, {self.drops} times"


def released(height: float, mass_factor: float) -> str:
    """What to do with a body: let it go at a height [m], with its mass changed."""
    heavy = "" if mass_factor == 1.0 else f", {mass_factor:g} times as heavy in the same shape"
    return f"drop from {height:.3g} m{heavy}"


def told_apart(experiment: str, name: str, other: str, apart: float) -> str:
    """Sentence on the experiment in which two explanations part most.

    Args:
        experiment: what to do, or "" where none parts them at all.
        name: of the one explanation.
        other: of the other.
        apart: by how much they would differ, over the noise floor.
    """
    if not experiment or apart < VISIBLE:
        return f"no experiment tried tells {name} from {other}: they would differ by less than {VISIBLE:g} noise floors"
    return f"{experiment}: {name} and {other} would then differ by {apart:.2g} times the noise floor"


@dataclass(frozen=True, kw_only=True)
class Gap:
    """Root mean square disagreement on held-out episodes.

    Attributes:
        unit: of every number.
        floor, before, after: over all channels.
        low, high: 95 % interval of `after / before`.
        channels: channel -> the same three.
    """

    unit: str
    floor: float
    before: float
    after: float
    low: float
    high: float
    channels: dict[str, dict[str, float]] = field(default_factory=dict)

    @property
    def closed(self) -> float:
        """Part of the gap above the floor that is gone, by root mean square; NaN where there was none."""
        above = self.before - self.floor
        return (
            float(np.clip((self.before - self.after) / above, -9.0, 1.0))
            if above > 1e-3 * self.before
            else float("nan")
        )


@dataclass(frozen=True, kw_only=True)
class Placebo:
    """A control that must not help: what was put in, and how the held-out gap changed (after / before)."""

    what: str
    ratio: float


@dataclass(frozen=True, kw_only=True)
class Verdict:
    """Everything the workflow says about one measurement set."""

    set: str
    system: str
    verdict: VerdictName
    where: tuple[Where, ...]
    effects: tuple[EffectFinding, ...]
    recalibration: tuple[EffectFinding, ...]
    gap: Gap
    alpha: float
    p_value: float
    floor_source: str
    guess: str = ""
    placebos: tuple[Placebo, ...] = ()
    rivals: tuple[Rival, ...] = ()
    follow_up: tuple[FollowUp, ...] = ()
    forward: Gap | None = None
    changes: tuple[Change, ...] = ()
    detectable: dict[str, str] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    seconds: float = 0.0

    def as_dict(self) -> dict[str, Any]:
        """Plain values for JSON; numbers that are not finite become null."""
        return plain({**dataclasses.asdict(self), "gap": {**dataclasses.asdict(self.gap), "closed": self.gap.closed}})


def plain(x: Any) -> Any:
    """`x` as plain values for JSON or YAML; numbers that are not finite become None."""
    if isinstance(x, dict):
        return {str(k): plain(v) for k, v in x.items()}
    if isinstance(x, list | tuple):
        return [plain(v) for v in x]
    if isinstance(x, bool | np.bool_):
        return bool(x)
    if isinstance(x, int | np.integer):
        return int(x)
    if isinstance(x, float | np.floating):
        return float(x) if np.isfinite(x) else None
    return x
