"""Whether fingers hold what they were to take, by the pictures after the action; run by OpenCV alone.

The paper's participants gave the reward of a trial; this network looks at what lies around the hand, as six pictures
show it with the fingers in them.  A grasp and its mirror image come to the same, so it is asked of both.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ..errors import CaretreeError
from .policy import read_network
from .surroundings import cells_around
from .views import Views


class RewardClassifier:
    """The chance that a grasp has a single layer at the wanted corner.

    Args:
        path: of an ONNX file that `caretree learn pregrasp reward` wrote.

    Attributes:
        record: how it was trained: data, seed, area under its curve, machine.

    Raises:
        CaretreeError: the file is missing, or holds no such network.
    """

    def __init__(self, path: str | Path) -> None:
        try:
            about, self._network = read_network(Path(path))
            about["reward"]  # no policy has it
        except (CaretreeError, KeyError) as error:
            raise CaretreeError(
                f"{path}: this is no network of rewards; `caretree learn pregrasp reward` writes one"
            ) from error
        self.record = about["record"]

    def chance(self, views: Views, hand: np.ndarray) -> float:
        """Chance of success, 0 to 1, of a hand (4, 4) that has closed; the pictures are taken then, with it in them."""
        cells = cells_around(views.places()[0], hand[:3, :3], hand[:3, 3])
        logit = (self._told(cells) + self._told(cells[..., ::-1])) / 2
        return float(1.0 / (1.0 + np.exp(-np.clip(logit, -50.0, 50.0))))

    def _told(self, cells: np.ndarray) -> float:
        self._network.setInput(np.ascontiguousarray(cells)[None])
        return float(np.ravel(self._network.forward())[0])
