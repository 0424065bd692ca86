"""An arm that does not stand or read as its model has it."""

import json

import pytest
from caretree.learning.gap.bench.placement_case import write_placement_case
from caretree.sim.effects.model_file import load_model, save_model

from ..solved import solved


@pytest.mark.parametrize(("seed", "name"), [(2004, "base_tilt"), (2012, "encoder_offset")])
def test_it_is_named_with_its_angles(tmp_path, seed, name):
    (hidden,) = write_placement_case(seed, tmp_path).effects
    study, verdict, effects, _, _ = solved(tmp_path)
    assert verdict == "effects"
    assert [(e.name, e.target) for e in effects] == [(name, hidden["target"])]
    for p in effects[0].parameters:
        assert p.low < hidden["values"][p.name] < p.high
        assert p.high - p.low < 0.1
    # what was found is a model file that can be read again
    save_model(tmp_path / "model.yaml", json.loads(json.dumps(study.patch())))
    (said,) = load_model(tmp_path / "model.yaml").effects
    assert said.parameters == pytest.approx({p.name: p.value for p in effects[0].parameters})


def test_nothing_of_it_is_named_where_nothing_is_missing(tmp_path):
    write_placement_case(2002, tmp_path)
    _, verdict, effects, recalibration, _ = solved(tmp_path)
    assert (verdict, effects, recalibration) == ("adequate", (), ())
