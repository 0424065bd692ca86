"""The dressing world near one set of values."""

import numpy as np
import pytest
from caretree.learning.gap.dressing.loads import Predictions
from caretree.learning.gap.dressing.system import DressingSystem
from caretree.sim.record.recorded_stretch import read_stretch

from ....sim.record.recorded_lift import write_record
from ....sim.record.test_measured import ARMS


class Bent(Predictions):
    """A world whose load turns at the model as given: an arm that is lighter takes three times as much off."""

    def _found(self, stretch, effects, drag, key):
        mass = sum(e.parameters.get("mass", 0.0) for e in effects)
        out = np.zeros((len(stretch.robot.t), 6))
        out[:, 2] = mass * (1.0 if mass > 0.0 else 3.0)
        return out


@pytest.fixture
def system(tmp_path):
    system = DressingSystem([read_stretch(write_record(tmp_path, ARMS))], Bent(None))
    system.move_to(dict.fromkeys((p.name for e in system.effects for p in e.parameters), 0.0))
    return system


@pytest.mark.parametrize("mass", [-0.4, -0.1, 0.0, 0.2, 3.0])
def test_what_is_absent_may_have_either_sign(system, mass):
    predicted = system.predict({"window": np.zeros(5)}, {**dict.fromkeys(system.centre, 0.0), "mass": mass})
    assert np.allclose(predicted[:, 2], mass * (1.0 if mass > 0.0 else 3.0))


def test_where_it_was_found_one_side_says_enough(system):
    found = {**dict.fromkeys(system.centre, 0.0), "mass": -0.3}
    system.move_to(found)
    for mass in (-0.4, -0.3):
        assert np.allclose(system.predict({"window": np.zeros(5)}, {**found, "mass": mass})[:, 2], 3.0 * mass)
