"""A demonstration from a dataset, carried out as a policy's choice is, comes to what the oracle saw."""

from __future__ import annotations

import numpy as np
import pytest
from caretree.learning.pregrasp.dataset import Dataset, load_dataset, make_dataset
from caretree.learning.pregrasp.hung_state import hang
from caretree.learning.pregrasp.oracle import attempt
from caretree.sim.pregrasp.affordance import best_action

EACH = 6  # attempts are repeated of those that succeeded and of those that failed


@pytest.fixture(scope="module")
def data(tmp_path_factory: pytest.TempPathFactory) -> Dataset:
    return load_dataset(make_dataset(tmp_path_factory.mktemp("data"), range(101, 102)))


@pytest.mark.parametrize("won", [True, False])
def test_the_way_of_the_policy_is_that_of_the_oracle(data: Dataset, won: bool) -> None:
    state, views = hang(int(data.seeds[0]), str(data.gowns[0])), data.views(0)
    rows = data.attempts[data.success == won][:EACH]
    assert len(rows) == EACH
    found = []
    for _, _, primitive, view, row, column, _, _ in rows.tolist():
        values = np.zeros((6, 3, *views.depth.shape[1:]), np.float32)
        values[view, primitive, row, column] = 1.0
        found.append(attempt(state, views, best_action(values, views)).success)
    assert found == [won] * EACH


def test_the_background_is_never_chosen(data: Dataset) -> None:
    views = data.views(0)
    values = np.where((views.depth > 0)[:, None], 0.0, 1.0) * np.ones((6, 3, 1, 1))
    action = best_action(values, views)
    assert views.depth[action.view, action.row, action.column] > 0
