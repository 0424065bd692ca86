"""The policy that ships finds the corner in states that were looked at before, and says how it came about."""

from __future__ import annotations

import numpy as np
import pytest
from caretree.learning.pregrasp.hung_state import hang
from caretree.learning.pregrasp.photograph import photograph
from caretree.perception.learned.pre_grasp_policy import PACKAGED, packaged_policy
from caretree.sim.pregrasp.affordance import best_action
from caretree.sim.pregrasp.policy import GRASPS


@pytest.mark.parametrize("seed", [300, 301, 302])
def test_it_goes_for_the_corner(seed: int) -> None:
    policy, state = packaged_policy(), hang(seed)
    views, corner = photograph(state), state.vertices[state.wanted]
    assert np.linalg.norm(policy.corner(views) - corner) < 0.05
    values = policy.values(views)
    best = best_action(values, views)
    assert np.linalg.norm(views.place(best.view, best.row, best.column) - corner) < 0.08
    assert 0.0 < policy.confidence(float(values.max())) < 1.0


def test_it_bears_its_record_and_is_small() -> None:
    record = packaged_policy().record
    assert {"data", "seed", "seconds", "machine", "made"} <= set(record)
    weights = PACKAGED.parent
    assert {path.name for path in weights.iterdir()} >= {PACKAGED.name, GRASPS}
    assert sum(path.stat().st_size for path in weights.iterdir()) < 8e6
