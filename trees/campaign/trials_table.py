"""The success table of the paper: each stage on its own, each stage within whole runs, and whole runs."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from .success_rate import SuccessRate
from .trial import Trial, read_trial

OVERALL = "overall"
STAGE = "stage-"


def collect(directory: Path, key: str) -> dict[str, list[Trial]]:
    """Every finished trial of one key in a folder, by kind (`overall`, `stage-dress` ...), in order of the seeds."""
    kinds = [directory / OVERALL, *sorted(directory.glob(f"{STAGE}*"))]
    found = {
        kind.name: [
            trial
            for folder in sorted(kind.glob("seed-*"))
            if (trial := read_trial(folder)) is not None and trial.key == key
        ]
        for kind in kinds
    }
    return {kind: trials for kind, trials in found.items() if trials}


def rates(trials: dict[str, list[Trial]]) -> dict[str, dict[str, SuccessRate]]:
    """The rows of the table: `independent` and `overall`, each by stage; `overall` also by the whole task.

    As in the paper, a stage's overall rate is over the trials that came to it.  Trials of a span of stages
    (`stage-dress-spread`) count for no stage; of a stage that no trial has recorded, the command line's name stands for
    the record's.
    """
    alone: dict[str, SuccessRate] = {}
    together: dict[str, SuccessRate] = {}
    single = {kind: many for kind, many in trials.items() if kind.startswith(STAGE) and "-" not in kind[len(STAGE) :]}
    recorded = {kind: _stages(many) or [kind[len(STAGE) :]] for kind, many in single.items()}
    everywhere = _stages(trial for many in trials.values() for trial in many)
    for name in dict.fromkeys([*everywhere, *(name for names in recorded.values() for name in names)]):
        own = [trial for kind, many in single.items() if name in recorded[kind] for trial in many]
        alone[name] = SuccessRate(successes=sum(trial.stages.get(name) == "success" for trial in own), trials=len(own))
        within = [trial.stages.get(name, "not_run") for trial in trials.get(OVERALL, [])]
        ran = [status for status in within if status != "not_run"]
        together[name] = SuccessRate(successes=ran.count("success"), trials=len(ran))
    whole = trials.get(OVERALL, [])
    together[OVERALL] = SuccessRate(successes=sum(trial.succeeded for trial in whole), trials=len(whole))
    return {"independent": alone, "overall": together}


def whole_runs(trials: dict[str, list[Trial]]) -> dict[str, SuccessRate]:
    """Runs of the whole task: dressed and unharmed, unharmed whether dressed or not, claimed, and wrongly claimed.

    A run of which nobody knows whether the person is unharmed (it crashed) counts as one that is not.  Rows of which no
    run tells anything are left out.
    """
    whole = trials.get(OVERALL, [])
    counts: dict[str, int] = {}
    if any(trial.unharmed is not None for trial in whole):
        counts["dressed and unharmed"] = sum(bool(trial.dressed and trial.unharmed) for trial in whole)
        counts["unharmed"] = sum(bool(trial.unharmed) for trial in whole)
    elif any(trial.dressed is not None for trial in whole):
        counts["dressed"] = sum(bool(trial.dressed) for trial in whole)
    elif any(trial.reached is not None for trial in whole):
        counts["goal reached"] = sum(bool(trial.reached) for trial in whole)
    counts["claimed"] = sum(trial.outcome == "success" for trial in whole)
    if any(trial.judged is not None for trial in whole):
        counts["wrongly claimed"] = sum(trial.outcome == "success" and trial.judged is False for trial in whole)
    return {name: SuccessRate(successes=count, trials=len(whole)) for name, count in counts.items()}


def _stages(trials: Iterable[Trial]) -> list[str]:
    """Names of the stages that these trials have recorded, in order."""
    return list(dict.fromkeys(name for trial in trials for name in trial.stages))


def table(trials: dict[str, list[Trial]]) -> str:
    """The table to read, with 95 % intervals."""
    rows = rates(trials)
    columns = list(rows["overall"])
    head = ["success rate", *columns]
    body = [[f"{row} trials", *(str(rows[row].get(column, "-")) for column in columns)] for row in rows]
    widths = [max(len(line[k]) for line in (head, *body)) for k in range(len(head))]
    lines = [
        "  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)).rstrip()
        for line in (head, *body)
    ]
    whole = trials.get(OVERALL, [])
    wrong = [trial.seed for trial in whole if trial.judged not in (None, trial.outcome == "success")]
    judged = any(trial.judged is not None for trial in whole)
    source = "by the evaluator, from the geometry alone" if judged else "as the tree says too"
    if whole:
        lines += ["", "whole runs", *(f"  {name}: {rate}" for name, rate in whole_runs(trials).items())]
    lines += ["", f"Stages as the tree says; overall {source}.  Brackets: 95 % Wilson intervals."]
    if wrong:
        lines.append(f"The tree and the evaluator disagree on seeds {', '.join(map(str, wrong))}.")
    for kind, many in trials.items():
        lines += [
            f"  {kind}: {trial.sentence(whole=kind == OVERALL)}"
            for trial in many
            if not (trial.succeeded if kind == OVERALL else trial.outcome == "success")
        ]
    return "\n".join(lines) + "\n"
