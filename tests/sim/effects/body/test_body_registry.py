import numpy as np
import pytest
from caretree.sim.effects.body.body_registry import BODY_EFFECTS

VALUES = {"rate": 0.3, "coefficient": 0.02, "speed": 3.0, "fraction": 0.1, "value": 0.2, "time": 0.1}


@pytest.mark.parametrize("name", BODY_EFFECTS)
def test_ballast_leaves_the_airs_force_and_the_reading_as_they_are(name):
    effect = BODY_EFFECTS[name]
    values = {p.name: VALUES[p.name] for p in effect.parameters}
    velocity = np.array([0.0, 0.0, -7.0])
    heavy = effect.ballasted(values, 4.0)
    assert 4.0 * effect.specific_force(velocity, heavy, 9.81) == pytest.approx(
        effect.specific_force(velocity, values, 9.81)
    )
    assert effect.read(12.0, heavy) == effect.read(12.0, values)
    assert (heavy == values) == (not effect.of_air)
