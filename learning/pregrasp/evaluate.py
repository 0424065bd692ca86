"""Success of a policy in the states of a dataset, beside the oracle's ceiling."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from ...sim.errors import CaretreeError
from .action import Action, hand_path
from .affordance import best_action, seen
from .bullet_roll_out import bullet_roll_out
from .ceiling import ceiling
from .dataset import Dataset
from .hung_state import HungState, hang
from .oracle import attempt
from .rate import rate_text, signs
from .views import Views

ENGINES = ("spring", "bullet")


class Policy:
    """A policy in an ONNX file, run by OpenCV alone.

    Args:
        path: of `pregrasp.onnx`.

    Raises:
        CaretreeError: it cannot be read.
    """

    def __init__(self, path: Path) -> None:
        import cv2

        try:
            self._network: Any = cv2.dnn.readNetFromONNX(str(path))
        except cv2.error as error:
            raise CaretreeError(f"{path}: this is no policy in an ONNX file") from error

    def values(self, image: np.ndarray) -> np.ndarray:
        """(6, 3, H, W) expected rewards of what `seen` gives (6, 5, H, W)."""
        self._network.setInput(np.ascontiguousarray(image))
        return np.asarray(self._network.forward())


def policy_wins(
    data: Dataset, policy: Policy, say: Callable[[str], None] = lambda text: None, *, engine: str = "spring"
) -> np.ndarray:
    """(2, S) bool: success of the policy's best action, and of its best direct grasp, in every state.

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
    wins = np.zeros((2, len(data.seeds)), bool)
    for k, seed in enumerate(data.seeds.tolist()):
        state, views = hang(seed, str(data.gowns[k]), data.deep), data.views(k)
        values = policy.values(seen(views))
        for n in range(2):
            wins[n, k] = _succeeds(state, views, best_action(values, views, grasp_only=n == 1), engine)
        if k % 20 == 19:
            say(f"{k + 1} of {len(data.seeds)} states")
    return wins


def _succeeds(state: HungState, views: Views, action: Action, engine: str) -> bool:
    """Whether an action succeeds; one on no pixel of the gown takes nothing."""
    if engine == "spring":
        return attempt(state, views, action).success
    shows = views.depth[action.view, action.row, action.column] > 0
    return bool(shows and bullet_roll_out(state, hand_path(views, action)).success)


def policy_table(
    data: Dataset, path: Path, say: Callable[[str], None] = lambda text: None, *, engine: str = "spring"
) -> str:
    """Success as Markdown, each rate with its n and Wilson's 95 % interval; arguments as of `policy_wins`."""
    found = ceiling(data)
    wins = policy_wins(data, Policy(path), say, engine=engine)
    lines = [
        f"| {path.name}, {engine} | all states | hard states | states that the oracle can win |",
        "|---|---|---|---|",
    ]
    for name, won in zip(("best of all maps", "best of the direct maps"), wins, strict=True):
        lines.append(f"| {name} | {rate_text(won)} | {rate_text(won[found.hard])} | {rate_text(won[found.all])} |")
    mine, theirs, p = signs(wins[0], wins[1])
    lines += ["", f"All maps win {mine} states that direct maps lose, and lose {theirs} (sign test p = {p:.2g})."]
    return "\n".join(lines)
