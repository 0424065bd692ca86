import numpy as np
import pytest
from caretree.sim.effects.effect import EffectError
from caretree.sim.effects.joint.arm_geometry import tilt_changes, tilted, tilts
from caretree.sim.effects.model_file import EffectEntry, check_effect

DOWN = np.array([0.0, 0.0, -9.81])


def test_a_base_that_leans_forward_feels_gravity_forward():
    # turned about y by a small angle, the base's x axis points down: gravity has a part along it
    assert np.allclose(tilted(DOWN, {"about_y": 0.1}), 9.81 * np.array([np.sin(0.1), 0.0, -np.cos(0.1)]))


def test_a_turn_about_gravity_is_not_asked_for():
    assert [p.name for p in tilts(DOWN)] == ["about_x", "about_y"]
    assert [p.name for p in tilts(np.array([0.0, 9.81, 0.0]))] == ["about_x", "about_z"]


def test_changes_at_a_turn_add_up_to_all_of_it():
    turn = {"about_x": 0.3, "about_y": -0.4}
    changes = tilt_changes(DOWN, list(turn), turn)
    whole = sum(turn[n] * c for n, c in zip(turn, changes, strict=True))
    assert np.allclose(whole, tilted(DOWN, turn) - DOWN, atol=1e-6)
    straight = sum(turn[n] * c for n, c in zip(turn, tilt_changes(DOWN, list(turn), {}), strict=True))
    assert np.abs(straight - tilted(DOWN, turn) + DOWN).max() > 0.5


@pytest.mark.parametrize(
    ("name", "values", "told"),
    [
        ("base_tilt", {"about_x": 0.9}, "outside"),
        ("base_tilt", {"angle": 0.1}, "it takes"),
        ("encoder_offset", {}, "it takes"),
    ],
)
def test_a_model_file_with_other_numbers_is_refused(name, values, told):
    with pytest.raises(EffectError, match=told):
        check_effect("arm", EffectEntry(name=name, target="base", parameters=values))


def test_an_axis_neither_stands_nor_turns():
    for name in ("base_tilt", "encoder_offset"):
        with pytest.raises(EffectError, match="does not exist for system axis"):
            check_effect("axis", EffectEntry(name=name, target="axis", parameters={}))
    with pytest.raises(EffectError, match="base_tilt"):
        check_effect("arm", EffectEntry(name="tilt", target="base", parameters={}))
