"""The judge of `draw_blanket` asks, from truth, for a blanket on the trunk up to the chest that nobody holds."""

import numpy as np
import pytest
from caretree.sim.evaluate.run_record import RunRecord
from caretree.sim.scene.objects import Sheet, sheet_mesh
from caretree.sim.scripted.world import ScriptedWorld
from caretree.trees.run.task import load_task
from caretree.trees.tasks.draw_blanket.room import BLANKET, SPACING, scene

TASK = load_task("draw_blanket")
T = np.arange(60) / 10
MESH = sheet_mesh(Sheet(name="blanket", size=BLANKET, spacing=SPACING, position_in_map=(0.0, 0.0, 0.0)))


def record(below=0.2, up=0.02, turned=0.0, held=False, face=1.0):
    """A flat blanket over the trunk, its edge `below` the shoulders, `up` above the skin."""
    made = RunRecord.made_up(t=T)
    shoulders = made.arms[-1, :, 0].mean(axis=0)
    flat = MESH.vertices + (0.0, BLANKET[1] / 2, 0.0)
    c, s = np.cos(turned), np.sin(turned)
    flat = flat @ np.array(((c, -s, 0.0), (s, c, 0.0), (0.0, 0.0, 1.0))).T + shoulders + (0.0, below, up)
    blanket = np.tile(flat, (len(T), 1, 1))
    blanket[3, 0] = made.rows.face[:3] + (0.0, 0.0, face)
    x, y = np.meshgrid((-0.1, 0.0, 0.1), shoulders[1] + np.array((0.1, 0.2, 0.4, 0.5)))
    front = np.column_stack(
        (x.ravel(), y.ravel(), np.full(x.size, shoulders[2]), np.tile((0.0, 0.0, 1.0), (x.size, 1)))
    )
    return RunRecord.made_up(
        t=T,
        objects={"blanket": blanket},
        object_blanket_faces=MESH.faces,
        torso_front=np.tile(front, (len(T), 1, 1)),
        gripper_closed=np.full((len(T), 2), held),
    )


@pytest.mark.parametrize(
    ("changes", "success"),
    [
        ({}, True),
        ({"below": 0.05}, False),
        ({"below": 0.45}, False),
        ({"turned": 0.4}, False),
        ({"up": 0.2}, False),
        ({"held": True}, False),
        ({"face": 0.0}, False),
    ],
)
def test_the_judge_asks_for_a_blanket_that_lies_up_to_the_chest(changes, success):
    found = TASK.judge(record(**changes))
    assert found.success == success, found


def test_the_scene_is_the_same_for_the_same_seed():
    worlds = [ScriptedWorld() for _ in range(3)]
    for world, seed in zip(worlds, (5, 5, 6), strict=True):
        scene(world, seed)
    places = [world.objects["blanket"].position_in_map for world in worlds]
    assert places[0] == places[1] != places[2]
    assert not worlds[0].has_gown
