"""Cameras that are dead for 20 s, or a command that is lost, end no dressing run; cameras that stay dead do."""

import pytest
from caretree.sim.faults import FaultyWorld, parse_fault
from caretree.trees.run.runner import Run
from caretree.trees.run.task import load_task

WHEN = {  # stages -> when its fault begins
    "take_down-lay": (
        "rail/look for a corner:start",
        "rail/take a corner:step",
        "gown/stretch the neckline:start",
        "gown/outside to the robot:start",
    ),
    "dress": ("right arm/lift:step", "left arm/pull up:step", "left arm/is inside:start"),
    "spread": ("left sleeve/go up and look:start", "gown/sleeves?:step", "left armhole/look:start"),
}


def outcome(stage, fault):
    """How the rehearsal of a stage with a fault ends, and why."""
    task = load_task("dressing")
    inner, senses = task.scripted(1)
    world = FaultyWorld(inner, [parse_fault(fault)])
    record = Run(task, world, seed=1, senses=senses, params=task.parameters(stage)).run()
    assert [str(spec) for spec, _ in world.begun] == [fault]
    return record.outcome, record.reason


@pytest.mark.no_cover  # counting lines doubles its time
@pytest.mark.parametrize(("stage", "when"), [(stage, when) for stage, many in WHEN.items() for when in many])
def test_cameras_that_come_back_end_nothing(stage, when):
    assert outcome(stage, f"camera_out@{when}")[0] == "success"


@pytest.mark.no_cover  # counting lines doubles its time
@pytest.mark.parametrize("when", ["left arm/lift:step", "right arm/grasp the sleeve:start"])
def test_a_lost_command_ends_nothing(when):
    assert outcome("dress", f"lost_command@{when}")[0] == "success"


@pytest.mark.no_cover  # counting lines doubles its time
def test_cameras_that_stay_dead_end_the_run():
    ended, why = outcome("dress", "dead_camera@left arm/pull up:step")
    assert ended == "safe_stop"
    assert "A sensor gave nothing" in why
