"""How well the armholes of worn sleeves are told, on states of recorded runs, with the truth.

    python benchmarks/armhole_reach.py RECORD...

Draws what the head's camera sees of each sleeve, from the head of the bed and from beside the arm, in every state in
which the hands are open and away, with arms as well as they are tracked.  Prints for either how far the rule is off,
then the same of a least-squares fit to the other seeds' records alone, then the numbers of a fit to all.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from caretree.perception.image.surfaces import Surface
from caretree.perception.sleeve.armhole_reach import armhole_reach, reach_features
from caretree.perception.sleeve.cuff_round_arm import tape_near
from caretree.sim.evaluate.truth_file import read_truth
from caretree.sim.evaluate.verdict import sleeves_of
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.render.camera import CAMERA_VIEWS, camera_intrinsics
from caretree.sim.render.recorded_room import NEEDED, OPTIONAL, RecordedRoom
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.world import SIDES, Frame, Side
from caretree.skills.check_sleeve import CheckSleeveTuning
from caretree.skills.geometry.stances import stance, stance_at_head
from caretree.trees.tasks.dressing.tuning import DRESSING

AT_HEAD, BESIDE = "the head of the bed", "beside the arm"
REST = 6.0  # between two states [s]
AWAY = 0.45  # of the hands from the middle between the shoulders [m]
PANS = np.linspace(-1.5, 1.5, 25)  # of the head, of which that towards the shoulder is taken [rad]
SCATTER, TOO_LOW = 0.004, 0.006  # of tracked shoulders and elbows, which 848 of ten runs were [m]
DRAWS = 4  # of that error, for each view
LINE = np.array((-1.0, 2.0))  # beside which tape counts: 0 shoulder, 1 elbow
POINTS = 15  # of either tape, at least
FITTED_ABOVE, JUDGED_ABOVE = 0.4, 0.55  # of the upper arm
UP = 0.70  # what a nurse asks for
RIDGE = 0.01
WRONG = 0.01  # of those told up, at most


@dataclass
class View:
    """One sleeve as one picture shows it, and how far up it is in truth."""

    seed: int
    sleeve: tuple[str, int, Side, int]  # record, frame, side, draw of the tracking error
    where: str
    features: np.ndarray
    told: float
    true: float


def states_of(record: Path) -> Iterator[tuple[int, RecordedRoom, int, Side, np.ndarray, float]]:
    """Seed, room, frame, side, arms (2, 4, 3) [m] and how far up it is of each sleeve.

    States are those in which the hands are open and away, but for ones in which no sleeve has moved since the last.
    """
    truth, run = read_truth(record), json.loads((record / "run.json").read_text())
    with np.load(record / "truth.npz") as arrays:
        room = RecordedRoom(run, {name: arrays[name] for name in NEEDED + OPTIONAL if name in arrays})
        hands = arrays["gripper_pose"][:, :, :3]
    states, last = [], -np.inf
    for i, t in enumerate(truth.t):
        near = np.linalg.norm(hands[i] - truth.arms[i, :, 0].mean(axis=0), axis=1).min() < AWAY
        if t - last >= REST and not near and not truth.gripper_closed[i].any():
            states.append(i)
            last = t
    if not states:
        return
    sleeves = sleeves_of(truth, np.array(states))
    before = None
    for n, i in enumerate(states):
        up = [float(sleeves[side].armhole.upper_arm[n]) if sleeves[side].on[n] else None for side in SIDES]
        if up == before:
            continue
        before = up
        for side, true in zip(SIDES, up, strict=True):
            if true is not None:
                yield int(run["seed"]), room, int(i), side, truth.arms[i].astype(float), true


def views_of(record: Path, rng: np.random.Generator) -> Iterator[View]:
    """All sleeves of one record (a folder), wherever the hands are open and away."""
    for seed, room, i, side, arms, true in states_of(record):
        arm = arms[SIDES.index(side)]
        for where, stand in stands(side):
            for draw, (features, told) in enumerate(_seen(room, i, arm, stand, rng)):
                yield View(seed, (str(record), i, side, draw), where, features, told, true)


def head_view(stand: np.ndarray, shoulder: np.ndarray) -> np.ndarray:
    """Pose (4, 4) of the head's camera from a stand (3,) that has a shoulder (3,) nearest to its middle."""
    kinematics = kinematics_of(BAXTER)
    poses = [kinematics.pose_camera_in_map("head", np.asarray(stand), BAXTER.ready, float(pan)) for pan in PANS]
    return max(poses, key=lambda p: (shoulder - p[:3, 3]) @ p[:3, 2] / np.linalg.norm(shoulder - p[:3, 3]))


def stands(side: Side) -> list[tuple[str, np.ndarray]]:
    """From where sleeves are looked at."""
    beside = [(BESIDE, stance(side, stand)) for stand in ("shoulder", "lift")]
    return [(AT_HEAD, stance_at_head()), *beside]


def _seen(
    room: RecordedRoom, i: int, arm: np.ndarray, stand: np.ndarray, rng: np.random.Generator
) -> Iterator[tuple[np.ndarray, float]]:
    """Features and what is told of a sleeve in state `i`, with several draws of the error of a tracked arm (4, 3)."""
    pose = head_view(stand, arm[0])
    size, _ = CAMERA_VIEWS["head"]
    drawn = room.at(i).render(pose, size, camera_intrinsics("head"))
    frame = Frame(
        camera="head",
        stamp=0.0,
        rgb=drawn.rgb,
        depth=np.asarray(drawn.depth, np.float32),
        intrinsics=camera_intrinsics("head"),
        pose_camera_in_map=pose,
    )
    line = arm[0] + np.outer(LINE, arm[1] - arm[0])
    armhole, cuff = (tape_near(frame, tape, line) for tape in (Surface.ARMHOLE, Surface.CUFF))
    if min(len(armhole), len(cuff)) < POINTS:
        return
    for _ in range(DRAWS):
        tracked = arm.copy()
        tracked[:2] += rng.normal(0.0, SCATTER, (2, 3)) - (0.0, 0.0, TOO_LOW)
        told = armhole_reach(armhole, cuff, tracked, pose[:3, 3])
        yield reach_features(armhole, cuff, tracked), told


def fit(features: np.ndarray, true: np.ndarray) -> np.ndarray:
    """(1 + k,) numbers of a least-squares fit to (n, k), with a ridge on scaled features."""
    middle, scale = features.mean(axis=0), features.std(axis=0)
    scaled = np.column_stack((np.ones(len(true)), (features - middle) / scale))
    ridge = RIDGE * len(true) * np.diag((0.0, *np.ones(features.shape[1])))
    numbers = np.linalg.solve(scaled.T @ scaled + ridge, scaled.T @ true)
    changes = numbers[1:] / scale
    return np.concatenate(([numbers[0] - changes @ middle], changes))


def report(name: str, told: np.ndarray, true: np.ndarray) -> None:
    """How far off, and which bound would claim how many of those that are up."""
    error = (told - true)[true > JUDGED_ABOVE]
    bounds = (b for b in np.sort(told) if np.sum(true[told >= b] < UP) <= WRONG * np.sum(told >= b))
    bound = next(bounds, np.inf)
    claimed = np.sum((told >= bound) & (true >= UP)) / np.sum(true >= UP)
    off = f"off by {np.sqrt(np.mean(error**2)):.3f} (root mean square), {error.mean():+.3f} on average"
    print(f"{name}: {off}; told up from {bound:.3f} on: {claimed:.0%} of those up, {WRONG:.0%} wrongly")


def main(records: list[str]) -> None:
    """Print the table, and the numbers."""
    rng = np.random.default_rng(0)
    views = [view for record in records for view in views_of(Path(record), rng)]
    for where in (AT_HEAD, BESIDE):
        judge(where, [view for view in views if view.where == where])
    judge_together(views)


def judge_together(views: list[View]) -> None:
    """Print what the second look tells of sleeves that may be up after the first, alone and in the mean with it."""
    first = {view.sleeve: view.told for view in views if view.where == AT_HEAD}
    second = [view for view in views if view.where == BESIDE and view.sleeve in first]
    head = np.array([first[view.sleeve] for view in second])
    beside, up = np.array([view.told for view in second]), np.array([view.true >= UP for view in second])
    maybe = (head >= DRESSING.armhole_may_sit) & (head < DRESSING.armhole_up)
    counts = CheckSleeveTuning().before_counts
    print(f"told from {DRESSING.armhole_may_sit} to {DRESSING.armhole_up} from {AT_HEAD}: {maybe.sum()} of {len(head)}")
    for name, told, least in (
        (BESIDE, beside, DRESSING.armhole_beside),
        ("in the mean of both", counts * head + (1.0 - counts) * beside, DRESSING.armhole_together),
    ):
        claimed = maybe & (told >= least)
        wrong, found = np.mean(~up[claimed]), np.mean(claimed[maybe & up])
        print(f"  {name}, from {least} on: {claimed.sum()} told up, {wrong:.0%} wrongly, {found:.0%} of those up")


def judge(where: str, views: list[View]) -> None:
    """Print how well sleeves are told that were seen from there."""
    features, true = np.array([view.features for view in views]), np.array([view.true for view in views])
    seeds = np.array([view.seed for view in views])
    print(f"from {where}: {len(views) // DRAWS} views, {len(set(seeds))} seeds")
    report("the rule", np.array([view.told for view in views]), true)
    told = np.empty(len(views))
    for seed in set(seeds):
        others = (seeds != seed) & (true > FITTED_ABOVE)
        base, *changes = fit(features[others], true[others])
        told[seeds == seed] = base + features[seeds == seed] @ np.array(changes)
    report("fitted to other seeds", told, true)
    print(tuple(float(number) for number in fit(features[true > FITTED_ABOVE], true[true > FITTED_ABOVE]).round(3)))


if __name__ == "__main__":
    main(sys.argv[1:])
