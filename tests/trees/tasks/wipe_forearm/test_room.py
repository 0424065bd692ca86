"""The judge of `wipe_forearm` counts strokes and asks for a force within its band, from truth."""

import numpy as np
import pytest
from caretree.sim.evaluate.run_record import RunRecord
from caretree.sim.scripted.world import ScriptedWorld
from caretree.trees.run.task import load_task
from caretree.trees.tasks.wipe_forearm.room import scene, strokes

TASK = load_task("wipe_forearm")
T = np.arange(200) / 10


def record(force=3.5, peak=0.0, back=0.0, times=4):
    """Four strokes of 4 s each along the right forearm of the record that is made up, and the cloth put back."""
    arm = RunRecord.made_up(t=T).arms[0, 1]
    share = 0.5 - 0.4 * np.cos(np.clip(T - 1.0, 0.0, 4.0 * times) * np.pi / 4.0)
    cloth = np.zeros((len(T), 7))
    cloth[:, :3] = arm[1] + share[:, None] * (arm[2] - arm[1]) + (0.0, 0.0, 0.08)
    cloth[0, :3], cloth[-1, :3] = (3.0, 0.0, 0.7), (3.0 + back, 0.0, 0.7)
    made = RunRecord.made_up(t=T)
    pressed = np.zeros((len(T), len(made.person_parts)))
    part = made.person_parts.index("right_forearm")
    pressed[8:175, part] = force
    pressed[20, part] += peak
    return RunRecord.made_up(
        t=T, objects={"cloth": cloth}, parameters={"arm": "right", "strokes": 4}, person_force=pressed
    )


@pytest.mark.parametrize(
    ("changes", "success"),
    [({}, True), ({"force": 1.0}, False), ({"force": 6.0}, False), ({"peak": 8.0}, False), ({"back": 0.3}, False)],
)
def test_the_judge_asks_for_force_place_and_strokes(changes, success):
    found = TASK.judge(record(**changes))
    assert found.success == success, found


def test_too_few_strokes_are_not_enough():
    found = TASK.judge(record(times=2))
    assert found.numbers["strokes_1"] == 2.0
    assert not found.success


def test_a_cloth_that_is_lifted_off_begins_anew():
    along = np.array((1.1, 1.5, 1.9, 1.5, 1.1, 1.5, 1.9))
    assert strokes(along, np.ones(7, bool)) == 3
    assert strokes(along, np.array((1, 1, 1, 0, 1, 1, 1), bool)) == 2
    assert strokes(along, np.zeros(7, bool)) == 0


def test_the_scene_is_the_same_for_the_same_seed():
    worlds = [ScriptedWorld() for _ in range(3)]
    for world, seed in zip(worlds, (5, 5, 6), strict=True):
        scene(world, seed)
    places = [world.objects["cloth"].position_in_map for world in worlds]
    assert places[0] == places[1] != places[2]
    assert not worlds[0].has_gown
