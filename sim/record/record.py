"""The folder of one run on disk: run.json, and the sentences said when it is missing, damaged or unfinished."""

from __future__ import annotations

import json
import os
import platform
import sys
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from importlib import metadata
from pathlib import Path
from typing import Any, Literal, get_args

from ..errors import RecordError
from .spool import disk_error

Outcome = Literal["success", "failure", "safe_stop"]
OUTCOMES: tuple[str, ...] = get_args(Outcome)
RUN_FILE, TRACE_FILE, TRUTH_FILE, VIDEO_FILE, REPORT_FILE = (
    "run.json",
    "trace.jsonl",
    "truth.npz",
    "video.mp4",
    "report.html",
)
TREE_FILE = "tree.json"  # the tree that ran, its nodes as rows
LOOKS_FOLDER = "looks"  # what the cameras saw before each failure
SPOOL_FOLDER = "truth.spool"
LOG_FILE = "log.mcap"  # what the robot measured, saw and was sent, where the run was asked for it
MEASURED_FILE = "measured.npz"  # what the robot measured: hands, their loads, arms as tracked
ERRORS_FILE = "errors.log"  # tracebacks of errors in the program or in a task file
RESERVE_FILE = "reserve"  # there only while the run goes on
VERSIONED = (
    "caretree",
    "numpy",
    "scipy",
    "pybullet",
    "py_trees",
    "pin",
    "toppra",
    "opencv-python-headless",
    "filterpy",
)


@dataclass(frozen=True, kw_only=True)
class StageResult:
    """How one stage of the tree went.

    Attributes:
        name: what the operator reads.
        status: `success`, `failure`, `running` (stopped in it) or `not_run`.
        attempts: how often it was started.
        t_start, t_end: world clock [s]; None where it never started or ended.
        reason: why it failed, one sentence; empty where it did not.
    """

    name: str
    status: Literal["success", "failure", "running", "not_run"]
    attempts: int = 0
    t_start: float | None = None
    t_end: float | None = None
    reason: str = ""


@dataclass(frozen=True, kw_only=True)
class RunResult:
    """What the tree says of its own run.  The evaluator never believes it.

    Attributes:
        outcome: one of `OUTCOMES`.
        reason: one sentence for the operator.
        stages: in the order of the task.
        sim_time_s: world clock at the end [s].
        timing: name of a part -> wall time spent in it [s].
        processor_timing: name of a part -> processor time spent in it [s].
        trace_hash: of the trace, when the runner keeps its own; else the recorder's.
        stopped_from_outside: by the operator, a signal, or the loss of record or display: it says nothing of the task.
    """

    outcome: Outcome
    reason: str
    stages: tuple[StageResult, ...] = ()
    sim_time_s: float
    timing: Mapping[str, float] = field(default_factory=dict)
    processor_timing: Mapping[str, float] = field(default_factory=dict)
    trace_hash: str | None = None
    stopped_from_outside: bool = False

    def __post_init__(self) -> None:
        """Reject an unknown outcome."""
        if self.outcome not in OUTCOMES:
            raise RecordError(f"outcome is {self.outcome!r}, but one of {', '.join(OUTCOMES)} is asked for")

    def fields(self) -> dict[str, Any]:
        """The entries of run.json that this result decides."""
        return {
            "outcome": self.outcome,
            "reason": self.reason,
            "stopped_from_outside": self.stopped_from_outside,
            "stages": [asdict(stage) for stage in self.stages],
            "sim_time_s": round(float(self.sim_time_s), 6),
            "timing": {part: round(float(seconds), 3) for part, seconds in self.timing.items()},
            "processor_timing": {part: round(float(seconds), 3) for part, seconds in self.processor_timing.items()},
        }


def versions() -> dict[str, str]:
    """Version of Python and of each package whose numbers shape a run; `not installed` where missing."""
    found = {"python": platform.python_version()}
    for name in VERSIONED:
        try:
            found[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            found[name] = "not installed"
    return found


def peak_memory() -> float | None:
    """Most memory this process ever held [MB]; None where the system does not say."""
    try:
        import resource
    except ImportError:  # not on Windows
        return None
    unit = 1 if sys.platform == "darwin" else 1024  # [bytes] what the system counts in
    return round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit / 1e6, 1)


def write_run(directory: Path, run: Mapping[str, Any]) -> None:
    """Replace `directory`/run.json in one step, so that a reader never meets half a file.

    Raises:
        RecordError: the disk is full or the folder cannot be written.
    """
    part = directory / f"{RUN_FILE}.part"
    try:
        part.write_text(json.dumps(run, indent=1, default=_plain) + "\n", encoding="utf-8")
        os.replace(part, directory / RUN_FILE)
    except OSError as error:
        part.unlink(missing_ok=True)
        raise disk_error(error, f"writing {directory / RUN_FILE}") from error


def _plain(value: object) -> object:
    """JSON form of numpy values, paths and dataclass-like oddities."""
    for attribute in ("tolist", "item"):
        if hasattr(value, attribute):
            return getattr(value, attribute)()
    return str(value)


def read_run(directory: Path) -> dict[str, Any]:
    """run.json of a record, finished or not.

    Raises:
        RecordError: the folder or file is missing or damaged.
    """
    path = directory / RUN_FILE
    if not directory.is_dir():
        raise RecordError(f"{directory} is not a folder with a run record")
    try:
        run = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError as error:
        raise RecordError(f"{directory} holds no {RUN_FILE}: it is not a run record") from error
    except OSError as error:
        raise RecordError(f"{path} cannot be read: {error.strerror or error}") from error
    except (ValueError, RecursionError) as error:
        raise RecordError(f"{path} is damaged: {error}") from error
    if not isinstance(run, dict):
        raise RecordError(f"{path} holds a {type(run).__name__}, but an object with task and outcome is asked for")
    return run


def is_finished(run: Mapping[str, Any]) -> bool:
    """Whether the run came to an outcome, good or bad."""
    return run.get("outcome") in OUTCOMES


def read_finished_run(directory: Path) -> dict[str, Any]:
    """run.json of a run that came to an outcome.

    Raises:
        RecordError: the record is missing, damaged, or the run was cut short.
    """
    run = read_run(directory)
    if not is_finished(run):
        if run.get("outcome") is not None:
            raise RecordError(
                f"{directory / RUN_FILE} has outcome {run['outcome']!r}, but one of {', '.join(OUTCOMES)} is asked for"
            )
        raise RecordError(f"{directory} was cut short: the run ended without an outcome; run it again")
    return run
