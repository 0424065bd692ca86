"""What the task claims holds: by proof, and on its rehearsal."""

import pytest
from caretree.sim.faults import FaultyWorld, parse_fault
from caretree.trees.proof.check import check
from caretree.trees.run.runner import run
from caretree.trees.run.task import load_task

TASK = load_task("draw_blanket")


def test_it_holds():
    assert check(TASK).ok


@pytest.mark.parametrize("first", ["left", "right"])
def test_it_succeeds_on_its_rehearsal(first):
    world, senses = TASK.scripted(0)
    result = run(TASK, world, senses=senses, params=TASK.values({"first": first}))
    assert result.outcome == "success", result.reason
    assert [stage.name for stage in result.stages] == ["first_side", "other_side"]
    assert all(y < -0.2 for y in world.edge.values()), "both halves of the edge were drawn up"


def test_an_edge_that_slips_back_is_drawn_up_again():
    world, senses = TASK.scripted(0)
    drawn = []

    def slips(progress):
        if progress.status == "success" and progress.name.endswith("draw it up"):
            drawn.append(progress.name)
            if len(drawn) == 1:
                world.edge[1.0] = 0.1

    result = run(TASK, world, senses=senses, on_progress=slips)
    assert result.outcome == "success", result.reason
    assert drawn == ["right/draw it up", "right/draw it up", "left/draw it up"]


@pytest.mark.parametrize(
    ("fault", "outcome"),
    [
        ("lost_command@right/draw it up:start", "success"),
        ("dead_camera@right/see it lie:step", "safe_stop"),
        ("dead_sensor@left/draw it up:step", "safe_stop"),
    ],
)
def test_a_fault_ends_with_open_hands(fault, outcome):
    world, senses = TASK.scripted(0)
    result = run(TASK, FaultyWorld(world, [parse_fault(fault)]), senses=senses)
    assert result.outcome == outcome
    assert world.observe().gripper_opening.min() > 0.06
