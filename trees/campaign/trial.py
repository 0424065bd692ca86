"""One trial: a run in a process of its own, kept as a folder with a small trial.json once it is over."""

from __future__ import annotations

import itertools
import json
import os
import shutil
import signal
import subprocess
import sys
import threading
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

from ...sim.command_line import BAD_INPUT
from ...sim.errors import CaretreeError, RecordError
from ...sim.evaluate.verdict import evaluate
from ...sim.record.folder_claim import FolderClaim, FolderTakenError
from ...sim.record.record import is_finished, read_run
from ...sim.record.spool import disk_error
from ..run.judging import kept
from ..run.task import JUDGED
from .child import PARENT
from .forked import ForkedRun
from .running import Running

TRIAL_FILE = "trial.json"
ENDING = 60.0  # [s] of wall time for a child to make its person safe and to write its record, before it is killed
# Runs side by side share the processor: libraries that start a thread for each core would only be in each other's way.
ONE_THREAD: dict[str, str] = dict.fromkeys(
    ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS", "OPENCV_FOR_THREADS_NUM"), "1"
)
CARETREE = (sys.executable, "-m", "caretree.trees.campaign.child")
SCRIPTED = {("--world", "scripted")}
STALE = "other-"  # begins the names of folders for trials of other sources, versions or arguments
DEFECTS = ("SIGSEGV", "SIGABRT", "SIGBUS", "SIGFPE", "SIGILL", "SIGSYS", "SIGTRAP")  # the run's own doing


Child = subprocess.Popen[bytes] | ForkedRun


class InterruptedTrialError(Exception):
    """The trial was stopped before it was over; it counts for nothing and runs again next time."""


class TakenTrialError(Exception):
    """Another campaign runs this trial now."""


@dataclass(frozen=True, kw_only=True)
class Trial:
    """How one trial went.

    Attributes:
        seed: of the run.
        key: of the campaign it was run for (`campaign_key`).
        outcome: `success`, `failure` or `safe_stop` as the tree said; `crash` or `timeout` if it said nothing.
        reason: one sentence.
        dressed: what the evaluator found in the geometry; None where there is none or the task dresses nobody.
        unharmed: the same, dressed or not; None where the record does not tell.
        reached: what the task's own judge found in the truth; None where it has none.
        problems: of the evaluator.
        numbers: of the evaluator.
        stages: stage name -> status, as the tree said, in order.
        sim_time_s: simulated time [s].
        wall_time_s: wall time [s].
    """

    seed: int
    key: str = ""
    outcome: str
    reason: str
    dressed: bool | None = None
    unharmed: bool | None = None
    reached: bool | None = None
    problems: tuple[str, ...] = ()
    numbers: Mapping[str, float] = field(default_factory=dict)
    stages: Mapping[str, str] = field(default_factory=dict)
    sim_time_s: float | None = None
    wall_time_s: float | None = None

    @property
    def succeeded(self) -> bool:
        """By the truth, or by the tree's word where nothing was judged."""
        return self.outcome == "success" if self.judged is None else self.judged

    @property
    def judged(self) -> bool | None:
        """What the truth says: of the task's own judge, else whether the person is dressed; None where it is silent."""
        return self.dressed if self.reached is None else self.reached

    def sentence(self, *, whole: bool = True) -> str:
        """How it went in one line; one stage alone cannot be dressed, so `whole=False` leaves the verdict out."""
        told = self.outcome.replace("_", " ")
        if whole and self.dressed is not None:
            harm = {None: "", True: ", unharmed", False: ", HARMED"}[self.unharmed]
            word = "dressed" if self.dressed else "not dressed"
            told = word + harm + ("" if self._believed() else f" (tree: {told})")
        elif whole and self.reached is not None:
            told = ("goal reached" if self.reached else "goal not reached") + (
                "" if self._believed() else f" (tree: {told})"
            )
        why = self.reason if self.outcome != "success" else "; ".join(self.problems[:2]) if whole else ""
        took = ""
        if self.sim_time_s is not None and self.wall_time_s is not None:
            took = f" ({self.sim_time_s:.0f} s simulated in {self.wall_time_s:.0f} s)"
        return f"seed {self.seed} {told}{took}{f': {why}' if why else ''}"

    def _believed(self) -> bool:
        """Whether the tree said what the evaluator found."""
        return self.judged == (self.outcome == "success")


def read_trial(directory: Path) -> Trial | None:
    """The finished trial in `directory`, or None if it has to run (again)."""
    try:
        stored = json.loads((directory / TRIAL_FILE).read_text(encoding="utf-8"))
        return Trial(**(stored | {"problems": tuple(stored["problems"])}))
    except (OSError, ValueError, TypeError, KeyError):
        return None


def _keep(directory: Path, trial: Trial, key: str) -> Trial:
    trial = replace(trial, key=key)
    part = directory / f"{TRIAL_FILE}.part"
    try:
        part.write_text(json.dumps(asdict(trial), indent=1) + "\n", encoding="utf-8")
        part.replace(directory / TRIAL_FILE)
    except OSError as error:
        raise disk_error(error, f"writing {directory / TRIAL_FILE}") from error
    return trial


def judge_run(directory: Path, seed: int) -> Trial:
    """Read a finished run and evaluate it.

    Raises:
        RecordError: there is no finished run, or it was stopped from outside, which says nothing of the task.
    """
    run: dict[str, Any] = read_run(directory)
    if not is_finished(run) or run.get("stopped_from_outside"):
        raise RecordError(f"{directory} holds no finished run")
    stages = {str(stage["name"]): str(stage["status"]) for stage in run.get("stages", ())}
    told = Trial(
        seed=seed,
        outcome=run["outcome"],
        reason=str(run.get("reason") or ""),
        stages=stages,
        sim_time_s=run.get("sim_time_s"),
        wall_time_s=run.get("wall_time_s"),
    )
    if (judgement := kept(run)) is not None:
        numbers = dict(judgement.numbers)
        return replace(told, reached=judgement.success, problems=judgement.problems, numbers=numbers)
    if run.get("world") != "bullet" or Path(str(run.get("task"))).stem not in JUDGED:  # no truth, or nobody to dress
        return told
    try:
        verdict = evaluate(directory)
    except RecordError as error:  # a run that cannot be judged has not dressed anybody
        return replace(told, dressed=False, problems=(str(error),))
    return replace(
        told,
        dressed=verdict.dressed,
        unharmed=verdict.unharmed,
        problems=verdict.problems,
        numbers=dict(verdict.numbers),
    )


def run_trial(
    task: str,
    seed: int,
    directory: Path,
    arguments: tuple[str, ...],
    *,
    patience: float,
    stop: threading.Event,
    key: str = "",
) -> Trial:
    """Run one seed in a process of its own, or finish judging a run that is already there.

    Args:
        task: of the run.
        seed: of the run.
        directory: of its record; the child's output goes to a file of that name with `.log` beside it.
        arguments: further arguments of `caretree run`.
        patience: wall time after which a run counts as stuck [s].
        stop: ends the run when set.
        key: of the campaign.

    Raises:
        CaretreeError: the child says that its input is bad, or the disk is full.
        InterruptedTrialError: `stop` was set, or somebody stopped or killed the run.
        TakenTrialError: another campaign runs this trial.
    """
    running = Running(directory, key)
    try:
        if not running.mine:
            raise TakenTrialError
        if (finished := read_trial(directory)) is not None and finished.key == key:
            return finished  # by another campaign, a moment ago
        return _run(task, seed, directory, arguments, patience, stop, running, key)
    finally:
        running.release()


def _run(
    task: str,
    seed: int,
    directory: Path,
    arguments: tuple[str, ...],
    patience: float,
    stop: threading.Event,
    running: Running,
    key: str,
) -> Trial:
    begun = directory.with_name(f"{directory.name}.key")  # whose record it is, until it has been judged
    try:
        if begun.read_text(encoding="utf-8") == key and not (directory / TRIAL_FILE).exists():
            return _keep(directory, judge_run(directory, seed), key)
    except (OSError, ValueError, RecordError):
        pass
    put_aside(directory)
    directory.mkdir(parents=True)
    begun.write_text(key, encoding="utf-8")
    log = directory.with_name(f"{directory.name}.log")
    child = _started(("run", task, "--seed", str(seed), "--out", str(directory), *arguments), log)
    status = _wait(child, patience, stop, running)
    last = _last_line(log)
    why = _stopped(directory)
    if status == BAD_INPUT and why:
        raise CaretreeError(f"the run in {directory} was stopped: {why}")
    if status == BAD_INPUT:
        raise CaretreeError(last or f"`caretree run {task}` refused its input without a word; see {log}")
    if status is not None and (killed := why or _killed(status)):
        raise InterruptedTrialError(f"seed {seed} was stopped and counts for nothing: {killed}")
    try:
        return _keep(directory, judge_run(directory, seed), key)
    except RecordError:
        if status is None:
            return _keep(directory, Trial(seed=seed, outcome="timeout", reason=f"no end within {patience:g} s"), key)
        return _keep(directory, Trial(seed=seed, outcome="crash", reason=f"exit status {status}: {last}"), key)


def _started(arguments: Sequence[str], log: Path) -> Child:
    """`caretree` with these arguments, in a process of its own: forked where loading would take longer than the run."""
    if set(itertools.pairwise(arguments)) >= SCRIPTED:
        return ForkedRun(arguments, log, ONE_THREAD)
    with log.open("wb") as output:
        # a session of its own: the terminal's Ctrl-C reaches only us, and an interrupted run does not count as failed
        return subprocess.Popen(
            [*CARETREE, *arguments],
            stdout=output,
            stderr=subprocess.STDOUT,
            start_new_session=True,
            env=os.environ | ONE_THREAD | {PARENT: str(os.getpid())},
        )


def _killed(status: int) -> str:
    """The signal by which somebody ended the child; empty where it ended by its own doing."""
    name = signal.Signals(-status).name if status < 0 else ""
    return "" if name in DEFECTS else name


def put_aside(directory: Path) -> None:
    """Remove what an earlier run left, unless it still goes on; a finished trial of another key is kept elsewhere.

    Raises:
        FolderTakenError: it does.
    """
    finished = False
    try:
        FolderClaim(directory).release()
    except FolderTakenError as taken:
        try:
            finished = is_finished(read_run(directory))
        except RecordError:
            raise taken from None  # at its very beginning
        if not finished:
            raise
    except RecordError:  # damaged: the more reason to begin anew
        pass
    old = read_trial(directory)
    if old is not None or (finished and not _stopped(directory)):
        aside = directory.parents[1] / f"{STALE}{(old and old.key) or 'earlier'}" / directory.parent.name
        aside.mkdir(parents=True, exist_ok=True)
        shutil.rmtree(aside / directory.name, ignore_errors=True)
        directory.rename(aside / directory.name)
    shutil.rmtree(directory, ignore_errors=True)


def _stopped(directory: Path) -> str:
    """Why the run was stopped from outside; empty when it was not."""
    try:
        run = read_run(directory)
    except RecordError:
        return ""
    return str(run.get("reason")) if run.get("stopped_from_outside") else ""


def _wait(child: Child, patience: float, stop: threading.Event, running: Running) -> int | None:
    """Exit status of the child, or None when it was ended for taking too long."""
    waited = 0.0
    try:
        while waited < patience:
            try:
                return child.wait(timeout=0.2)
            except subprocess.TimeoutExpired:
                waited += 0.2
            running.beat()
            if stop.is_set():
                raise InterruptedTrialError
        return None
    finally:
        if child.poll() is None:
            child.terminate()  # it ends in the safe stop
            try:
                child.wait(timeout=ENDING)
            except subprocess.TimeoutExpired:
                child.kill()
                child.wait()


def _last_line(log: Path) -> str:
    lines = [line for line in log.read_text(encoding="utf-8", errors="replace").splitlines() if line.strip()]
    return lines[-1].strip().removeprefix("caretree: ") if lines else ""
