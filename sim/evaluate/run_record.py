"""What a task's `judge(record)` is given, truth and nothing that the tree says, and what it answers.

def judge(record: RunRecord) -> Judgement:
checks = Checks(record)
checks.at_most("cup_from_mat", float(np.linalg.norm(record.object("cup")[-1, :2] - MAT)), 0.05, "m")
checks.unharmed()
return checks.judgement()
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import RecordError
from ..record.record import RUN_FILE, TRUTH_FILE, read_run
from ..record.spool import DAMAGED
from ..record.truth import OBJECT
from ..scene.person_spec import PERSON_PARTS
from .arrays_file import read_arrays
from .findings import Findings
from .harm import look_at_forces, look_at_robot, look_at_wrists
from .unharmed_rows import UnharmedRows

NEEDED = (
    *("t", "arms", "arm_radii", "gripper_pose", "gripper_closed", "gripper_load", "person_force", "person_parts"),
    *(
        "robot_capsules",
        "robot_capsule_names",
        "holds_arm",
        "person_capsules",
        "person_capsule_names",
        "bed_top",
        "face",
    ),
)


class NotRecordedError(RecordError):
    """A record lacks what every run of its task writes: the record is to blame, not the judge that asks for it."""


class _Parameters(dict[str, Any]):
    """Values of the task's parameters; asked for one that is not there, the record is blamed."""

    def __init__(self, values: Mapping[str, Any], file: Path) -> None:
        super().__init__(values)
        self._file = file

    def __missing__(self, name: str) -> Any:
        raise NotRecordedError(
            f"{self._file} is damaged: it lacks the task's parameter {name!r}, which the judge asks for"
        )


@dataclass(frozen=True, kw_only=True)
class Judgement:
    """What a judge found.

    Attributes:
        success: whether the task reached what it is for, and harmed nobody.
        problems: one sentence for each reason why not.
        numbers: name with unit -> value, for tables.
    """

    success: bool
    problems: tuple[str, ...] = ()
    numbers: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Refuse a judgement that contradicts itself."""
        if self.success == bool(self.problems):
            raise RecordError("a judgement is a success without problems, or a failure with at least one")

    def __str__(self) -> str:
        """One line, then one for each problem."""
        head = "reached its goal" if self.success else "did NOT reach its goal"
        return "\n".join([head, *(f"  - {problem}" for problem in self.problems)])

    def as_dict(self) -> dict[str, Any]:
        """For run.json."""
        numbers = {name: round(float(value), 4) for name, value in self.numbers.items()}
        return {"success": self.success, "problems": list(self.problems), "numbers": numbers}


class RunRecord:
    """The truth of one run.

    Args:
        directory: of the record.

    Attributes:
        directory: of the record.
        seed: of the run.
        parameters: values of the task's parameters, defaults too.
        t: (T,) world clock [s].
        arms: (T, 2, 4, 3) left and right shoulder, elbow, wrist, fingertip in the map [m].
        person_parts: names of the person's parts.
        person_force: (T, k) force on each of them, by cloth, objects and robot [N].
        holds_arm: (T, 2) which arm each hand of the robot holds: -1 none, 0 left, 1 right.
        holds_cloth: (T, 2) bool.
        cloth_load: (T, 2, 3) of held cloth on each hand [N].
        hands: (T, 2, 7) position [m] and quaternion x, y, z, w of each hand of the robot.
        bed_top: height of the mattress [m].
        arm_radii: (2, 3) of upper arm, forearm and hand [m].
        rows: what tells whether the person is unharmed.

    Raises:
        RecordError: the record lacks truth.npz, or one of its files is damaged.
    """

    def __init__(self, directory: Path | str) -> None:
        self.directory = Path(directory)
        run = read_run(self.directory)
        file = self.directory / RUN_FILE
        given, seed = run.get("parameters") or {}, run.get("seed") or 0
        build = (given.get("build") or {}) if isinstance(given, dict) else None
        if not isinstance(build, dict):
            raise RecordError(f"{file} is damaged: parameters is {str(given)[:60]!r}")
        if not isinstance(seed, int) or isinstance(seed, bool):
            raise RecordError(f"{file} is damaged: seed is {str(seed)[:60]!r}, but a whole number is asked for")
        self._fill(seed, _Parameters(build, file), read_arrays(self.directory, NEEDED))
        self._made: dict[str, np.ndarray] | None = None

    @classmethod
    def made_up(
        cls,
        *,
        objects: Mapping[str, np.ndarray] | None = None,
        parameters: Mapping[str, Any] | None = None,
        **truth: np.ndarray,
    ) -> RunRecord:
        """A record to test a judge with: nothing happens in it but what is given.

        Args:
            objects: name -> state, as `object` returns it.
            parameters: of the task.
            **truth: arrays of truth.npz, all of T frames; where `t` is missing, they are 0.1 s apart.
        """
        frames = next((len(array) for array in (*truth.values(), *(objects or {}).values())), 2)
        arm = np.array([(0.0, y, 0.0) for y in (0.0, 0.3, 0.55, 0.7)])
        nowhere = np.tile((0.0, 50.0, 0.0, 0.0, 50.0, 1.0, 0.1), (frames, 1, 1))
        still: dict[str, np.ndarray] = {
            "t": 0.1 * np.arange(frames),
            "arms": np.tile(np.stack((arm - (0.3, 0, 0), arm + (0.3, 0, 0))), (frames, 1, 1, 1)),
            "arm_radii": np.tile((0.05, 0.045, 0.04), (2, 1)),
            "gripper_pose": np.zeros((frames, 2, 7)),
            "gripper_closed": np.zeros((frames, 2), bool),
            "gripper_load": np.zeros((frames, 2, 3)),
            "person_parts": np.array(PERSON_PARTS),
            "person_force": np.zeros((frames, len(PERSON_PARTS))),
            "robot_capsules": nowhere,
            "robot_capsule_names": np.array(("left_palm",)),
            "holds_arm": np.full((frames, 2), -1),
            "person_capsules": np.array(((0.0, 0.1, -0.1, 0.0, 0.5, -0.1, 0.1), (0.0, -0.1, 0.0, 0.0, -0.2, 0.0, 0.1))),
            "person_capsule_names": np.array(("trunk", "neck_head")),
            "bed_top": np.array(-0.05),
            "face": np.array((0.0, -0.2, 0.1, 0.0, 0.0, 1.0)),
        }
        record = cls.__new__(cls)
        record.directory = Path("made up")
        record._made = {OBJECT + name: np.asarray(state) for name, state in (objects or {}).items()} | truth
        record._fill(0, dict(parameters or {}), still | truth)
        return record

    def _fill(self, seed: int, parameters: dict[str, Any], found: Mapping[str, np.ndarray]) -> None:
        self.seed, self.parameters = seed, parameters
        self.t: np.ndarray = found["t"].astype(float)
        if len(self.t) < 2:
            raise RecordError(f"{self.directory / TRUTH_FILE} holds {len(self.t)} frames, but 2 are asked for")
        self.arms: np.ndarray = found["arms"].astype(float)
        self.arm_radii: np.ndarray = found["arm_radii"].astype(float)
        self.person_parts = tuple(str(name) for name in found["person_parts"])
        self.person_force: np.ndarray = np.nan_to_num(found["person_force"].astype(float))
        self.holds_arm: np.ndarray = found["holds_arm"]
        self.holds_cloth: np.ndarray = found["gripper_closed"].astype(bool)
        self.cloth_load: np.ndarray = found["gripper_load"].astype(float)
        self.hands: np.ndarray = found["gripper_pose"].astype(float)
        self.bed_top = float(found["bed_top"])
        body = found["person_capsules"]
        self.rows = UnharmedRows(
            robot_capsules=found["robot_capsules"],
            robot_capsule_names=tuple(str(name) for name in found["robot_capsule_names"]),
            holds_arm=self.holds_arm,
            person_capsules=np.broadcast_to(body, (len(self.t), *body.shape[-2:])),
            person_capsule_names=tuple(str(name) for name in found["person_capsule_names"]),
            bed_top=self.bed_top,
            face=found["face"].astype(float),
            neckline=np.zeros(0, dtype=int),
            person_force=self.person_force,
            person_parts=self.person_parts,
        )

    def array(self, name: str) -> np.ndarray:
        """Any array of truth.npz.

        Raises:
            RecordError: it is not there.
        """
        if self._made is None:
            return read_arrays(self.directory, (name,))[name]
        if name not in self._made:
            raise RecordError(f"the record lacks {name}")
        return self._made[name]

    def object(self, name: str) -> np.ndarray:
        """Of an object that the task has added: (T, 7) position and quaternion, or (T, V, 3) vertices of a sheet [m].

        Raises:
            RecordError: there is none of that name.
        """
        try:
            return self.array(OBJECT + name).astype(float)
        except RecordError as error:
            raise RecordError(f"the record knows no object {name!r}: {self._objects()}") from error

    def force(self, part: str) -> np.ndarray:
        """(T,) force on one of `person_parts` [N].

        Raises:
            RecordError: there is no such part.
        """
        if part not in self.person_parts:
            raise RecordError(f"the person has no part {part!r}, but {', '.join(self.person_parts)}")
        return self.person_force[:, self.person_parts.index(part)]

    def _objects(self) -> str:
        try:
            with np.load(self.directory / TRUTH_FILE, allow_pickle=False) as stored:
                files = [name for name in stored.files if name.startswith(OBJECT)]
        except DAMAGED:
            files = []
        names = [name[len(OBJECT) :] for name in files if not name.endswith("_faces")]
        return f"there are {', '.join(names)}" if names else "there are none"


class Checks:
    """Collects what a judge looks at.

    Args:
        record: of the run.

    Attributes:
        record: of the run.
    """

    def __init__(self, record: RunRecord) -> None:
        self.record = record
        self._found = Findings()

    @property
    def numbers(self) -> dict[str, float]:
        """Name with unit -> value, found so far; more may be put in."""
        return self._found.numbers

    def that(self, holds: object, problem: str) -> None:
        """Note a problem unless something holds."""
        if not holds:
            self._found.problems.append(problem)

    def at_least(self, name: str, value: float, bound: float, unit: str) -> None:
        """Note a number, and a problem where it is below `bound` or no number."""
        self._number(name, value, unit)
        self.that(value >= bound, f"{name.replace('_', ' ')} is {value:.3g} {unit}, at least {bound:g} is asked for")

    def at_most(self, name: str, value: float, bound: float, unit: str) -> None:
        """Note a number, and a problem where it is above `bound` or no number."""
        self._number(name, value, unit)
        self.that(value <= bound, f"{name.replace('_', ' ')} is {value:.3g} {unit}, at most {bound:g} is allowed")

    def _number(self, name: str, value: float, unit: str) -> None:
        self.numbers[f"{name}_{unit}".replace("/", "_per_").rstrip("_").lower()] = float(value)

    def unharmed(self) -> None:
        """Nothing presses or pierces the person beyond the limits of DESIGN.md, and no arm is held at the end."""
        look_at_robot(self.record, self.record.rows, self._found)
        look_at_forces(self.record, self.record.rows, self._found)
        self.that((self.record.holds_arm[-1] < 0).all(), "the robot still holds an arm at the end")

    def arms_lie(self) -> None:
        """Both wrists end near the mattress."""
        look_at_wrists(self.record, self.record.rows, self._found)

    def judgement(self) -> Judgement:
        """What was found."""
        problems = tuple(self._found.problems)
        return Judgement(success=not problems, problems=problems, numbers=dict(self._found.numbers))
