"""What the task claims holds: by proof, and on its rehearsal."""

import pytest
from caretree.sim.faults import FaultyWorld, parse_fault
from caretree.trees.proof.check import check
from caretree.trees.run.runner import run
from caretree.trees.run.task import load_task

TASK = load_task("undress")


def test_it_holds():
    assert check(TASK).ok


@pytest.mark.parametrize("first", ["left", "right"])
def test_it_succeeds_on_its_rehearsal(first):
    world, senses = TASK.scripted(0)
    result = run(TASK, world, senses=senses, params=TASK.values({"first": first}))
    assert result.outcome == "success", result.reason
    assert [stage.name for stage in result.stages] == ["first_arm", "other_arm"]
    assert not world.worn


def test_a_sleeve_that_is_still_on_is_taken_again():
    world, senses = TASK.scripted(0)
    drawn = []

    def stays(progress):
        if progress.status == "success" and progress.name.endswith("draw it off"):
            drawn.append(progress.name)
            if len(drawn) == 1:
                world.worn.add("right")

    result = run(TASK, world, senses=senses, on_progress=stays)
    assert result.outcome == "success", result.reason
    assert drawn == ["right/draw it off", "right/draw it off", "left/draw it off"]


def test_a_gown_that_stays_on_the_trunk_is_not_claimed():
    world, senses = TASK.scripted(0)

    def stays(progress):
        if progress.status == "success" and progress.name.endswith("left/look at the arm"):
            senses.chest_cover = lambda frame, **_: type(senses)(world).chest_cover(frame, shoulders_in_map=None)
            world.worn.add("nobody")

    assert run(TASK, world, senses=senses, on_progress=stays).outcome == "safe_stop"


@pytest.mark.parametrize(
    ("fault", "outcome"),
    [
        ("lost_command@right/draw it off:start", "success"),
        ("dead_camera@right/see it lie:step", "safe_stop"),
        ("dead_sensor@left/draw it off:step", "safe_stop"),
    ],
)
def test_a_fault_ends_with_open_hands(fault, outcome):
    world, senses = TASK.scripted(0)
    result = run(TASK, FaultyWorld(world, [parse_fault(fault)]), senses=senses)
    assert result.outcome == outcome
    assert world.observe().gripper_opening.min() > 0.045
