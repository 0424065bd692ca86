"""The judge of `hand_towel` asks, from truth, for a towel that lies across the hand and that nobody holds."""

import numpy as np
import pytest
from caretree.sim.evaluate.run_record import RunRecord
from caretree.sim.scripted.world import ScriptedWorld
from caretree.trees.run.task import load_task
from caretree.trees.tasks.hand_towel.room import scene

TASK = load_task("hand_towel")
T = np.arange(60) / 10
SHEET = np.array(((-0.15, -0.12), (0.15, -0.12), (-0.15, 0.12), (0.15, 0.12)))  # corners [m]
FACES = np.array(((0, 1, 3), (0, 3, 2)))


def record(up=0.01, aside=0.0, held=False, face=1.0):
    """A sheet over the right hand of the record that is made up, `up` above its skin."""
    made = RunRecord.made_up(t=T)
    arm, radius = made.arms[-1, 1], made.arm_radii[1, 2]
    middle = 0.5 * (arm[2] + arm[3]) + (0.0, aside, radius + up)
    towel = np.tile(np.column_stack((SHEET, np.zeros(4))) + middle, (len(T), 1, 1))
    towel[3] = made.rows.face[:3] + np.column_stack((0.3 * SHEET, np.zeros(4))) + (0.0, 0.0, face)
    return RunRecord.made_up(
        t=T,
        objects={"towel": towel},
        object_towel_faces=FACES,
        parameters={"arm": "right"},
        gripper_closed=np.full((len(T), 2), held),
    )


@pytest.mark.parametrize(
    ("changes", "success"),
    [({}, True), ({"up": 0.2}, False), ({"aside": 0.3}, False), ({"held": True}, False), ({"face": 0.0}, False)],
)
def test_the_judge_asks_for_a_towel_that_lies_on_the_hand(changes, success):
    found = TASK.judge(record(**changes))
    assert found.success == success, found


def test_half_a_hand_is_told():
    assert 0.2 < TASK.judge(record(aside=0.12)).numbers["hand_covered_1"] < 0.8


def test_the_scene_is_the_same_for_the_same_seed():
    worlds = [ScriptedWorld() for _ in range(3)]
    for world, seed in zip(worlds, (5, 5, 6), strict=True):
        scene(world, seed)
    places = [world.objects["towel"].position_in_map for world in worlds]
    assert places[0] == places[1] != places[2]
    assert not worlds[0].has_gown
