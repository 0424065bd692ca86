"""The project's own verdict on a record: dressed and unharmed or not, why, and the numbers behind it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ..record.record import read_run
from ..record.truth import TORSO_POINTS_MIN
from ..world import SIDES
from . import limits
from .coverage import coverage
from .crossings import Sleeve, sleeve
from .findings import Findings
from .harm import find_harm
from .plausibility import Motion, motion
from .truth_file import Truth, read_truth


@dataclass(frozen=True, kw_only=True)
class Verdict:
    """What the geometry of a run says.

    Attributes:
        dressed: the person is dressed, the motion is believable and, where the record tells, nobody is harmed.
        unharmed: the person is unharmed, dressed or not; None where the record does not tell.
        problems: one sentence for each reason why not; empty when dressed.
        numbers: name with unit -> value, for reports and tables.
        places: name of a number -> what it was found at, and when.
        claimed: outcome that the run itself wrote, which decides nothing here.
        seed: of the run.
    """

    dressed: bool
    unharmed: bool | None = None
    problems: tuple[str, ...]
    numbers: Mapping[str, float] = field(default_factory=dict)
    places: Mapping[str, str] = field(default_factory=dict)
    claimed: str | None = None
    seed: int | None = None

    @property
    def agrees(self) -> bool:
        """Whether the run claimed success exactly when the person is dressed."""
        return (self.claimed == "success") == self.dressed

    def as_dict(self) -> dict[str, Any]:
        """For run tables and JSON."""
        return {
            "dressed": self.dressed,
            "unharmed": self.unharmed,
            "problems": list(self.problems),
            "numbers": dict(self.numbers),
            "places": dict(self.places),
            "claimed": self.claimed,
            "seed": self.seed,
            "agrees": self.agrees,
        }

    def __str__(self) -> str:
        """One line, then one for each problem."""
        harm = {None: "unharmed: unknown", True: "unharmed", False: "HARMED"}[self.unharmed]
        head = f"{'dressed' if self.dressed else 'NOT dressed'}, {harm}"
        return "\n".join([head, *(f"  - {problem}" for problem in self.problems)])


def evaluate(directory: Path | str) -> Verdict:
    """Decide from the record in `directory` whether the person is dressed and unharmed.

    Raises:
        RecordError: the record is missing, damaged, or was cut short before truth.npz was written.
    """
    directory = Path(directory)
    run = read_run(directory)
    found, unharmed = judge_truth(read_truth(directory))
    return Verdict(
        dressed=not found.problems,
        unharmed=unharmed,
        problems=tuple(found.problems),
        numbers={name: round(float(value), 4) for name, value in found.numbers.items()},
        places=found.places,
        claimed=run.get("outcome"),
        seed=run.get("seed"),
    )


def judge_truth(truth: Truth) -> tuple[Findings, bool | None]:
    """Problems and numbers of a run, no problem means dressed; and whether the person is unharmed, None if unknown."""
    found = Findings(problems=_not_finite(truth))
    if found.problems:  # geometry on such numbers would say anything
        return found, None
    found.numbers["sim_time_s"] = float(truth.t[-1] - truth.t[0])
    _judge_frames(truth, found)
    _judge_sleeves(truth, found)
    _judge_cover(truth, found)
    moved = motion(truth.t, truth.vertices, truth.faces, truth.rest_vertices, truth.arms, truth.arm_radii)
    _judge_limits(truth, moved, found)
    if truth.lacks:
        found.problems.append(f"the record lacks {', '.join(truth.lacks)}")
    if truth.unharmed is None:
        return found, None
    harm = find_harm(truth, truth.unharmed, found.numbers["outside_out"])
    found.add(harm)
    return found, not harm.problems


def _not_finite(truth: Truth) -> list[str]:
    held = truth.gripper_load[truth.gripper_closed.astype(bool)]  # an open gripper may read nothing
    checked = {
        "t": truth.t,
        "vertices": truth.vertices,
        "rest_vertices": truth.rest_vertices,
        "arms": truth.arms,
        "arm_radii": truth.arm_radii,
        "torso_front": truth.torso_front[-1],
        "gripper_load": held,
    }
    if truth.unharmed is not None:
        rows = ("robot_capsules", "person_capsules", "bed_top", "face")
        checked |= {name: getattr(truth.unharmed, name) for name in rows}
    broken = [name for name, array in checked.items() if not np.isfinite(array).all()]
    return [f"{name} holds a number that is not finite" for name in broken]


def _judge_frames(truth: Truth, found: Findings) -> None:
    gap = found.numbers["frame_gap_max_s"] = float(np.diff(truth.t).max())
    if gap > limits.FRAME_GAP_MAX:
        found.problems.append(f"frames lie up to {gap:.2f} s apart, {limits.FRAME_GAP_MAX} s are allowed")
    if (np.diff(truth.t) <= 0).any():
        found.problems.append("time does not grow from frame to frame")
    travel = found.numbers["gown_travel_m"] = float(
        np.linalg.norm(
            truth.vertices[-1].astype(np.float64).mean(axis=0) - truth.vertices[0].astype(np.float64).mean(axis=0)
        )
    )
    if travel < limits.TRAVEL_MIN:
        found.problems.append(f"the gown moved {travel:.2f} m, but from the rail it is at least {limits.TRAVEL_MIN} m")


def sleeves_of(truth: Truth, frames: np.ndarray) -> dict[str, Sleeve]:
    """Both sleeves in the given frames, by the person's side."""
    vertices, arms = truth.vertices[frames].astype(np.float64), truth.arms[frames].astype(np.float64)
    loops = truth.loops
    return {
        side: sleeve(vertices[:, loops[f"armhole_{side}"]], vertices[:, loops[f"cuff_{side}"]], arms[:, k])
        for k, side in enumerate(SIDES)
    }


def _judge_sleeves(truth: Truth, found: Findings) -> None:
    held = np.flatnonzero(truth.t >= truth.t[-1] - limits.HOLD)
    for side, worn in sleeves_of(truth, held).items():
        off = int((~worn.on).sum())
        if off:
            found.problems.append(f"the {side} arm is not through its sleeve in {off} of the last {len(held)} frames")
        up = found.numbers[f"upper_arm_{side}"] = float(worn.armhole.upper_arm.min())
        if up < limits.UPPER_ARM_MIN:
            found.problems.append(
                f"the {side} armhole is {up:.2f} up the upper arm, {limits.UPPER_ARM_MIN} is asked for"
            )
    if truth.gripper_closed[held].any():
        found.problems.append(f"a gripper still holds cloth in the last {limits.HOLD:g} s")
    first = sleeves_of(truth, np.array([0]))
    if all(worn.on[0] for worn in first.values()):
        found.problems.append("both arms are in their sleeves in the first frame already")


def _judge_cover(truth: Truth, found: Findings) -> None:
    torso = truth.torso_front[-1].astype(np.float64)
    if len(torso) < TORSO_POINTS_MIN:
        found.problems.append(f"the torso front has {len(torso)} points, at least {TORSO_POINTS_MIN} are asked for")
    cover, outside = coverage(truth.vertices[-1].astype(np.float64), truth.faces, torso)
    found.numbers["coverage"], found.numbers["outside_out"] = cover, outside
    if cover < limits.COVERAGE_MIN:
        found.problems.append(f"{cover:.2f} of the torso front is covered, {limits.COVERAGE_MIN} is asked for")
    if outside < limits.OUTSIDE_MIN:
        found.problems.append(f"the gown is inside out over {1 - outside:.2f} of the covered torso")


def _judge_limits(truth: Truth, moved: Motion, found: Findings) -> None:
    load = np.linalg.norm(truth.gripper_load.astype(np.float64), axis=2)[truth.gripper_closed.astype(bool)]
    for name, unit, value, limit in (
        ("stretch_p99", "", moved.stretch_p99.max(), limits.STRETCH_P99_MAX),
        ("stretch_max", "", moved.stretch_max.max(), limits.STRETCH_MAX),
        ("vertex_speed_max", "m/s", moved.speed.max(), limits.VERTEX_SPEED_MAX),
        ("arm_depth_max", "m", moved.depth.max(), limits.DEPTH_MAX),
        ("gripper_load_max", "N", load.max(initial=0.0), limits.LOAD_MAX),
    ):
        found.numbers[f"{name}_{unit}".replace("/", "_per_").rstrip("_").lower()] = float(value)
        if value > limit:
            found.problems.append(f"{name.replace('_', ' ')} is {value:.3f} {unit}".rstrip() + f", {limit} is allowed")
