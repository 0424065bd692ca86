import json

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="PyTorch is an extra: pip install 'caretree[learn]'")
from caretree.learning.physics.networks.training import Budget, Objective, fit
from caretree.sim.errors import CaretreeError


class Line(Objective):
    """A straight line; stops by an error at step `stop`, as an interruption would."""

    def __init__(self, stop=None):
        torch.manual_seed(4)
        self.network = torch.nn.Linear(1, 1)
        self.stop, self.steps = stop, 0

    def loss(self, rng):
        if self.steps == self.stop:
            raise KeyboardInterrupt
        self.steps += 1
        x = torch.from_numpy(rng.normal(size=(8, 1))).float()
        return ((self.network(x) - 3 * x + 1) ** 2).mean()


BUDGET = Budget(steps=40, learning_rate=0.05, save_every=10)


def test_interrupted_and_resumed_is_as_if_never_interrupted(tmp_path):
    whole = Line()
    record = fit(whole, BUDGET, seed=1, folder=tmp_path / "whole", about={"data": "abc"})
    with pytest.raises(KeyboardInterrupt):
        fit(Line(stop=25), BUDGET, seed=1, folder=tmp_path / "parts", about={"data": "abc"})
    rest = Line()
    resumed = fit(rest, BUDGET, seed=1, folder=tmp_path / "parts", about={"data": "abc"})
    assert rest.steps == 20  # from the last checkpoint, at 20
    torch.testing.assert_close(rest.network.weight, whole.network.weight, rtol=0, atol=0)
    assert resumed["losses"] == record["losses"]


def test_a_finished_training_is_taken_as_it_is(tmp_path):
    first, again = Line(), Line(stop=0)
    fit(first, BUDGET, seed=1, folder=tmp_path, about={})
    fit(again, BUDGET, seed=1, folder=tmp_path, about={})
    torch.testing.assert_close(again.network.weight, first.network.weight, rtol=0, atol=0)


@pytest.mark.parametrize("change", [{"about": {"data": "other"}}, {"seed": 2}])
def test_other_data_or_seed_is_refused(tmp_path, change):
    fit(Line(), BUDGET, **{"seed": 1, "folder": tmp_path, "about": {"data": "abc"}})
    with pytest.raises(CaretreeError, match="other settings or data"):
        fit(Line(), BUDGET, **{"seed": 1, "folder": tmp_path, "about": {"data": "abc"}, **change})


def test_record_says_data_seed_time_and_machine(tmp_path):
    fit(Line(), BUDGET, seed=7, folder=tmp_path, about={"method": "line", "data": "abc"})
    record = json.loads((tmp_path / "record.json").read_text())
    assert (record["seed"], record["data"], record["steps"], record["method"]) == (7, "abc", 40, "line")
    assert record["processor_seconds"] >= 0
    assert {"processor", "cores", "torch"} <= set(record["machine"])
    assert np.isfinite(record["losses"]).all()


def test_budget_must_be_positive():
    with pytest.raises(CaretreeError, match="positive"):
        Budget(steps=0)
