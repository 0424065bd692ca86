"""From logs to the set of effects: floor, whitening, search, refinement of shapes, search again."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ....sim.effects.joint.arm_geometry import GEOMETRY
from .block import Block, body_block, effect_blocks
from .gram import Gram, assemble, exchange
from .lag import lagged
from .log import JointLog
from .noise import NoiseModel, estimate_noise, repeat_difference
from .payloads.carried import MASS, Carried, Fit, alike, asked_again, with_payloads
from .payloads.cells import carried
from .refine import refined
from .remains.generic import generic_columns, scales
from .rigid import RigidModel
from .search import Search
from .widen import widened


@dataclass(frozen=True, kw_only=True)
class Named:
    """What the search found.

    Attributes:
        blocks: chosen blocks, shapes refined.
        theta: their parameters, concatenated.
        noise: the floor and its colour.
        search: the last search, for questions about alternatives.
        chosen: indices of `blocks` in it.
        carried: the payloads, where they change.
        constant: what was found without a change, where there is one.
    """

    blocks: tuple[Block, ...]
    theta: np.ndarray
    noise: NoiseModel
    search: Search
    chosen: tuple[int, ...]
    carried: Carried | None = None
    constant: Named | None = None

    @property
    def score(self) -> float:
        """The search's criterion, the places of the changes paid for; smaller is better."""
        return self.search.score(self.chosen) + (self.carried.cost if self.carried else 0.0)

    @property
    def gram(self) -> Gram:
        """Normal equations of the last search."""
        return self.search.gram


def one_shape_each(blocks: list[Block]) -> list[Block]:
    """One representative shape per effect and target, the middle one."""
    groups: dict[tuple[str, str], list[Block]] = {}
    for block in blocks:
        groups.setdefault(block.key, []).append(block)
    return [g[len(g) // 2] for g in groups.values()]


FOLDS = 6
ROUNDS = 5


def first_noise(blocks: list[Block], logs: list[JointLog]) -> NoiseModel:
    """A first picture of the noise: repeats, else what a fit of everything at once leaves.

    The latter is too small (a hundred functions of a slow motion also explain slow noise), so the first search may
    take too much; the rounds that follow see the honest residual and take it back.
    """
    repeats = repeat_difference([log.residual[log.inner] for log in logs], [log.q[log.inner] for log in logs])
    if repeats:
        return estimate_noise(repeats, "repeats")
    scale = scales(logs)
    out = [np.zeros_like(log.residual[log.inner]) for log in logs]
    for c in range(logs[0].q.shape[1]):
        mine = [b for b in one_shape_each(blocks) if c in b.channels]
        X = np.concatenate(
            [
                np.column_stack(
                    [*(b.build(log)[:, b.channels.index(c), :] for b in mine), generic_columns(log, c, scale)]
                )
                for log in logs
            ]
        )
        X = X / (np.sqrt(np.mean(X**2, axis=0)) + 1e-12)
        y = np.concatenate([log.residual[log.inner, c] for log in logs])
        left = y - X @ np.linalg.solve(X.T @ X + 1e-4 * len(y) * np.eye(X.shape[1]), X.T @ y)
        at = 0
        for series in out:
            series[:, c] = left[at : at + len(series)]
            at += len(series)
    return estimate_noise(out, "residual")


def explained(blocks: list[Block], theta: np.ndarray, log: JointLog) -> np.ndarray:
    """What the blocks add to the model in one log, after the shared filter, (T_inner, C)."""
    out = np.zeros_like(log.residual[log.inner])
    at = 0
    for block in blocks:
        k = len(block.parameters)
        out[:, list(block.channels)] += block.build(log) @ theta[at : at + k]
        at += k
    return out


def name_effects(model: RigidModel, logs: list[JointLog], system: str, strict: float = 1.0) -> Named:
    """Search as if the arm stood and read as its model has it; all anew, where the search goes on once it may not.

    Where it stands is asked last, as it can follow a little of anything: with it in the first search, the tool of a
    real arm came out 60 g lighter, whose base was found level.
    """
    blocks = effect_blocks(model, logs, system)
    named = _named(blocks, model, logs, strict)
    placed = [body_block(term, model) for term in model.geometry_terms()]
    if not placed:
        return named
    gram = assemble([*named.search.blocks, *placed], logs)
    search = Search(gram=gram, noise=named.noise, strict=strict)
    if any(gram.blocks[i].name in GEOMETRY for i in search.run(named.chosen)):
        again = _named([*blocks, *placed], model, logs, strict)
        if again.score < named.score and any(b.name in GEOMETRY for b in again.blocks):
            return again
    return replace(named, search=search)  # which knows what could stand in for what was named


def _named(blocks: list[Block], model: RigidModel, logs: list[JointLog], strict: float) -> Named:
    """Floor, search, refine, search again until the set stands still; once more where a payload changes."""
    noise = first_noise(blocks, logs)
    gram = assemble(blocks, logs)
    found = _payloads(gram, noise, model, logs)
    named = _settled(gram, noise, model, logs, strict)
    if found is None:
        return named
    while len(found.during) > 1:
        parted = with_payloads(blocks, found, model)
        noise = first_noise(parted, logs)
        again = _settled(assemble(parted, logs), noise, model, logs, strict, rounds=1)
        fit = Fit(blocks=again.blocks, theta=again.theta, weight=again.search.weight, model=model)
        known = asked_again(found, fit, logs)
        fewer = len(known.during) < len(found.during)
        found = known
        if fewer:
            continue
        again = _settled(assemble(with_payloads(blocks, found, model), logs), noise, model, logs, strict)
        one = alike(found, again.search, again.chosen)
        if one is None:
            again = replace(again, carried=found, constant=named)
            return again if again.score < named.score else named
        found = found.joined(*one)
    return named


def _payloads(gram: Gram, noise: NoiseModel, model: RigidModel, logs: list[JointLog]) -> Carried | None:
    """The payloads, where they change; an axis has a mass alone, with which a payload that does not change is one."""
    at = {id(b): i for i, b in enumerate(gram.blocks)}
    base = sorted(at[id(b)] for b in one_shape_each(gram.blocks))
    alike = {(model.payload.target, name) for name in (model.payload.name, MASS)}
    payload = next((i for i in base if (gram.blocks[i].body, gram.blocks[i].name) in alike), None)
    return None if payload is None else carried(Search(gram=gram, noise=noise), base, payload, logs)


def _settled(
    gram: Gram, noise: NoiseModel, model: RigidModel, logs: list[JointLog], strict: float, rounds: int = ROUNDS
) -> Named:
    """Search, refine the shapes and take the noise anew until the set stands still."""
    chosen: tuple[int, ...] = ()
    seen: list[set] = []
    for _ in range(rounds):
        chosen, gram = _settle(gram, model, logs, noise, strict, chosen)
        blocks = gram.blocks
        found = {(*blocks[i].key, tuple(blocks[i].shape.items())) for i in chosen}
        if found in seen:
            break
        seen.append(found)
        if noise.source == "residual":
            theta = Search(gram=gram, noise=noise).fit(chosen)
            noise = estimate_noise(
                [log.residual[log.inner] - explained([blocks[i] for i in chosen], theta, log) for log in logs],
                "residual",
            )
    search = Search(gram=gram, noise=noise, strict=strict)
    chosen = unequal_levels(search, chosen)
    search = lagged(widened(search, chosen, model, logs), chosen, logs)
    return Named(
        blocks=tuple(search.blocks[i] for i in chosen),
        noise=noise,
        search=search,
        chosen=chosen,
        theta=search.fit(chosen),
    )


UNEQUAL = 0.2  # (forward - backward) / (forward + backward) from which unequal friction is likelier than an offset
TIE = 9.0  # Wald statistic below which the two fit alike


def unequal_levels(search: Search, chosen: tuple[int, ...]) -> tuple[int, ...]:
    """Settle ties between unequal dry friction and equal friction with an offset.

    While a joint moves the two are the same load.  Where the log cannot tell, a large difference between the
    directions is taken for friction, a small one for a zero that is a little off; the other is reported as equivalent.
    """
    at = {(b.name, b.target): i for i, b in enumerate(search.blocks) if not b.shape}
    for target in {b.target for b in search.blocks}:
        level, zero, both = (at.get((n, target)) for n in ("coulomb_friction", "offset", "asymmetric_friction"))
        if level is None or zero is None or both is None:
            continue
        split = tuple(i for i in chosen if i not in (level, zero, both))
        apart, joined = (*split, level, zero), (*split, both)
        if not ({level, zero} <= set(chosen) or both in chosen):
            continue
        parts = search.rows @ (np.log(search.rss(joined)) - np.log(search.rss(apart)))
        if abs(parts) > TIE * search.widening[level]:
            continue
        forward, backward = search.fit(joined)[-2:]
        ratio = abs(forward - backward) / max(forward + backward, 1e-12)
        chosen = joined if ratio > UNEQUAL else apart
    return chosen


def _settle(
    gram: Gram, model: RigidModel, logs: list[JointLog], noise: NoiseModel, strict: float, chosen: tuple[int, ...]
) -> tuple[tuple[int, ...], Gram]:
    """Search, fit the shapes of what was found, and search again with them."""
    for _ in range(2):
        search = Search(gram=gram, noise=noise, strict=strict)
        chosen = search.run(chosen)
        old = [gram.blocks[i] for i in chosen]
        better = refined(old, search.fit(chosen), model, logs)
        changed = {i: new for i, new, was in zip(chosen, better, old, strict=True) if new is not was}
        if not changed:
            break
        gram = exchange(gram, changed, logs)
    return chosen, gram
