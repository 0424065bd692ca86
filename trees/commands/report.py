"""`caretree report`: the page of a record, drawn again, or for the first time where the run was cut short."""

from __future__ import annotations

import argparse
from pathlib import Path

from ...sim.errors import CaretreeError
from ...sim.record.folder_claim import FolderClaim
from ...sim.record.record import RUN_FILE, SPOOL_FOLDER, TRUTH_FILE, is_finished, read_run
from ...sim.record.spool import write_npz


def main(options: argparse.Namespace) -> int:
    """Write report.html; frames that a killed run left in its spool become truth.npz first.

    Raises:
        CaretreeError: the record is missing or damaged, a run is still writing it, or the disk is full.
    """
    directory = Path(options.directory)
    if not is_finished(read_run(directory)):
        claim = FolderClaim(directory)
        try:
            if (directory / SPOOL_FOLDER).is_dir() and not (directory / TRUTH_FILE).exists():
                write_npz(directory / SPOOL_FOLDER, directory / TRUTH_FILE)
        finally:
            claim.release()
    from ..report.page import write_report  # matplotlib is needed only here

    try:
        print(write_report(directory))
    except (TypeError, ValueError, AttributeError) as error:  # somebody's own run.json
        raise CaretreeError(f"{directory / RUN_FILE} is damaged: {error}") from error
    return 0
