"""What is loaded before runs are forked."""

import gc
import importlib
import sys


def test_tasks_and_planners_are_loaded_and_shared_with_the_copies(monkeypatch):
    frozen = []
    monkeypatch.setattr(gc, "freeze", lambda: frozen.append(True))
    sys.modules.pop("caretree.trees.campaign.loaded", None)
    importlib.import_module("caretree.trees.campaign.loaded")
    assert frozen == [True]
    assert {"caretree.trees.tasks.dressing", "toppra"} <= set(sys.modules)
