"""What the task claims holds: by proof, and on its rehearsal."""

import pytest
from caretree.sim.faults import FaultyWorld, parse_fault
from caretree.trees.proof.check import check
from caretree.trees.run.runner import run
from caretree.trees.run.task import load_task

TASK = load_task("wipe_forearm")


def test_it_holds():
    assert check(TASK).ok


@pytest.mark.parametrize("arm", ["left", "right"])
def test_it_succeeds_on_its_rehearsal(arm):
    world, senses = TASK.scripted(0)
    result = run(TASK, world, senses=senses, params=TASK.values({"arm": arm, "strokes": 2}))
    assert result.outcome == "success", result.reason
    assert [stage.name for stage in result.stages] == ["fetch", "wipe", "return"]


@pytest.mark.parametrize(
    ("fault", "outcome"),
    [
        ("lost_command@cloth/wipe:step", "success"),
        ("grip_slip@cloth/wipe:step", "safe_stop"),
        ("dead_sensor@cloth/wipe:step", "safe_stop"),
    ],
)
def test_a_fault_ends_with_open_hands(fault, outcome):
    world, senses = TASK.scripted(0)
    result = run(TASK, FaultyWorld(world, [parse_fault(fault)]), senses=senses)
    assert result.outcome == outcome
    assert world.observe().gripper_opening.min() > 0.06
