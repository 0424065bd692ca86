"""Imported to load what runs need, before they are forked: tasks, their libraries, and the fonts of the report."""

from __future__ import annotations

import gc

from ..commands import run as run
from ..proof.check import rehearse
from ..report import page as page
from ..report.figures import timeline
from ..run.task import load_task, task_names

for _name in task_names():
    load_task(_name)
timeline((), (), 1.0)
rehearse(load_task("wash_arm"))  # planners and compiled loops are loaded on first use
gc.freeze()  # what is never looked at again stays shared with the copies
