"""Train the policy: demonstrations of the oracle, then active trials in the spring engine.

    L = mean of bce(F(s, a), r) over the actions that were tried
        + lambda * sum of bce(F(s, .), H(s)) over the pixels of the gown / (1 + sum of H(s) there), sums of a batch

H is a Gaussian at every action by which a demonstration succeeded, 0 elsewhere.  The paper has Huber's loss and the
mean square in place of the entropies; with them our values fell to 0 everywhere, where a sigmoid has no slope to learn
by.  The entropy of logits has one; background is left out since it cannot be chosen; the sum of H keeps the few pixels
of the blobs from drowning.  Each random choice has a generator of its own number, so that a training that goes on after
an interruption makes the same choices.
"""

from __future__ import annotations

import hashlib
import json
import platform
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
import torch  # pyright: ignore[reportMissingImports] - in the extra `learn`
from torch.nn.functional import (  # pyright: ignore[reportMissingImports] - in the extra `learn`
    binary_cross_entropy_with_logits as entropy,
)

from ...sim.errors import CaretreeError
from ..seeds import KEPT_SEEDS
from .affordance import GOWN, any_action, best_action, seen
from .dataset import Dataset, load_dataset
from .export import export
from .hung_state import hang
from .network import PolicyNetwork
from .oracle import DIRECT, attempt
from .views import photograph

BATCH = 4  # states of a step
RATE, LAMBDA, BLOB = 2e-3, 1.0, 1.5  # of learning; lambda; width of a Gaussian [px]
EPSILON, DECAY = 0.5, 300  # of exploring at the first trial; trials in which it falls to 37 %
EVERY, SAVE, LAST = 4, 100, 200  # trials to a step; to a checkpoint; over which success is told
TRIAL_SEEDS = 2000  # first seed of the states of active trials; they end before `KEPT_SEEDS`


@dataclass(frozen=True, kw_only=True)
class Plan:
    """One training.

    Attributes:
        steps: on demonstrations; 0 leaves demonstrations out altogether.
        trials: active ones after them.
        grasp_only: whether the direct grasp is the only primitive.
        seed: of weights and choices.
    """

    steps: int = 400
    trials: int = 1000
    grasp_only: bool = False
    seed: int = 0


class Training:
    """Weights, what was tried, and how far it is."""

    def __init__(self, data: Dataset, plan: Plan) -> None:
        torch.manual_seed(plan.seed)
        self.plan, self.deep, self.network = plan, data.deep, PolicyNetwork()
        self.optimiser = torch.optim.Adam(self.network.parameters(), RATE)
        self.steps, self.trials = 0, 0
        self.curve: list[int] = []
        self.images = [seen(data.views(k)) for k in range(len(data.seeds))]
        self.tried: list[list[tuple[int, int, int, int, int]]] = [[] for _ in self.images]
        for row, won in zip(data.attempts.tolist(), data.success.tolist(), strict=True):
            if not plan.grasp_only or row[2] == DIRECT:
                self.tried[row[0]].append((row[3], row[2], row[4], row[5], int(won)))
        self.demonstrated = len(self.images) if plan.steps else 0
        if not plan.steps:
            self.images, self.tried = [], []
        self.heat = [self._heat(k) for k in range(self.demonstrated)]

    def _heat(self, state: int) -> np.ndarray:
        """(6, 3, H, W) Gaussians at the demonstrations that succeeded."""
        views, _, height, width = self.images[state].shape
        heat = np.zeros((views, 3, height, width), np.float32)
        rows, columns = np.mgrid[:height, :width]
        for view, primitive, row, column, won in self.tried[state]:
            if won:
                blob = np.exp(-((rows - row) ** 2 + (columns - column) ** 2) / (2 * BLOB**2))
                heat[view, primitive] = np.maximum(heat[view, primitive], blob)
        return heat

    def step(self) -> float:
        """One step of the optimiser on states drawn from demonstrations and trials; returns the loss."""
        rng = np.random.default_rng([self.plan.seed, 18, self.steps])
        fresh = len(self.images) - self.demonstrated
        chosen = [
            int(rng.integers(self.demonstrated))
            if self.demonstrated and (not fresh or n % 2 == 0)
            else self.demonstrated + int(rng.integers(fresh))
            for n in range(BATCH)
        ]
        logits = self.network.logits(torch.from_numpy(np.concatenate([self.images[k] for k in chosen])))
        logits = logits.reshape(len(chosen), -1, *logits.shape[1:])
        loss, spread, marked = torch.zeros(()), torch.zeros(()), torch.ones(())
        for n, k in enumerate(chosen):
            tried = np.array(self.tried[k])
            told = logits[n][tried[:, 0], tried[:, 1], tried[:, 2], tried[:, 3]]
            loss = loss + entropy(told, torch.from_numpy(tried[:, 4]).float(), reduction="mean")
            if k < self.demonstrated:
                gown = torch.from_numpy(self.images[k][:, GOWN] > 0)[:, None].expand_as(logits[n])
                heat = torch.from_numpy(self.heat[k])
                spread = spread + entropy(logits[n][gown], heat[gown], reduction="sum")
                marked = marked + heat[gown].sum()
        loss = loss / len(chosen) + LAMBDA * spread / marked
        self.optimiser.zero_grad()
        loss.backward()
        self.optimiser.step()
        self.steps += 1
        return float(loss.detach())

    def trial(self) -> bool:
        """One attempt in a state that was never seen, greedy or exploring; tells whether it succeeded."""
        plan, k = self.plan, self.trials
        rng = np.random.default_rng([plan.seed, 19, k])
        state = hang(TRIAL_SEEDS + (plan.seed * 1000 + k) % (KEPT_SEEDS - TRIAL_SEEDS), deep=self.deep)
        views = photograph(state)
        image = seen(views)
        if rng.random() < EPSILON * np.exp(-k / DECAY):
            action = any_action(rng, views, plan.grasp_only)
        else:
            with torch.no_grad():
                action = best_action(self.network(torch.from_numpy(image)).numpy(), views, plan.grasp_only)
        won = attempt(state, views, action).success
        self.images.append(image)
        self.tried.append([(action.view, action.primitive, action.row, action.column, int(won))])
        self.curve.append(int(won))
        self.trials += 1
        return won

    def save(self, path: Path, identity: str) -> None:
        """Write all that going on needs."""
        state = {
            "identity": identity,
            "network": self.network.state_dict(),
            "optimiser": self.optimiser.state_dict(),
            "steps": self.steps,
            "curve": self.curve,
            "images": [torch.from_numpy(image) for image in self.images[self.demonstrated :]],
            "tried": self.tried[self.demonstrated :],
        }
        part = path.with_name(path.name + ".part")
        torch.save(state, part)
        part.replace(path)

    def load(self, path: Path, identity: str) -> None:
        """Go on from a file of `save`.

        Raises:
            CaretreeError: it is of another training.
        """
        state = torch.load(path, weights_only=True)
        if state["identity"] != identity:
            raise CaretreeError(f"{path.parent} holds another training; choose another folder")
        self.network.load_state_dict(state["network"])
        self.optimiser.load_state_dict(state["optimiser"])
        self.steps, self.curve, self.trials = state["steps"], state["curve"], len(state["curve"])
        self.images += [image.numpy() for image in state["images"]]
        self.tried += state["tried"]


def train(folder: Path, out: Path, plan: Plan, say: Callable[[str], None] = lambda text: None) -> Path:
    """Train, or go on with a training; returns the ONNX file.

    Args:
        folder: of `data`.
        out: gets checkpoint.pt, record.json and pregrasp.onnx.
        plan: what is trained.
        say: told of progress.

    Raises:
        CaretreeError: the data cannot be used, `out` holds another training, or there is nothing to train on.
    """
    if plan.steps + plan.trials == 0:
        raise CaretreeError("neither demonstrations nor trials: there is nothing to train on")
    data = load_dataset(folder)
    about = {"data": data.digest, **asdict(plan)}
    identity = hashlib.sha256(json.dumps(about, sort_keys=True).encode()).hexdigest()[:16]
    training, start = Training(data, plan), time.process_time()
    out.mkdir(parents=True, exist_ok=True)
    checkpoint = out / "checkpoint.pt"
    if checkpoint.is_file():
        training.load(checkpoint, identity)
    while training.trials == 0 and training.steps < plan.steps:
        loss = training.step()
        if training.steps % SAVE == 0:
            training.save(checkpoint, identity)
            say(f"{training.steps} of {plan.steps} steps on demonstrations, loss {loss:.4f}")
    while training.trials < plan.trials:
        training.trial()
        if training.trials % EVERY == 0:
            training.step()
        if training.trials % SAVE == 0:
            training.save(checkpoint, identity)
            last = training.curve[-LAST:]
            say(f"{training.trials} of {plan.trials} trials, {sum(last)} of the last {len(last)} succeed")
    training.save(checkpoint, identity)
    curve, ends = training.curve, range(SAVE, len(training.curve) + 1, SAVE)
    record = about | {
        "steps_done": training.steps,
        "success_of_last": [sum(curve[max(0, n - LAST) : n]) / min(n, LAST) for n in ends],
        "seconds": round(time.process_time() - start),
        "machine": f"{platform.machine()}, {platform.system()}",
        "made": time.strftime("%Y-%m-%d", time.gmtime()),
    }
    (out / "record.json").write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")
    return export(training.network, out / "pregrasp.onnx", record)
