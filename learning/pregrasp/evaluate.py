"""Success of a policy in the states of a dataset, beside the oracle's ceiling."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import numpy as np

from ...sim.errors import CaretreeError
from ...sim.pregrasp.action import Action, hand_path
from ...sim.pregrasp.affordance import best_action
from ...sim.pregrasp.numbers import DIRECT
from ...sim.pregrasp.policy import Policy
from ...sim.pregrasp.views import Views
from .bullet_roll_out import bullet_roll_out
from .calibration import calibration_error
from .ceiling import ceiling
from .dataset import Dataset
from .hung_state import HungState, hang
from .oracle import attempt
from .rate import rate_text, signs

ENGINES = ("spring", "bullet")


@dataclass(frozen=True, kw_only=True)
class Tried:
    """What a policy comes to in every state.

    Attributes:
        best: (S,) bool, success of its best action.
        direct: (S,) bool, of its best direct grasp.
        value: (S,) of its best action.
        primitive: (S,) of its best action.
    """

    best: np.ndarray
    direct: np.ndarray
    value: np.ndarray
    primitive: np.ndarray


class Chooser(Protocol):
    """What is needed of a policy."""

    def values(self, views: Views) -> np.ndarray:
        """(6, 3, H, W) value of each action."""
        ...


def try_policy(
    data: Dataset, policy: Chooser, say: Callable[[str], None] = lambda text: None, *, engine: str = "spring"
) -> Tried:
    """Carry out a policy's best action in every state, and its best direct grasp where that is another.

    Args:
        data: the states.
        policy: that chooses.
        say: takes lines of progress.
        engine: of `ENGINES`, in which the actions are carried out.

    Raises:
        CaretreeError: the states are deep grasps, which PyBullet's cloth cannot be in.
    """
    if data.deep and engine == "bullet":
        raise CaretreeError("PyBullet's cloth does not meet itself here: deep grasps are not tried in it")
    rows = []
    for k, seed in enumerate(data.seeds.tolist()):
        state, views = hang(seed, str(data.gowns[k]), data.deep), data.views(k)
        values = policy.values(views)
        best, direct = best_action(values, views), best_action(values, views, grasp_only=True)
        won = _succeeds(state, views, best, engine)
        also = won if direct == best else _succeeds(state, views, direct, engine)
        rows.append((won, also, values[best.view, best.primitive, best.row, best.column], best.primitive))
        if k % 20 == 19:
            say(f"{k + 1} of {len(data.seeds)} states, {sum(row[0] for row in rows)} succeed")
    won, also, value, primitive = (np.array(column) for column in zip(*rows, strict=True))
    return Tried(best=won, direct=also, value=value, primitive=primitive)


def _succeeds(state: HungState, views: Views, action: Action, engine: str) -> bool:
    """Whether an action succeeds; one on no pixel of the gown takes nothing."""
    if engine == "spring":
        return attempt(state, views, action).success
    shows = views.depth[action.view, action.row, action.column] > 0
    return bool(shows and bullet_roll_out(state, hand_path(views, action)).success)


def policy_table(
    data: Dataset,
    path: Path,
    say: Callable[[str], None] = lambda text: None,
    *,
    engine: str = "spring",
    against: Path | None = None,
) -> str:
    """Success as Markdown, each rate with its n and Wilson's 95 % interval.

    Args:
        data: the states.
        path: of the policy.
        say: takes lines of progress.
        engine: of `ENGINES`, in which the actions are carried out.
        against: of another policy, which is tried in the same states.

    Raises:
        CaretreeError: a file holds no policy, or the states cannot be tried.
    """
    policy, everywhere = Policy(path), np.ones(len(data.seeds), bool)
    kinds = {"all states": everywhere}
    if data.tells_ceiling:
        found = ceiling(data)
        kinds |= {"hard states": found.hard, "states that the oracle can win": found.all}
    tried = try_policy(data, policy, say, engine=engine)
    rows = [("best of all maps", tried.best), ("best of the direct maps", tried.direct)]
    if against is not None:
        rows.append((f"against it, {against}", try_policy(data, Policy(against), say, engine=engine).best))
    lines = [f"| {path.name}, {engine} | {' | '.join(kinds)} |", "|---|" + "---|" * len(kinds)]
    for name, won in rows:
        lines.append(f"| {name} | {' | '.join(rate_text(won[kind]) for kind in kinds.values())} |")
    told = np.array([policy.confidence(value) for value in tried.value])
    mine, theirs, p = signs(tried.best, tried.direct)
    lines += [
        "",
        f"All maps win {mine} states that direct maps lose, and lose {theirs} (sign test p = {p:.2g}).",
        f"A sweep is chosen in {rate_text(tried.primitive != DIRECT)}.  Calibration error of the confidence "
        f"{calibration_error(told, tried.best):.3f}, which is {told.mean():.2f} in the mean.",
    ]
    for kind, chosen in kinds.items() if against is not None else ():
        mine, theirs, p = signs(tried.best[chosen], rows[-1][1][chosen])
        lines.append(f"Of {kind} it wins {mine} that {against} loses, and loses {theirs} (sign test p = {p:.2g}).")
    return "\n".join(lines)
