"""What the task claims holds: by proof, on its scripted world, and its judge is not fooled."""

import numpy as np
import pytest
from caretree.sim.evaluate.run_record import RunRecord
from caretree.sim.faults import FaultyWorld, parse_fault
from caretree.trees.proof.check import check
from caretree.trees.run.runner import run
from caretree.trees.run.task import load_task
from caretree.trees.tasks.wash_arm.room import longest

TASK = load_task("wash_arm")


def test_it_holds():
    assert check(TASK).ok


@pytest.mark.parametrize("arm", ["left", "right"])
def test_it_succeeds_on_its_scripted_world(arm):
    world, senses = TASK.scripted(0)
    result = run(TASK, world, senses=senses, params=TASK.values({"arm": arm, "seconds": 6.0}))
    assert result.outcome == "success", result.reason
    hold = next(stage for stage in result.stages if stage.name == "hold")
    assert hold.t_end - hold.t_start >= 6.0


@pytest.mark.parametrize("fault", ["grip_slip@right arm/hold it up:step", "dead_sensor@right arm/lift:step"])
def test_a_fault_ends_with_nobody_held(fault):
    world, senses = TASK.scripted(0)
    result = run(TASK, FaultyWorld(world, [parse_fault(fault)]), senses=senses)
    assert result.outcome in ("success", "safe_stop")
    assert world.observe().gripper_opening.min() > 0.06


def test_the_judge_counts_time_without_a_break():
    t = np.arange(6.0)
    assert longest(t, np.array([0, 1, 1, 0, 1, 1], bool)) == 1.0
    assert longest(t, np.ones(6, bool)) == 5.0
    assert longest(t, np.zeros(6, bool)) == 0.0


@pytest.mark.parametrize(("raised", "held", "success"), [(0.3, 1, True), (0.0, 1, False), (0.3, -1, False)])
def test_the_judge_asks_for_an_arm_that_was_held_up(raised, held, success):
    arms = RunRecord.made_up(t=np.arange(100) / 10).arms.copy()
    arms[20:90, 1, 1, 2] = raised
    holds = np.full((100, 2), -1)
    holds[:95, 0] = held
    record = RunRecord.made_up(arms=arms, holds_arm=holds, parameters={"arm": "right", "seconds": 5.0})
    found = TASK.judge(record)
    assert found.success == success, found
    assert found.numbers["held_up_s"] == pytest.approx(6.9 if success else 0.0)
