"""Many runs of one task with different seeds, and the success table of the paper over them.

The folder of a campaign holds one folder for each trial, so an interrupted campaign goes on where it was:

    DIR/overall/seed-0000 ...     the whole task; seed-0000.log beside it is what the run said
    DIR/overall/seed-0000.running who runs it now, and when it last gave a sign of life
    DIR/stage-dress/seed-0000 ... one stage alone, from a world prepared for it
    DIR/other-KEY                 trials of other sources or versions, which no longer count
    DIR/trials.json               everything counted so far
    DIR/trials.csv                the same, one row a trial
    DIR/table.txt                 the same to read

Campaigns with the same arguments may share a folder: each takes the trials that no other has.
"""

from __future__ import annotations

import contextlib
import json
import os
import threading
import time
from collections.abc import Callable, Generator, Iterator, Mapping
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from ...sim.errors import CaretreeError
from ...sim.record.spool import disk_error
from .rows_file import write_csv
from .running import others
from .success_rate import SuccessRate
from .trial import InterruptedTrialError, TakenTrialError, Trial, read_trial, run_trial
from .trials_table import OVERALL, STAGE, collect, rates, table, whole_runs

FILE, TABLE = "trials.json", "table.txt"
WAIT = 1.0  # [s] until a trial that another campaign runs is asked for again


@dataclass(frozen=True, kw_only=True)
class Plan:
    """What a campaign runs.

    Attributes:
        task: of every run.
        key: of all that decides how a trial goes (`campaign_key`); trials of another key do not count.
        seeds: one trial each.
        directory: of the campaign.
        stage: run this stage alone; None runs the whole task.
        arguments: further arguments of every `caretree run`.
        jobs: runs at the same time; None for one here, and as many as it has cores on a cluster.
        address: of a Ray cluster to run on; None for this machine.
        patience: wall time after which a run counts as stuck [s].

    Raises:
        CaretreeError: no seed, a seed twice or below 0, or no job.
    """

    task: str
    key: str = ""
    seeds: tuple[int, ...]
    directory: Path
    stage: str | None = None
    arguments: tuple[str, ...] = ()
    jobs: int | None = None
    address: str | None = None
    patience: float = 3600.0

    def __post_init__(self) -> None:
        """Reject plans that cannot run."""
        if not self.seeds or len(set(self.seeds)) != len(self.seeds) or min(self.seeds) < 0:
            raise CaretreeError(f"seeds are {list(self.seeds)}, but different numbers from 0 on are asked for")
        if self.jobs is not None and self.jobs < 1:
            raise CaretreeError(f"jobs is {self.jobs}, but at least 1 is asked for")

    @property
    def kind(self) -> str:
        """Folder of its trials: `overall` or `stage-dress`."""
        return OVERALL if self.stage is None else f"{STAGE}{self.stage}"

    def folder(self, seed: int) -> Path:
        """Where the record of one seed goes."""
        return self.directory / self.kind / f"seed-{seed:04d}"


def run_trials(plan: Plan, tell: Callable[[str], None]) -> list[Trial]:
    """Run what is missing; trials.json, trials.csv and table.txt follow every finished trial.

    Args:
        plan: what to run.
        tell: gets one line for each trial.

    Returns:
        The finished trials; one that somebody stopped or killed is missing.

    Raises:
        CaretreeError: the folder belongs to another campaign, a run refuses its input, or the disk is full.
        KeyboardInterrupt: the operator stopped it; finished trials are kept.
    """
    claimed = _claim(plan)
    done = {seed: trial for seed in plan.seeds if (trial := _finished(plan, seed)) is not None}
    if done:
        tell(f"{len(done)} of {len(plan.seeds)} trials are there already")
    stale = sum(
        trial is not None and trial.key != plan.key for trial in (read_trial(plan.folder(s)) for s in plan.seeds)
    )
    if stale:
        tell(f"{stale} trials are of other sources or versions: they are put aside and run again")
    missing = [seed for seed in plan.seeds if seed not in done]
    try:
        with contextlib.closing(_run_each(plan, missing, tell)) as each:
            for seed, trial in each:
                if isinstance(trial, Trial):
                    done[seed] = trial
                    tell(f"[{len(done)}/{len(plan.seeds)}] {trial.sentence()}")
                    write_table(plan.directory, plan.key)
                else:
                    tell(str(trial))
    except CaretreeError:
        if claimed and not done:
            (plan.directory / FILE).unlink(missing_ok=True)  # no run has begun: the folder is nobody's
        raise
    write_table(plan.directory, plan.key)
    return [done[seed] for seed in plan.seeds if seed in done]


def _finished(plan: Plan, seed: int) -> Trial | None:
    trial = read_trial(plan.folder(seed))
    return trial if trial is not None and trial.key == plan.key else None


def _run_each(
    plan: Plan, seeds: list[int], tell: Callable[[str], None]
) -> Generator[tuple[int, Trial | InterruptedTrialError], None, None]:
    """Each seed with its trial as it ends, or with why it counts for nothing; those of other campaigns come last."""
    left = list(seeds)
    while left:
        for seed, trial in _cluster(plan, left) if plan.address else _here(plan, left, tell):
            left.remove(seed)
            yield seed, trial
        if left:  # another campaign runs them, or has finished them meanwhile
            time.sleep(WAIT)
            finished = [(seed, trial) for seed in left if (trial := _finished(plan, seed)) is not None]
            left = [seed for seed in left if seed not in dict(finished)]
            yield from finished


def _arguments(plan: Plan) -> tuple[str, ...]:
    return plan.arguments if plan.stage is None else (*plan.arguments, "--stage", plan.stage)


def _cluster(plan: Plan, seeds: list[int]) -> Iterator[tuple[int, Trial | InterruptedTrialError]]:
    from .on_cluster import trials_on_cluster

    folders = {seed: plan.folder(seed) for seed in seeds}
    return trials_on_cluster(
        str(plan.address), plan.jobs, plan.task, _arguments(plan), folders, patience=plan.patience, key=plan.key
    )


def _here(
    plan: Plan, seeds: list[int], tell: Callable[[str], None]
) -> Iterator[tuple[int, Trial | InterruptedTrialError]]:
    """Trials as they end, in processes of this machine; those that another campaign runs are left out."""
    arguments, stop = _arguments(plan), threading.Event()
    with ThreadPoolExecutor(max_workers=plan.jobs or 1) as pool:
        running: dict[Future[Trial], int] = {}
        try:
            for seed in seeds:
                more: dict[str, Any] = {"patience": plan.patience, "stop": stop, "key": plan.key}
                running[pool.submit(run_trial, plan.task, seed, plan.folder(seed), arguments, **more)] = seed
            while running:
                # the timeout lets Ctrl-C through
                finished, _ = wait(running, timeout=0.5, return_when=FIRST_COMPLETED)
                for future in finished:
                    seed = running.pop(future)
                    try:
                        yield seed, future.result()
                    except TakenTrialError:
                        continue
                    except InterruptedTrialError as why:
                        yield seed, why
        except KeyboardInterrupt:
            with contextlib.suppress(OSError):  # the terminal may have gone
                tell("interrupted: the runs under way end in the safe stop first")
            raise
        finally:
            stop.set()
            for future in running:
                future.cancel()  # leaving the pool waits until every child is gone, in the safe stop


def _claim(plan: Plan) -> bool:
    """Make the folder this campaign's own; trials of another task or other arguments do not mix.

    Returns:
        Whether it was nobody's before.
    """
    mine: dict[str, Any] = {"task": plan.task, "arguments": list(plan.arguments)}
    path = plan.directory / FILE
    if path.exists():
        try:
            found = json.loads(path.read_text(encoding="utf-8"))
            theirs = {key: found[key] for key in mine}
        except (OSError, ValueError, KeyError, TypeError, RecursionError) as error:
            raise CaretreeError(f"{path} is damaged: move it away to go on ({error})") from error
        if theirs != mine:
            raise CaretreeError(
                f"{plan.directory} holds trials of {_call(theirs)}, not of {_call(mine)}; "
                "give another folder with --out"
            )
        if other := others(plan.directory, plan.key):
            raise CaretreeError(f"another campaign works in {plan.directory}: {other}; wait for it or give --out")
        return False
    if plan.directory.is_file():
        raise CaretreeError(f"{plan.directory} is a file, but a folder is asked for")
    try:
        plan.directory.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(mine | {"trials": {}}) + "\n", encoding="utf-8")
    except OSError as error:
        raise disk_error(error, f"writing {path}") from error
    return True


def _call(claim: dict[str, Any]) -> str:
    return " ".join(map(str, ["caretree run", claim["task"], *claim["arguments"]]))


def write_table(directory: Path, key: str) -> None:
    """Count what is finished under a key and write trials.json, trials.csv and table.txt.

    Raises:
        CaretreeError: the disk is full.
    """
    path = directory / FILE
    try:
        claim = json.loads(path.read_text(encoding="utf-8"))
        trials = collect(directory, key)
        claim["key"] = key
        claim["table"] = {row: _counted(of_row) for row, of_row in rates(trials).items()}
        claim["whole_runs"] = _counted(whole_runs(trials))
        claim["trials"] = {kind: [asdict(trial) for trial in many] for kind, many in trials.items()}
        part = path.with_name(f"{FILE}.{os.getpid()}.part")  # campaigns may share the folder
        part.write_text(json.dumps(claim, indent=1) + "\n", encoding="utf-8")
        part.replace(path)
        (directory / TABLE).write_text(table(trials), encoding="utf-8")
        write_csv(directory, trials)
    except OSError as error:
        raise disk_error(error, f"writing {path}") from error


def _counted(rates: Mapping[str, SuccessRate]) -> dict[str, Any]:
    return {
        name: {"successes": rate.successes, "trials": rate.trials, "interval": rate.interval()}
        for name, rate in rates.items()
    }
