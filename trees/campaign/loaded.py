"""Imported to load what runs need, before they are forked: tasks and their libraries."""

from __future__ import annotations

import gc
import importlib.util

from ..commands import run as run
from ..proof.check import rehearse
from ..report import page as page
from ..run.task import load_task, task_names

for _name in task_names():
    load_task(_name)
if importlib.util.find_spec("pinocchio"):  # which the core lacks, and the tasks that need no kinematics
    rehearse(load_task("wash_arm"))  # planners and compiled loops are loaded on first use
gc.freeze()  # what is never looked at again stays shared with the copies
