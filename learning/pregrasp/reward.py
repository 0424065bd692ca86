"""Train a network that tells by the pictures after an action whether it succeeded; see `sim/pregrasp/reward.py`.

The attempts of a dataset are carried out once more, and the gown is photographed with the fingers in it.
"""

from __future__ import annotations

import platform
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import torch  # pyright: ignore[reportMissingImports] - in the extra `learn`
from torch import nn  # pyright: ignore[reportMissingImports] - in the extra `learn`
from torch.nn import functional  # pyright: ignore[reportMissingImports] - in the extra `learn`

from ...sim.errors import CaretreeError
from ...sim.pregrasp.action import Action, hand_path
from ...sim.pregrasp.reward import RewardClassifier
from ...sim.pregrasp.surroundings import CELLS, cells_around
from .dataset import Dataset, load_dataset
from .export import export_reward
from .hung_state import HungState, hang
from .photograph import photograph
from .rate import area_under_curve
from .roll_out import Grasp, roll_out

CHANNELS, HIDDEN, DROPPED = 32, 64, 0.3
RATE, DECAY, BATCH = 1e-3, 1e-2, 128
LOST = 0.2  # share of the cells that are emptied while it is trained


@dataclass(frozen=True, kw_only=True)
class Outcomes:
    """What was seen after attempts.

    Attributes:
        cells: (n, up, along, across) float32 around the hand that has closed.
        won: (n,) bool, a single layer at the wanted corner.
    """

    cells: np.ndarray
    won: np.ndarray


class RewardNetwork(nn.Module):
    """Cells (n, up, along, across) to logits of success, (n, 1)."""

    def __init__(self) -> None:
        super().__init__()
        self.first = nn.Conv2d(CELLS.up, CHANNELS, 3, 1, 1)
        self.second = nn.Conv2d(CHANNELS, CHANNELS, 3, 2, 1)
        self.third = nn.Linear(CHANNELS * (CELLS.along // 2) * (CELLS.across // 2), HIDDEN)
        self.fourth, self.head = nn.Linear(HIDDEN, HIDDEN), nn.Linear(HIDDEN, 1)
        self.dropped = nn.Dropout(DROPPED)

    def forward(self, cells: torch.Tensor) -> torch.Tensor:
        """Logits (n, 1)."""
        flat = functional.relu(self.second(functional.relu(self.first(cells)))).flatten(1)
        flat = self.dropped(functional.relu(self.third(flat)))
        return self.head(self.dropped(functional.relu(self.fourth(flat))))


def seen_afterwards(state: HungState, grasp: Grasp) -> np.ndarray:
    """(up, along, across) cells around the hand, of pictures taken when it has closed."""
    views = photograph(replace(state, vertices=grasp.vertices), hand=grasp.hand)
    return cells_around(views.places()[0], grasp.hand[:3, :3], grasp.hand[:3, 3])


def outcomes_of(data: Dataset, say: Callable[[str], None] = lambda text: None) -> Outcomes:
    """What is seen after each attempt of a dataset, each carried out again in the spring engine.

    Raises:
        CaretreeError: nothing was tried in it.
    """
    if not len(data.attempts):
        raise CaretreeError("nothing was tried in these states; make them with --oracle drawn")
    cells, won = [], []
    for k, seed in enumerate(data.seeds.tolist()):
        state, views = hang(seed, str(data.gowns[k]), data.deep), data.views(k)
        for primitive, view, row, column in data.attempts[data.attempts[:, 0] == k, 2:6].tolist():
            action = Action(primitive=primitive, view=view, row=row, column=column)
            grasp = roll_out(state, hand_path(views, action))
            cells.append(seen_afterwards(state, grasp))
            won.append(grasp.success)
        if k % 20 == 19:
            say(f"{k + 1} of {len(data.seeds)} states seen after {len(won)} attempts")
    return Outcomes(cells=np.stack(cells), won=np.array(won))


def train_reward(seen: Outcomes, steps: int, seed: int) -> RewardNetwork:
    """A network trained on outcomes.

    Args:
        seen: all of them.
        steps: of the optimiser.
        seed: of weights and choices.
    """
    torch.manual_seed(seed)
    rng = np.random.default_rng([seed, 24])
    network = RewardNetwork()
    optimiser = torch.optim.AdamW(network.parameters(), RATE, weight_decay=DECAY)
    for step in range(steps):
        for group in optimiser.param_groups:
            group["lr"] = RATE * (1.01 - step / steps)
        chosen = rng.integers(len(seen.won), size=BATCH)
        cells = seen.cells[chosen] * (rng.random((BATCH, *seen.cells.shape[1:])) > LOST)
        mirrored = rng.random(BATCH) < 0.5
        cells[mirrored] = cells[mirrored][..., ::-1]
        logits = network(torch.from_numpy(cells.astype(np.float32)))[:, 0]
        loss = functional.binary_cross_entropy_with_logits(logits, torch.from_numpy(seen.won[chosen]).float())
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
    return network.eval()


def make_reward(
    folder: Path, test: Path, out: Path, *, steps: int, seed: int, say: Callable[[str], None] = lambda text: None
) -> str:
    """Train on one folder of `data`, test on another, write ONNX; returns what the test says.

    Args:
        folder: whose attempts it is trained on.
        test: whose attempts it has not seen.
        out: the ONNX file.
        steps: of the optimiser.
        seed: of weights and choices.
        say: takes lines of progress.

    Raises:
        CaretreeError: a folder cannot be used, or both share states.
    """
    mine, theirs = load_dataset(folder), load_dataset(test)
    if set(mine.seeds.tolist()) & set(theirs.seeds.tolist()):
        raise CaretreeError(f"{test} has states that {folder} has too; it is to be tested on others")
    start = time.process_time()
    network = train_reward(outcomes_of(mine, say), steps, seed)
    seen = outcomes_of(theirs, say)
    with torch.no_grad():
        told = sum(network(torch.from_numpy(c))[:, 0].numpy() for c in (seen.cells, seen.cells[..., ::-1].copy()))
    area, low, high = area_under_curve(np.asarray(told), seen.won, seed)
    record = {
        "data": mine.digest,
        "test": theirs.digest,
        "area_under_curve": round(area, 4),
        "steps": steps,
        "seed": seed,
        "seconds": round(time.process_time() - start),
        "machine": f"{platform.machine()}, {platform.system()}",
        "made": time.strftime("%Y-%m-%d", time.gmtime()),
    }
    export_reward(network, out, record)
    RewardClassifier(out)  # what cannot be read is told now
    return (
        f"area under the curve {area:.3f} ({low:.3f} to {high:.3f}) on {len(seen.won)} attempts in "
        f"{len(theirs.seeds)} states, {int(seen.won.sum())} successes; {out}"
    )
