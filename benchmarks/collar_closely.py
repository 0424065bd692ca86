"""How well close looks tell where the collar of a worn gown lies, on states of recorded runs, with the truth.

    python benchmarks/collar_closely.py RECORD...

Draws what the head's camera and both hands' show of the collar, the hands' from where `LookAtCollar` brings them, in
the states of `armhole_reach.py`, with the middle between the shoulders as well as it is tracked.  Prints how far aside
each way to put them together is off, how many of the states it tells within some bounds, and how many of these wrongly.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from armhole_closely import frame_of
from armhole_reach import SCATTER, head_view, states_of
from caretree.perception.errors import PerceptionFailure
from caretree.perception.gown.collar import collar_middle
from caretree.sim.evaluate.limits import COLLAR_ALONG, COLLAR_ASIDE_MAX
from caretree.sim.evaluate.truth_file import read_truth
from caretree.sim.render.camera import looking_at
from caretree.sim.world import SIDES
from caretree.skills.belief.shoulders import COLLAR_SEEN
from caretree.skills.geometry.arm_path import UP
from caretree.skills.geometry.stances import HEADWARD, outwards, stance_at_head
from caretree.trees.tasks.dressing.look_at_collar import LookAtCollarTuning
from caretree.trees.tasks.dressing.tuning import DRESSING

LOOK = LookAtCollarTuning()
MOVED = 0.003  # of the collar, less than which is no other state [m]
ASIDE, HEADWARD_MAX, FOOTWARD_MAX = 0.18, 0.13, 0.09  # of the states that are looked at [m]
CERTAIN = 4.0  # power of what a picture shows, by which it counts in a mean
BOUNDS = (0.030, 0.035, 0.040, 0.045, 0.050)  # [m]


def looks_in(record: Path, rng: np.random.Generator) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Where the collar lies (3,), from the shoulders' middle, and where it is seen (4, 4).

    By left hand, right hand and head, and by all three together; the fourth number is how much of it shows, 0 where
    nothing does.
    """
    truth, before = read_truth(record), np.full(3, np.inf)
    if truth.unharmed is None:
        return
    neckline = truth.unharmed.neckline
    for _, room, i, side, arms, _ in states_of(record):
        middle = arms[:, 0].mean(axis=0)
        true = truth.vertices[i, neckline[len(neckline) // 2]] - middle
        if side != SIDES[0] or np.linalg.norm(true - before) < MOVED:
            continue
        before = true
        poses = [("head", head_view(stance_at_head(), middle))]
        aside, headward, up = LOOK.eyes[0]
        for of in SIDES[::-1]:
            eye = middle + aside * outwards(of) + headward * HEADWARD + up * UP
            poses.insert(0, (f"{of}_hand", looking_at(eye, middle + LOOK.above * UP)))
        tracked, seen = middle + rng.normal(0.0, SCATTER, 3), np.zeros((4, 4))
        frames = [frame_of(room, i, camera, pose, rng) for camera, pose in poses]
        for n, (frame, beside) in enumerate([*((frame, []) for frame in frames), (frames[0], frames[1:])]):
            try:
                look = collar_middle(frame, tracked, beside=beside)
            except PerceptionFailure:
                continue
            seen[n] = *(look.position_in_map - tracked - (COLLAR_SEEN.aside, 0.0, 0.0)), look.confidence
        yield true, seen


def report(name: str, place: np.ndarray, shown: np.ndarray, true: np.ndarray) -> None:
    """Print how far off `place` (n, 3) is, and what is told of what shows so much (n,)."""
    off = place[:, 0] - true[:, 0]
    low, high = COLLAR_ALONG
    good = (np.abs(true[:, 0]) < COLLAR_ASIDE_MAX) & (true[:, 1] > low) & (true[:, 1] < high)
    print(f"{name}: off by {np.sqrt(np.mean(off**2)):.3f} m aside, {np.abs(off).max():.3f} m at worst")
    for bound in BOUNDS:
        told = (np.abs(place[:, 0]) < bound) & (place[:, 1] > -DRESSING.collar_headward)
        told &= (place[:, 1] < DRESSING.collar_footward) & (shown > DRESSING.collar_told)
        print(f"  within {bound:.3f} m: {told.sum()} of {good.sum()} told, {(told & ~good).sum()} of them wrongly")


def main(records: list[Path]) -> None:
    """Compare ways to put the pictures together."""
    rng = np.random.default_rng(0)
    both = [look for record in records for look in looks_in(record, rng)]
    true, seen = (np.array(each) for each in zip(*both, strict=True))
    near = (np.abs(true[:, 0]) < ASIDE) & (true[:, 1] > -HEADWARD_MAX) & (true[:, 1] < FOOTWARD_MAX)
    near &= np.all(seen[:, :2, 3] > 0.0, axis=1)
    true, seen = true[near], seen[near]
    print(f"{len(true)} states of {len(records)} records")
    single, shows = seen[:, :3, :3], seen[:, :3, 3]
    weights = shows**CERTAIN / (shows**CERTAIN).sum(axis=1, keepdims=True)
    mean = np.einsum("ij,ijk->ik", weights, single)
    report("the mean of three pictures, as they count", mean, (weights * shows).sum(axis=1), true)
    report("three pictures read as one", seen[:, 3, :3], seen[:, 3, 3], true)


if __name__ == "__main__":
    main([Path(name) for name in sys.argv[1:]])
