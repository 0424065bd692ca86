import numpy as np
import pytest
from caretree.learning.physics.clips.parameters import (
    BASE,
    HIGH,
    LOW,
    NAMES,
    PARAMETERS,
    SHOWN,
    to_spec,
    to_unit,
    to_values,
    values_to_unit,
)
from caretree.sim.errors import CaretreeError
from caretree.sim.scene.gown import GOWNS, GownSpec
from caretree.sim.scene.gown_file import UNITS


def test_unit_and_gown_are_each_others_inverse():
    unit = np.random.default_rng(0).random(len(NAMES))
    np.testing.assert_allclose(to_unit(to_spec(unit, GOWNS["light"])), unit, atol=1e-12)


def test_ends_of_the_scale_are_the_ends_of_the_ranges():
    np.testing.assert_allclose(to_values(np.zeros(6)), LOW)
    np.testing.assert_allclose(to_values(np.ones(6)), HIGH)
    np.testing.assert_allclose(values_to_unit(np.array([LOW, HIGH])), [np.zeros(6), np.ones(6)], atol=1e-12)


def test_the_cut_is_kept():
    spec = to_spec(np.full(6, 0.5), GOWNS["large"])
    assert (spec.spacing, spec.length, spec.name) == (GOWNS["large"].spacing, GOWNS["large"].length, "large")


def test_ranges_keep_within_a_tenth_and_five_times_the_base():
    assert np.all(LOW >= BASE / 10 - 1e-12)
    assert np.all(HIGH <= 5 * BASE + 1e-12)
    assert set(NAMES) <= set(GownSpec.__dataclass_fields__)
    assert {p.name: p.unit for p in PARAMETERS} == UNITS  # a gown file speaks of the same six


def test_gowns_of_the_scene_lie_inside_the_ranges():
    for gown in GOWNS.values():
        values = np.array([getattr(gown, name) for name in NAMES])[:5]  # they say nothing of the air
        assert np.all((values > LOW[:5]) & (values < HIGH[:5]))


def test_what_the_clip_cannot_show_is_said():
    assert [PARAMETERS[k].name for k in range(6) if k not in SHOWN] == ["friction"]


def test_bad_values_are_refused():
    with pytest.raises(CaretreeError, match="above zero"):
        to_unit(GownSpec(name="vacuum", air_drag=0.0))
    with pytest.raises(CaretreeError, match="6 finite numbers"):
        to_spec(np.zeros(5), GOWNS["medium"])
    with pytest.raises(CaretreeError, match="6 finite numbers"):
        to_spec(np.full(6, np.nan), GOWNS["medium"])
