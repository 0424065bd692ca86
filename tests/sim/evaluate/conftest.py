"""The outside judge, where this machine has it: the project is checked against it and does without it."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest

JUDGE = Path(__file__).parents[3] / ".." / "shared" / "judge" / "judge_run.py"


@pytest.fixture(scope="session")
def outside_judge():
    """The judge's module, or None."""
    if not JUDGE.exists():
        return None
    spec = importlib.util.spec_from_file_location("outside_judge", JUDGE)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def judge(outside_judge):
    """The judge's module, for tests that are about nothing else."""
    if outside_judge is None:
        pytest.skip(f"the outside judge is not at {JUDGE}")
    return outside_judge


@pytest.fixture
def damaged_record(make_record, tmp_path):
    """Write the good record with its arrays changed: `damaged_record(change)`."""

    def make(change):
        directory = make_record(tmp_path / "run")
        with np.load(directory / "truth.npz") as stored:
            arrays = {name: stored[name] for name in stored.files}
        change(arrays)
        np.savez(directory / "truth.npz", **arrays)
        return directory

    return make
