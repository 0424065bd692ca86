from pathlib import Path

import numpy as np
import pytest
import yaml
from caretree.learning.gap.joints.lag import at_lag, lagged

from ..solved import solved

LAG = 0.06


@pytest.fixture
def late_set(tmp_path):
    """An axis of 10 kg whose force is recorded 60 ms late."""

    def make() -> Path:
        t, listed = np.arange(0.0, 8.0, 0.01), []
        for k in range(3):
            rng = np.random.default_rng([5, k])
            w = 2.0 * np.pi * 0.4 * np.arange(1, 4)
            amplitude, phase = rng.normal(size=3) / np.arange(1, 4) * 0.1, rng.uniform(0, 6, 3)
            q, v = np.sin(np.outer(t, w) + phase) @ amplitude, np.cos(np.outer(t, w) + phase) @ (amplitude * w)
            force = -10.0 * np.sin(np.outer(t - LAG, w) + phase) @ (amplitude * w**2) + 0.05 * rng.normal(size=len(t))
            table = np.column_stack([t, q, v, force])
            np.savetxt(tmp_path / f"e{k}.csv", table, delimiter=",", header="t,q,dq,force", comments="")
            listed.append({"file": f"e{k}.csv", "role": "heldout" if k == 2 else "fit"})
        (tmp_path / "measurement.yaml").write_text(yaml.safe_dump({"system": "axis", "mass": 10.0, "episodes": listed}))
        return tmp_path

    return make


def test_a_long_delay_is_a_delay_alone_and_exact(late_set):
    study, verdict, effects, recalibration, _ = solved(late_set())
    assert verdict == "effects"
    assert [f.name for f in (*effects, *recalibration)] == ["delay"]
    value = effects[0].parameters[0]
    assert value.value == pytest.approx(LAG, abs=5e-4)
    assert value.low < LAG < value.high
    named = study.named
    assert named.blocks[0].about == pytest.approx(value.value, rel=0.01)
    assert lagged(named.search, named.chosen, study.fitted) is named.search


def test_its_column_is_the_change_of_the_load_over_the_lag(late_set):
    study = solved(late_set())[0]
    block = next(b for b in study.named.search.blocks if b.name == "delay")
    log = study.fitted[0]
    moved = at_lag(block, 0.03)
    assert at_lag(moved, 0.03) is moved
    change = 0.03 * moved.build(log)[:, 0, 0]
    later = np.interp(log.t + 0.03, log.t, log.measured[:, 0])
    wanted = log.shared(log.measured[:, 0] - later)
    middle = slice(20, -20)
    assert change[middle] == pytest.approx(wanted[middle], abs=0.02 * np.abs(wanted).max())
