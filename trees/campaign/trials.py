"""Many runs of one task with different seeds, and the success table of the paper over them.

The folder of a campaign holds one folder for each trial, so an interrupted campaign goes on where it was:

    DIR/overall/seed-0000 ...     the whole task
    DIR/stage-dress/seed-0000 ... one stage alone, from a world prepared for it
    DIR/trials.json               everything counted so far
    DIR/table.txt                 the same to read
"""

from __future__ import annotations

import contextlib
import json
import threading
from collections.abc import Callable, Mapping
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from ...sim.errors import CaretreeError
from ...sim.record.spool import disk_error
from .success_rate import SuccessRate
from .trial import Trial, read_trial, run_trial
from .trials_table import OVERALL, STAGE, collect, rates, table, whole_runs

FILE, TABLE = "trials.json", "table.txt"


@dataclass(frozen=True, kw_only=True)
class Plan:
    """What a campaign runs.

    Attributes:
        task: of every run.
        seeds: one trial each.
        directory: of the campaign.
        stage: run this stage alone; None runs the whole task.
        arguments: further arguments of every `caretree run`.
        jobs: runs at the same time.
        patience: wall time after which a run counts as stuck [s].

    Raises:
        CaretreeError: no seed, a seed twice or below 0, or no job.
    """

    task: str
    seeds: tuple[int, ...]
    directory: Path
    stage: str | None = None
    arguments: tuple[str, ...] = ()
    jobs: int = 1
    patience: float = 3600.0

    def __post_init__(self) -> None:
        """Reject plans that cannot run."""
        if not self.seeds or len(set(self.seeds)) != len(self.seeds) or min(self.seeds) < 0:
            raise CaretreeError(f"seeds are {list(self.seeds)}, but different numbers from 0 on are asked for")
        if self.jobs < 1:
            raise CaretreeError(f"--jobs is {self.jobs}, but at least 1 is asked for")

    @property
    def kind(self) -> str:
        """Folder of its trials: `overall` or `stage-dress`."""
        return OVERALL if self.stage is None else f"{STAGE}{self.stage}"

    def folder(self, seed: int) -> Path:
        """Where the record of one seed goes."""
        return self.directory / self.kind / f"seed-{seed:04d}"


def run_trials(plan: Plan, tell: Callable[[str], None]) -> list[Trial]:
    """Run what is missing; trials.json and table.txt follow every finished trial.

    Args:
        plan: what to run.
        tell: gets one line for each trial.

    Raises:
        CaretreeError: the folder belongs to another campaign, a run refuses its input or was stopped, or the disk is
            full.
        KeyboardInterrupt: the operator stopped it; finished trials are kept.
    """
    _claim(plan)
    done = {seed: trial for seed in plan.seeds if (trial := read_trial(plan.folder(seed))) is not None}
    missing = [seed for seed in plan.seeds if seed not in done]
    if done:
        tell(f"{len(done)} of {len(plan.seeds)} trials are there already")
    stop = threading.Event()
    arguments = plan.arguments if plan.stage is None else (*plan.arguments, "--stage", plan.stage)
    with ThreadPoolExecutor(max_workers=plan.jobs) as pool:
        running: set[Future[Trial]] = {
            pool.submit(run_trial, plan.task, seed, plan.folder(seed), arguments, patience=plan.patience, stop=stop)
            for seed in missing
        }
        try:
            while running:
                # the timeout lets Ctrl-C through
                finished, running = wait(running, timeout=0.5, return_when=FIRST_COMPLETED)
                for trial in [future.result() for future in finished]:
                    done[trial.seed] = trial
                    tell(f"[{len(done)}/{len(plan.seeds)}] {trial.sentence()}")
                    write_table(plan.directory)
        except BaseException as error:
            stop.set()
            for future in running:
                future.cancel()
            if running and isinstance(error, KeyboardInterrupt):
                with contextlib.suppress(OSError):  # the terminal may have gone
                    tell("interrupted: the runs under way end in the safe stop first")
            raise  # leaving the pool waits until every child is gone
    write_table(plan.directory)
    return [done[seed] for seed in plan.seeds]


def _claim(plan: Plan) -> None:
    """Make the folder this campaign's own; trials of another task or other arguments do not mix."""
    mine: dict[str, Any] = {"task": plan.task, "arguments": list(plan.arguments)}
    path = plan.directory / FILE
    if path.exists():
        try:
            found = json.loads(path.read_text(encoding="utf-8"))
            theirs = {key: found[key] for key in mine}
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise CaretreeError(f"{path} is damaged: move it away to go on ({error})") from error
        if theirs != mine:
            raise CaretreeError(
                f"{plan.directory} holds trials of {_call(theirs)}, not of {_call(mine)}; "
                "give another folder with --out"
            )
        return
    try:
        plan.directory.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(mine | {"trials": {}}) + "\n", encoding="utf-8")
    except OSError as error:
        raise disk_error(error, f"writing {path}") from error


def _call(claim: dict[str, Any]) -> str:
    return " ".join(["caretree run", claim["task"], *claim["arguments"]])


def write_table(directory: Path) -> None:
    """Count what is finished and write trials.json and table.txt.

    Raises:
        CaretreeError: the disk is full.
    """
    path = directory / FILE
    try:
        claim = json.loads(path.read_text(encoding="utf-8"))
        trials = collect(directory)
        claim["table"] = {row: _counted(of_row) for row, of_row in rates(trials).items()}
        claim["whole_runs"] = _counted(whole_runs(trials))
        claim["trials"] = {kind: [asdict(trial) for trial in many] for kind, many in trials.items()}
        part = path.with_name(f"{FILE}.part")
        part.write_text(json.dumps(claim, indent=1) + "\n", encoding="utf-8")
        part.replace(path)
        (directory / TABLE).write_text(table(trials), encoding="utf-8")
    except OSError as error:
        raise disk_error(error, f"writing {path}") from error


def _counted(rates: Mapping[str, SuccessRate]) -> dict[str, Any]:
    return {
        name: {"successes": rate.successes, "trials": rate.trials, "interval": rate.interval()}
        for name, rate in rates.items()
    }
