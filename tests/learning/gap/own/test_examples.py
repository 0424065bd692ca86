"""The examples of docs/own-simulator: each hides an effect, finds it, names it and closes the gap."""

import pytest
from caretree.learning.gap.notebook import run

from .recorded import EXAMPLES, example, tables

CASES = [
    ("base", {"skid": 0.05, "d_left": -0.001}, {"sideways_slip", "left_radius"}),
    ("base", {"lag": 0.08}, {"motor_lag"}),
    ("gripper", {"gap": 1.5e-3}, {"backlash"}),
    ("gripper", {"gap": 1e-3, "shift": 5e-4}, {"backlash", "offset"}),
    ("pendulum", {"hinge_armature": 0.01}, {"armature"}),
    ("arm", {"elbow_friction": 0.3, "mass": 0.1}, {"dry_friction", "payload"}),
]


@pytest.mark.parametrize("file", sorted(EXAMPLES.glob("*.py")), ids=lambda f: f.name)
def test_a_user_writes_at_most_sixty_lines(file):
    assert len(file.read_text().splitlines()) <= 60


@pytest.mark.parametrize(("name", "hidden", "names"), CASES, ids=[f"{n}: {', '.join(h)}" for n, h, _ in CASES])
def test_the_hidden_effect_is_found_and_the_held_out_gap_shrinks(name, hidden, names):
    if name in ("pendulum", "arm"):
        pytest.importorskip("mujoco", reason="the extra `mujoco` is not installed")
    system = example(name)
    *fit, held = tables(system, hidden)
    result = run(system, fit=fit, heldout=[held])
    v = result.verdict
    found = {f.name: f for f in (*v.effects, *v.recalibration)}
    assert set(found) == names
    assert v.gap.after < 1.2 * v.gap.floor
    assert v.gap.after < 0.35 * v.gap.before
    values = {x.name: x for f in found.values() for x in f.parameters}
    for parameter, truth in hidden.items():
        assert values[parameter].value == pytest.approx(truth, rel=0.05)
        assert values[parameter].low < values[parameter].value < values[parameter].high
    assert {w.effect for w in v.where} == names


@pytest.mark.parametrize("name", ["base", "gripper"])
def test_nothing_is_named_where_nothing_is_missing(name):
    system = example(name)
    *fit, held = tables(system, {}, seed=101)
    v = run(system, fit=fit, heldout=[held]).verdict
    assert v.verdict == "adequate"
    assert v.effects == v.recalibration == ()
    assert v.p_value >= 0.05
