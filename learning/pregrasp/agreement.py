"""How often the spring engine and PyBullet agree on what an action comes to."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...sim.errors import CaretreeError
from ...sim.pregrasp.action import Action, hand_path
from .bullet_roll_out import bullet_roll_out
from .dataset import Dataset
from .hung_state import hang
from .rate import rate_text


def paired(data: Dataset, count: int, seed: int, say: Callable[[str], None] = lambda text: None) -> np.ndarray:
    """(count, 3) int: index of the attempt, success in the spring engine, success in PyBullet.

    Args:
        data: attempts that the spring engine has carried out.
        count: how many are repeated; half of them successes, as far as there are enough.
        seed: of which ones.
        say: takes lines of progress.

    Raises:
        CaretreeError: the states are deep grasps.
    """
    if data.deep:
        raise CaretreeError("PyBullet's cloth does not meet itself here: deep grasps are not repeated in it")
    rng = np.random.default_rng([seed, 17])
    won, lost = np.flatnonzero(data.success), np.flatnonzero(~data.success)
    half = min(count // 2, len(won))
    chosen = np.concatenate([rng.permutation(won)[:half], rng.permutation(lost)[: count - half]])
    rows = []
    for k, index in enumerate(np.sort(chosen)):
        state_of, _, primitive, view, row, column = data.attempts[index, :6].tolist()
        state = hang(int(data.seeds[state_of]), str(data.gowns[state_of]))
        path = hand_path(data.views(state_of), Action(primitive=primitive, view=view, row=row, column=column))
        rows.append((int(index), int(data.success[index]), int(bullet_roll_out(state, path).success)))
        if k % 20 == 19:
            say(f"{k + 1} of {len(chosen)} attempts in PyBullet")
    return np.array(rows).reshape(-1, 3)


def agreement_table(data: Dataset, count: int, seed: int, say: Callable[[str], None] = lambda text: None) -> str:
    """Agreement on success as Markdown."""
    rows = paired(data, count, seed, say)
    spring, bullet = rows[:, 1] == 1, rows[:, 2] == 1
    return "\n".join(
        (
            "| spring engine and PyBullet on the same attempts | |",
            "|---|---|",
            f"| agree on success | {rate_text(spring == bullet)} |",
            f"| succeed in PyBullet, of those that succeed in the spring engine | {rate_text(bullet[spring])} |",
            f"| succeed in PyBullet, of those that fail in the spring engine | {rate_text(bullet[~spring])} |",
        )
    )
