"""Effects this data cannot tell apart, and the experiment that would."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from .block import AXIS_IS_MASS, Block
from .log import JointLog
from .rigid import RigidModel
from .search import Search

SAME = 9.0  # drop of the Wald statistic below which two explanations count as equal


@dataclass(frozen=True, kw_only=True)
class Alternative:
    """Another explanation that fits as well.

    Attributes:
        names: effects of the other explanation.
        blocks: their blocks.
        replaces: index of the chosen block it stands for.
    """

    names: tuple[str, ...]
    blocks: tuple[Block, ...]
    replaces: int


def alternatives(search: Search, chosen: tuple[int, ...], index: int, slack: float = SAME) -> list[Alternative]:
    """Explanations that could stand in for one chosen block without a noticeably worse fit.

    Args:
        search: knows all blocks and how well any set of them fits.
        chosen: blocks of the explanation.
        index: the one to be replaced, among `chosen`.
        slack: drop of the Wald statistic that still counts as fitting as well.
    """
    stand_ins = _StandIns(search, chosen, index, slack)
    for i in _other_effects(search, chosen, index):
        stand_ins.consider((i,))
    parts = _friction_parts(search, chosen, index)
    if parts:
        stand_ins.consider(parts)
    stand_ins.consider_asymmetric_friction()
    return stand_ins.best(4)


FRICTION_PARTS = frozenset({"coulomb_friction", "offset"})  # together they are asymmetric friction


def _other_effects(search: Search, chosen: tuple[int, ...], index: int) -> list[int]:
    """Blocks that act where the block does, and neither replace nor extend what is chosen."""
    block, rest = search.blocks[index], tuple(i for i in chosen if i != index)
    out = []
    for i, other in enumerate(search.blocks):
        if i in chosen or other.key == block.key or not set(other.channels) & set(block.channels):
            continue
        if block.name in other.contains and other.target == block.target:
            continue  # a richer form of the same effect always fits as well; that says nothing
        if not search.clash(i, rest):
            out.append(i)
    return out


def _friction_parts(search: Search, chosen: tuple[int, ...], index: int) -> tuple[int, ...]:
    """The level and the offset that an asymmetric friction on the same joint consists of; () for any other block."""
    block = search.blocks[index]
    if block.name != "asymmetric_friction":
        return ()
    parts = tuple(
        i
        for i, b in enumerate(search.blocks)
        if b.target == block.target and b.name in FRICTION_PARTS and i not in chosen
    )
    return parts if len(parts) == 2 else ()


class _StandIns:
    """Explanations that could stand in for one chosen block, each with how much worse it fits."""

    def __init__(self, search: Search, chosen: tuple[int, ...], index: int, slack: float) -> None:
        self._search, self._index = search, index
        self._base = float(search.rows @ np.log(search.rss(chosen)))
        self._rest = tuple(i for i in chosen if i != index)
        self._slack = slack * max(search.widening[index], 1.0)
        self._found: dict[tuple[str, ...], tuple[float, Alternative]] = {}

    def best(self, count: int) -> list[Alternative]:
        """The first few of those that fit as well, best first."""
        return [a for _, a in sorted(self._found.values(), key=lambda pair: pair[0])][:count]

    def consider(self, new: tuple[int, ...]) -> None:
        """Keep some blocks as an explanation if they do something and fit as well."""
        search, rest = self._search, self._rest
        theta = search.fit((*rest, *new))
        mine = theta[len(search.columns(rest)) :]
        if not np.any(np.abs(mine) > 1e-9):
            return
        worse = float(search.rows @ np.log(search.rss((*rest, *new), theta))) - self._base
        target = search.blocks[self._index].target
        names = tuple(
            b.name if b.target == target else f"{b.name} of {b.target}" for b in (search.blocks[i] for i in new)
        )
        if names not in self._found or worse < self._found[names][0]:
            self._keep(names, worse, new)

    def consider_asymmetric_friction(self) -> None:
        """A level and an offset on one joint, both chosen, may be one friction that differs with the direction."""
        search, block = self._search, self._search.blocks[self._index]
        if block.name not in FRICTION_PARTS:
            return
        partner = [
            i
            for i in self._rest
            if search.blocks[i].target == block.target and {block.name, search.blocks[i].name} == FRICTION_PARTS
        ]
        unequal = [i for i, b in enumerate(search.blocks) if b.key == ("asymmetric_friction", block.target)]
        if partner and unequal:
            others = tuple(i for i in self._rest if i != partner[0])
            worse = float(search.rows @ np.log(search.rss((*others, unequal[0])))) - self._base
            self._keep(("asymmetric_friction",), worse, unequal[:1])

    def _keep(self, names: tuple[str, ...], worse: float, new: Sequence[int]) -> None:
        if worse < self._slack:
            blocks = tuple(self._search.blocks[i] for i in new)
            self._found[names] = (worse, Alternative(names=names, replaces=self._index, blocks=blocks))


def mass_twins(block: Block) -> tuple[str, ...]:
    """Effects with exactly the columns of an axis's recalibrated mass, or of what it takes up."""
    if block.body != "axis" or block.name not in ("mass", "payload"):
        return ()
    return tuple(sorted({*AXIS_IS_MASS, "payload"} - {block.name}))


def experiments(model: RigidModel, log: JointLog) -> dict[str, JointLog]:
    """Motions that could be run next, made from a log: the sentence for the reader and the log it would give."""
    out = {}
    for text, factor in (
        ("repeat the same path at half the speed", 0.5),
        ("repeat the same path at a fifth of the speed", 0.2),
        ("repeat the same path at twice the speed", 2.0),
    ):
        out[text] = _again(model, log, log.q, log.dq * factor, log.ddq * factor**2, 1.0 / factor)
    steps = _staircase(log)
    out["hold still at eight positions across the range"] = _again(model, log, steps, 0 * steps, 0 * steps, 1.0)
    middle = log.q.mean(axis=0)
    out["repeat the same path with half the range"] = _again(
        model, log, middle + 0.5 * (log.q - middle), 0.5 * log.dq, 0.5 * log.ddq, 1.0
    )
    terms = [t for t in model.body_terms() if t.name in ("payload", "mass")]
    term = next((t for t in terms if t.name == "payload"), terms[0] if terms else None)
    if term is not None:
        typical = float(np.abs(log.rigid).max()) * 0.05 + 0.5
        values = {p.name: (typical if p.name == "mass" else 0.0) for p in term.parameters}
        heavier = model.patched(term, values)
        out[f"repeat the same path with {typical:.1f} kg added at the end"] = _again(
            heavier, log, log.q, log.dq, log.ddq, 1.0
        )
    return out


def _staircase(log: JointLog) -> np.ndarray:
    low, high = log.q.min(axis=0), log.q.max(axis=0)
    return low + (high - low) * (np.floor(np.linspace(0, 7.999, len(log.t)))[:, None] / 7.0)


def _again(model: RigidModel, log: JointLog, q, dq, ddq, stretch: float) -> JointLog:
    rigid = model.load(q, dq, ddq)
    return replace(
        log,
        name=f"{log.name}*",
        t=log.t[0] + (log.t - log.t[0]) * stretch,
        dt=log.dt * stretch,
        cutoff=log.cutoff / stretch,
        q=q,
        dq=dq,
        ddq=ddq,
        rigid=rigid,
        measured=rigid,
        residual=0.0 * rigid,
    )


def best_experiment(
    block: Block,
    theta: np.ndarray,
    other: Alternative,
    motions: dict[str, JointLog],
    logs: list[JointLog],
    floor: np.ndarray,
) -> tuple[str, float]:
    """The motion in which two explanations differ most, both having to explain the old data too.

    Returns:
        (sentence, predicted difference in units of the noise floor).
    """
    shared = [c for c in block.channels if all(c in b.channels for b in other.blocks)] or list(block.channels)
    first = block.build(logs[0])
    c = max(shared, key=lambda j: float(np.abs(first[:, block.channels.index(j)] @ theta).max() / floor[j]))

    def columns(blocks: tuple[Block, ...], log: JointLog) -> np.ndarray:
        parts = [b.build(log)[:, b.channels.index(c), :] for b in blocks if c in b.channels]
        return np.concatenate(parts, axis=1) / floor[c] if parts else np.zeros((len(log.t[log.inner]), 1))

    old = np.concatenate([columns(other.blocks, log) for log in logs])
    target = np.concatenate([columns((block,), log) @ theta for log in logs])
    best = ("", 0.0)
    for text, log in motions.items():
        X, y = columns(other.blocks, log), columns((block,), log) @ theta
        fit = np.linalg.lstsq(np.concatenate([old, X]), np.concatenate([target, y]), rcond=None)[0]
        apart = float(np.sqrt(np.mean((y - X @ fit) ** 2)))
        for b in (block, *other.blocks):  # synthetic logs are not kept
            forget(b, log.name)
        if apart > best[1]:
            best = (text, apart)
    return best


def forget(block: Block, name: str) -> None:
    """Drop what a block keeps of one log: logs of motions that were never run are not asked for again."""
    for cell in block.build.__closure__ or ():
        if isinstance(cell.cell_contents, dict):
            cell.cell_contents.pop(name, None)
