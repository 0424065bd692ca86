import numpy as np
import pytest
from caretree.learning.gap.bench.joint_case import LEAST, write_joint_case
from caretree.learning.gap.bench.joint_loads import OUTSIDE, Trace, shape_of
from caretree.sim.effects.joint.joint_registry import JOINT_EFFECTS


def test_nothing_is_hidden_that_is_too_small_to_matter(tmp_path):
    for seed in (255, 267, 305):
        truth = write_joint_case("axis", seed, tmp_path)
        assert all(e["size"] >= LEAST or e["name"] in ("mass", *OUTSIDE) for e in truth.effects)


def test_no_more_tool_is_missing_than_there_is(tmp_path):
    truth = write_joint_case("arm", 606, tmp_path)  # wanted is seven times the noise, the whole tool weighs less
    tool = next(e for e in truth.effects if e["name"] == "wrong_tool")
    assert LEAST <= tool["size"] < 3.0
    assert np.isfinite(tool["size"])


@pytest.mark.parametrize("seed", [4010, 4068, 4080])  # joints that carry next to nothing
def test_nothing_is_hidden_that_no_joint_can_have(tmp_path, seed):
    truth = write_joint_case("arm", seed, tmp_path)
    for e in truth.effects:
        bounds = {p.name: p for p in JOINT_EFFECTS[e["name"]].linear} if e["name"] in JOINT_EFFECTS else {}
        assert all(bounds[n].lower <= v <= bounds[n].upper for n, v in e["values"].items() if n in bounds)


def test_what_is_hidden_has_the_numbers_the_registry_gives_it(tmp_path):
    file = {103: "mass", 141: "spring", 181: "backlash"}
    for seed, name in file.items():
        truth = write_joint_case("axis", seed, tmp_path)
        values = next(e["values"] for e in truth.effects if e["name"] == name)
        wanted = {"mass": {"mass"}, "spring": {"stiffness", "preload"}, "backlash": {"fraction", "width"}}[name]
        assert set(values) == wanted
        assert all(np.isfinite(v) for v in values.values())


def test_play_opens_where_a_joint_turns_and_not_where_it_rests():
    t = np.arange(0.0, 6.0, 0.01)
    v = np.where(t < 2.0, 1.0, np.where(t < 3.0, 1e-15 * (-1.0) ** np.arange(len(t)), np.where(t < 4.0, 1.0, -1.0)))
    trace = Trace(t=t, q=np.cumsum(v) * 0.01, v=v, a=0.0 * t, u=np.ones_like(t))
    load = shape_of("backlash", [trace], np.random.default_rng(0)).load[0]
    assert not load[t < 3.99].any()
    assert load[(t > 4.0) & (t < 4.005)].all()
