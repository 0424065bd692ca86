"""How well close looks tell the armholes of worn sleeves, on states of recorded runs, with the truth.

    python benchmarks/armhole_closely.py RECORD...

Draws what the head's camera, from the head of the bed, and a hand's camera, from where `LookAtSleeves` brings it, see
of each sleeve in the states of `armhole_reach.py`, with arms as well as they are tracked.  Prints how far the rule is
off with all of the pictures and with fewer, then the same of a least-squares fit to the other seeds' records alone,
then the numbers of a fit to all.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

import numpy as np
from armhole_reach import FITTED_ABOVE, SCATTER, TOO_LOW, fit, head_view, report, states_of
from caretree.perception.errors import PerceptionFailure
from caretree.perception.estimates import SleeveProfile
from caretree.perception.sleeve.sleeve_profile import reach_of, rim_features, sleeve_profile
from caretree.sim.render.camera import CAMERA_VIEWS, camera_intrinsics, looking_at
from caretree.sim.render.camera_noise import add_sensor_noise
from caretree.sim.render.recorded_room import RecordedRoom
from caretree.sim.world import SIDES, Frame
from caretree.skills.geometry.arm_path import UP
from caretree.skills.geometry.stances import HEADWARD, outwards, stance_at_head
from caretree.trees.tasks.dressing.look_at_sleeves import LookAtSleevesTuning
from caretree.trees.tasks.dressing.tuning import DRESSING

LOOK = LookAtSleevesTuning()
PICTURES = ("the head's", *(f"a hand's from {eye}" for eye in LOOK.eyes))


class Sleeve(NamedTuple):
    """What each of `PICTURES` shows of one armhole, None where too little, and how far up it is in truth."""

    seed: int
    profiles: tuple[SleeveProfile | None, ...]
    true: float


def sleeves_in(record: Path, rng: np.random.Generator) -> Iterator[Sleeve]:
    """All sleeves of one record (a folder), wherever the hands are open and away."""
    for seed, room, i, side, arms, true in states_of(record):
        arm = arms[SIDES.index(side)]
        middle, tracked = arms[:, 0].mean(axis=0), arm.copy()
        tracked[:2] += rng.normal(0.0, SCATTER, (2, 3)) - (0.0, 0.0, TOO_LOW)
        poses = [("head", head_view(stance_at_head(), arm[0]))]
        for aside, headward, up in LOOK.eyes:
            eye = middle + aside * outwards(side) + headward * HEADWARD + up * UP
            poses.append((f"{side}_hand", looking_at(eye, arm[0] + LOOK.aimed_at * (arm[1] - arm[0]))))
        profiles: list[SleeveProfile | None] = []
        for camera, pose in poses:
            profiles.append(None)
            with suppress(PerceptionFailure):
                profiles[-1] = sleeve_profile(frame_of(room, i, camera, pose, rng), side, tracked)
        yield Sleeve(seed, tuple(profiles), true)


def frame_of(room: RecordedRoom, i: int, camera: str, pose: np.ndarray, rng: np.random.Generator) -> Frame:
    """What a camera at a pose (4, 4) sees of state `i`."""
    size, lens = CAMERA_VIEWS[camera][0], camera_intrinsics(camera)
    rgb, depth = add_sensor_noise(room.at(i).render(pose, size, lens), rng)
    return Frame(camera=camera, stamp=0.0, rgb=rgb, depth=depth, intrinsics=lens, pose_camera_in_map=pose)


def judge(name: str, sleeves: list[Sleeve], pictures: tuple[int, ...]) -> None:
    """Print how well sleeves are told by some of the pictures, those that show an armhole at all."""
    shown = [(s, [p for n, p in enumerate(s.profiles) if n in pictures and p is not None]) for s in sleeves]
    told = [(s, profiles) for s, profiles in shown if len(profiles) >= min(LOOK.min_pictures, len(pictures))]
    true, seeds = np.array([s.true for s, _ in told]), np.array([s.seed for s, _ in told])
    features = np.array([rim_features(profiles) for _, profiles in told])
    reach = np.array([reach_of(profiles) for _, profiles in told])
    print(f"{name}: {len(told)} of {len(sleeves)} sleeves, {len(set(seeds))} seeds")
    report("  the rule", reach, true)
    others = np.empty(len(true))
    for seed in set(seeds):
        base, *changes = fit(features[seeds != seed], true[seeds != seed])
        others[seeds == seed] = base + features[seeds == seed] @ np.array(changes)
    report("  fitted to other seeds", others, true)
    if len(pictures) == len(PICTURES):
        up = reach >= DRESSING.armhole_closely
        worst = true[up].min(initial=1.0)
        print(f"  from {DRESSING.armhole_closely} on: {up.sum()} told up, the lowest at {worst:.3f}")
        print(f"  {tuple(float(number) for number in fit(features, true).round(3))}")


def main(records: list[str]) -> None:
    """Print the table, and the numbers."""
    rng = np.random.default_rng(0)
    sleeves = [s for record in records for s in sleeves_in(Path(record), rng) if s.true > FITTED_ABOVE]
    judge("all pictures", sleeves, tuple(range(len(PICTURES))))
    for n, picture in enumerate(PICTURES):
        judge(f"{picture} alone", sleeves, (n,))


if __name__ == "__main__":
    main(sys.argv[1:])
