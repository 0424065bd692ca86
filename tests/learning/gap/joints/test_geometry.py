"""An arm that does not stand or read as its model has it."""

import json
from types import SimpleNamespace

import numpy as np
import pytest
from caretree.learning.gap.bench.placement_case import write_placement_case
from caretree.learning.gap.joints.arm_model import ArmModel
from caretree.learning.gap.joints.block import body_block
from caretree.learning.gap.joints.refine import exact_at
from caretree.learning.gap.joints.robot_files import find_urdf
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


def test_a_payload_hangs_from_a_tilted_base_too(tmp_path):
    arm = ArmModel.from_urdf(find_urdf("ur5", tmp_path), 6)
    q, dq, ddq = (np.random.default_rng(k).uniform(-1.0, 1.0, (8, 6)) for k in range(3))
    tilt, payload = arm.geometry_terms()[0], arm.payload
    heavy, stands = {"mass": 3.0, "mass_com_z": 0.2}, {"about_x": 0.08, "about_y": -0.03}
    numbers = np.array([heavy.get(p.name, 0.0) for p in payload.parameters])
    angles = np.array(list(stands.values()))
    loaded = arm.patched(payload, heavy).load(q, dq, ddq)
    whole = arm.patched(payload, heavy).patched(tilt, stands).load(q, dq, ddq) - loaded
    alone = exact_at(body_block(tilt, arm), angles, arm)
    beside = exact_at(body_block(tilt, arm), angles, arm, [(body_block(payload, arm), numbers)])
    log = SimpleNamespace(name="log", q=q, dq=dq, ddq=ddq, shared=lambda x, sharp=False: x)
    assert np.allclose(beside.build(log) @ angles, whole, atol=1e-6)
    assert np.abs(alone.build(log) @ angles - whole).max() > 0.1
    assert exact_at(beside, angles, arm, [(body_block(payload, arm), numbers)]) is beside


def test_nothing_of_it_is_named_where_nothing_is_missing(tmp_path):
    write_placement_case(2002, tmp_path)
    _, verdict, effects, recalibration, _ = solved(tmp_path)
    assert (verdict, effects, recalibration) == ("adequate", (), ())
