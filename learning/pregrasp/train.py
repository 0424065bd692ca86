"""Train the policy: demonstrations of the oracle, then active trials in the spring engine.

    L = mean of bce(F(s, a), r) over the actions that were tried
        + lambda * sum of bce(F(s, a), 0) over the actions too far from the corner to succeed / number of states
        + mean over the pictures of the entropy of the corner's place, or of its being nowhere

and then, of all attempts, what fingers take (`grasp_network.py`).  The paper has Huber's loss
and the mean square in place of the entropies; with them our values fell to 0 everywhere, where a sigmoid has no slope
to learn by.  Where the corner is, the simulator tells of demonstrated states alone; what lies near it and was not tried
counts neither way.  Some pictures are mirrored: where the corner is then does not depend on the primitives, whose
approach from the right has no mirror image.  Each random choice has a generator of its own number, so that a training
that goes on after an interruption makes the same choices.
"""

from __future__ import annotations

import hashlib
import json
import platform
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np
import torch  # pyright: ignore[reportMissingImports] - in the extra `learn`
from torch.nn.functional import (  # pyright: ignore[reportMissingImports] - in the extra `learn`
    binary_cross_entropy_with_logits as entropy,
)
from torch.nn.functional import log_softmax, softplus  # pyright: ignore[reportMissingImports] - in the extra `learn`

from ...sim.errors import CaretreeError
from ...sim.pregrasp.action import hand_path
from ...sim.pregrasp.affordance import COLUMN, CORNER, GOWN, GREY, any_action, best_action, seen, values_of, votes
from ...sim.pregrasp.numbers import DIRECT
from ...sim.pregrasp.policy import GRASPS, Policy
from ...sim.pregrasp.reward import RewardClassifier
from ...sim.pregrasp.surroundings import surroundings, voted_corner
from ..seeds import KEPT_SEEDS
from .calibration import fit_chance
from .dataset import Dataset, load_dataset
from .evaluate import try_policy
from .export import export, export_grasps
from .grasp_network import Grasps, together, train_grasps
from .hung_state import hang
from .network import PolicyNetwork
from .photograph import photograph
from .roll_out import roll_out

BATCH = 4  # states of a step
RATE, LAMBDA = 2e-3, 0.03  # of learning, at first; lambda
FAR, SHOWS, BLOB = 0.15, 0.04, 0.02  # [m] of the corner: no success beyond; it shows within; width of its place
MIRRORED, LIGHTER = 0.33, 0.3  # share of states; by how much pictures are lighter or darker at most
EPSILON, DECAY = 0.5, 300  # of exploring at the first trial; trials in which it falls to 37 %
EVERY, SAVE, LAST = 4, 100, 200  # trials to a step; to a checkpoint; over which success is told
TRIAL_SEEDS = 2000  # first seed of the states of active trials; they end before `KEPT_SEEDS`


@dataclass(frozen=True, kw_only=True)
class Plan:
    """One training.

    Attributes:
        steps: on demonstrations; 0 leaves demonstrations out altogether.
        grasp_steps: of the network of what fingers take.
        trials: active ones after them.
        grasp_only: whether the direct grasp is the only primitive.
        seed: of weights and choices.
        reward: hash of the network that tells the trials' success by pictures; empty where the simulator tells it.
    """

    steps: int = 400
    grasp_steps: int = 6000
    trials: int = 1000
    grasp_only: bool = False
    seed: int = 0
    reward: str = ""


class Training:
    """Weights, what was tried, and how far it is."""

    def __init__(self, data: Dataset, plan: Plan, reward: RewardClassifier | None = None) -> None:
        torch.manual_seed(plan.seed)
        self.reward = reward
        self.plan, self.deep, self.physics, self.network = plan, data.deep, data.physics, PolicyNetwork()
        self.optimiser = torch.optim.Adam(self.network.parameters(), RATE)
        self.steps, self.trials, self.seconds = 0, 0, 0.0
        self.clock = time.process_time()
        self.curve: list[int] = []
        self.felt: list[Grasps] = []
        self.images = [seen(data.views(k)) for k in range(len(data.seeds))]
        self.tried: list[list[tuple[int, int, int, int, int]]] = [[] for _ in self.images]
        for row, won in zip(data.attempts.tolist(), data.success.tolist(), strict=True):
            if not plan.grasp_only or row[2] == DIRECT:
                self.tried[row[0]].append((row[3], row[2], row[4], row[5], int(won)))
        self.demonstrated = len(self.images) if plan.steps else 0
        if not plan.steps:
            self.images, self.tried = [], []
        self.marks = [self._marks(data, k) for k in range(self.demonstrated)]

    def _marks(self, data: Dataset, state: int) -> tuple[np.ndarray, np.ndarray]:
        """(6, H, W) bool, too far from the corner; (6, H, W) float32, the corner's place, of a sum of 1 or 0 a view."""
        places, spots = data.views(state).places()
        away = np.linalg.norm(places - data.corners[state], axis=1)
        far, blob = (np.zeros(data.depth.shape[1:], kind) for kind in (bool, np.float32))
        far[tuple(spots.T)] = away > FAR
        blob[tuple(spots.T)] = np.where(away < SHOWS, np.exp(-(away**2) / (2 * BLOB**2)), 0.0)
        return far, blob / np.maximum(blob.sum((1, 2), keepdims=True), 1e-9)

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
        mirrored = [k < self.demonstrated and rng.random() < MIRRORED for k in chosen]
        images = [
            _changed(self.images[k], by, flip)
            for k, by, flip in zip(chosen, rng.uniform(-LIGHTER, LIGHTER, BATCH), mirrored, strict=True)
        ]
        logits = self.network(torch.from_numpy(np.concatenate(images)))
        logits = logits.reshape(len(chosen), -1, *logits.shape[1:])
        loss = torch.zeros(())
        for n, k in enumerate(chosen):
            tried = np.array(self.tried[k])
            if len(tried) and not mirrored[n]:
                told = logits[n][tried[:, 0], tried[:, 1], tried[:, 2], tried[:, 3]]
                loss = loss + entropy(told, torch.from_numpy(tried[:, 4]).float(), reduction="mean")
            if k < self.demonstrated:
                loss = loss + self._marked(logits[n], images[n], k, mirrored[n])
        loss = loss / len(chosen)
        self.optimiser.zero_grad()
        loss.backward()
        for group in self.optimiser.param_groups:
            group["lr"] = RATE * (1.0 if self.steps < 0.6 * self.plan.steps else 0.25)
        self.optimiser.step()
        self.steps += 1
        return float(loss.detach())

    def _marked(self, logits: torch.Tensor, image: np.ndarray, state: int, flip: bool) -> torch.Tensor:
        """The loss (6, 4, H, W) of a state of which it is known where the corner is."""
        far, blob = (torch.from_numpy(mark[..., ::-1].copy() if flip else mark) for mark in self.marks[state])
        kinds = 1 if self.plan.grasp_only else CORNER
        fails = logits[:, DIRECT : DIRECT + 1] if self.plan.grasp_only else logits[:, :CORNER]
        lost = softplus(fails[far[:, None].expand(-1, kinds, -1, -1)]).sum()
        gown = torch.from_numpy(image[:, GOWN] > 0)
        scores = torch.where(gown, logits[:, CORNER], -torch.inf).flatten(1)
        scores = torch.cat([scores, torch.zeros(len(scores), 1)], 1)  # the last one is nowhere
        wanted = torch.cat([blob.flatten(1), 1.0 - blob.sum((1, 2))[:, None]], 1)
        chance = log_softmax(scores, 1)
        place = -torch.where(wanted > 0, wanted * chance, 0.0).sum(1).mean()
        return LAMBDA * lost + place

    def trial(self) -> bool:
        """One attempt in a state that was never seen, greedy or exploring; tells whether it succeeded.

        What is learned from it is what the reward says, where there is one; what counts is the truth.
        """
        plan, k = self.plan, self.trials
        rng = np.random.default_rng([plan.seed, 19, k])
        seed = TRIAL_SEEDS + (plan.seed * 1000 + k) % (KEPT_SEEDS - TRIAL_SEEDS)
        state = hang(seed, deep=self.deep, physics=self.physics)
        views = photograph(state)
        image = seen(views)
        with torch.no_grad():
            maps = self.network(torch.from_numpy(image)).numpy()
        if rng.random() < EPSILON * np.exp(-k / DECAY):
            action = any_action(rng, views, plan.grasp_only)
        else:
            action = best_action(values_of(maps, views), views, plan.grasp_only)
        grasp = roll_out(state, hand_path(views, action))
        won = told = grasp.success
        if self.reward is not None:
            after = photograph(replace(state, vertices=grasp.vertices), hand=grasp.hand)
            told = self.reward.chance(after, grasp.hand) > 0.5
        corner, spot = voted_corner(votes(maps, views), views.places()[0]), (action.view, action.row, action.column)
        self.felt.append(Grasps(*surroundings(views, corner, np.array([spot])), [action.primitive], [told]))
        self.images.append(image)
        self.tried.append([(action.view, action.primitive, action.row, action.column, int(told))])
        self.curve.append(int(won))
        self.trials += 1
        return won

    def save(self, path: Path, identity: str) -> None:
        """Write all that going on needs."""
        self.seconds += time.process_time() - self.clock
        self.clock = time.process_time()
        state = {
            "identity": identity,
            "seconds": self.seconds,
            "network": self.network.state_dict(),
            "optimiser": self.optimiser.state_dict(),
            "steps": self.steps,
            "curve": self.curve,
            "images": [torch.from_numpy(image) for image in self.images[self.demonstrated :]],
            "tried": self.tried[self.demonstrated :],
            "felt": [[torch.from_numpy(np.asarray(part)) for part in one] for one in self.felt],
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
        self.seconds = state["seconds"]
        self.steps, self.curve, self.trials = state["steps"], state["curve"], len(state["curve"])
        self.images += [image.numpy() for image in state["images"]]
        self.tried += state["tried"]
        self.felt = [Grasps(*(part.numpy() for part in one)) for one in state["felt"]]


def _changed(image: np.ndarray, lighter: float, flip: bool) -> np.ndarray:
    """Pictures (6, 5, H, W) of another brightness, and mirrored or not."""
    image = image.copy()
    image[:, GREY] += lighter * image[:, GOWN]
    if flip:
        image[:, :COLUMN] = image[:, :COLUMN, :, ::-1]
    return image


def train(
    folder: Path,
    out: Path,
    plan: Plan,
    say: Callable[[str], None] = lambda text: None,
    apart: Path | None = None,
    reward: Path | None = None,
) -> Path:
    """Train, or go on with a training; returns the first ONNX file.

    Args:
        folder: of `data`.
        out: gets checkpoint.pt, record.json, pregrasp.onnx and grasps.onnx.
        plan: what is trained.
        say: told of progress.
        apart: folder of `data` whose states are not trained on: they tell how sure a value is; None leaves that open.
        reward: file of `make_reward`, whose network tells the trials' success; None leaves that to the simulator.

    Raises:
        CaretreeError: the data cannot be used, `out` holds another training, or there is nothing to train on.
    """
    if plan.steps + plan.trials == 0:
        raise CaretreeError("neither demonstrations nor trials: there is nothing to train on")
    data = load_dataset(folder)
    told_by = RewardClassifier(reward) if reward else None
    if reward:
        plan = replace(plan, reward=hashlib.sha256(reward.read_bytes()).hexdigest()[:16])
    about = {"data": data.digest, **asdict(plan)}
    identity = hashlib.sha256(json.dumps(about, sort_keys=True).encode()).hexdigest()[:16]
    training = Training(data, plan, told_by)
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
        "seconds": round(training.seconds),
        "machine": f"{platform.machine()}, {platform.system()}",
        "made": time.strftime("%Y-%m-%d", time.gmtime()),
    }
    path = export(training.network, out / "pregrasp.onnx", record)
    start = time.process_time()
    shown = [grasps_of(data, Policy(path), plan.grasp_only)] if plan.steps else []
    grasps = train_grasps(together([*shown, *training.felt]), plan.grasp_steps, plan.seed)
    record |= {"seconds": record["seconds"] + round(time.process_time() - start)}
    export_grasps(grasps, out / GRASPS, record, (1.0, 0.0))
    if apart is not None:
        others = load_dataset(apart)
        tried = try_policy(others, Policy(path), say)
        record |= {"apart": others.digest, "apart_succeed": int(tried.best.sum()), "apart_states": len(tried.best)}
        export_grasps(grasps, out / GRASPS, record, fit_chance(tried.value, tried.best))
    (out / "record.json").write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")
    return path


def grasps_of(data: Dataset, policy: Policy, grasp_only: bool) -> Grasps:
    """The attempts of a dataset; the corner is where the pictures say that it is.

    Args:
        data: states and attempts.
        policy: whose first network finds the corner.
        grasp_only: whether only direct grasps count.
    """
    parts = []
    for k in range(len(data.seeds)):
        mine = (data.attempts[:, 0] == k) & ((data.attempts[:, 2] == DIRECT) | (not grasp_only))
        views = data.views(k)
        cells, corners = surroundings(views, policy.corner(views), data.attempts[mine, 3:6])
        parts.append(Grasps(cells, corners, data.attempts[mine, 2], data.success[mine]))
    return together(parts)
