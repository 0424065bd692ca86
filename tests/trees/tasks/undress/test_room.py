"""The judge of `undress` asks, from truth, for bare arms, a bare trunk, and a gown on the bed that nobody holds."""

import numpy as np
import pytest
from caretree.sim.evaluate.run_record import RunRecord
from caretree.trees.run.task import load_task

TASK = load_task("undress")
T = np.arange(60) / 10
RING = np.linspace(0.0, 2.0 * np.pi, 8, endpoint=False)
SIDES = ("left", "right")


def rings(arm, along):
    """(8, 3) a loop round an arm (4, 3), `along` [m] from its shoulder; its right-hand normal points to the hand."""
    at = arm[0] + (0.0, along, 0.0)
    return at + 0.1 * np.column_stack((np.sin(RING), np.zeros(8), np.cos(RING)))


def record(worn="", begun=("left", "right"), up=0.5, trunk=2.0, held=False, face=1.0):
    """Sleeves on their arms at first and of `worn` in the end; then a sheet `trunk` [m] beside the trunk."""
    made = RunRecord.made_up(t=T)
    arms, bed = made.arms[0], made.bed_top
    loops, sheet = {}, []
    for n, side in enumerate(SIDES):
        for k, part in enumerate(("armhole", "cuff")):
            loops[f"loop_{part}_{side}"] = np.arange(8) + 8 * len(loops)
            sheet.append(rings(arms[n], 0.1 + 0.15 * k))
    rest = len(loops) * 8
    corners = np.array(((-0.2, -0.2, 0.0), (0.2, -0.2, 0.0), (-0.2, 0.6, 0.0), (0.2, 0.6, 0.0)))
    flat = np.tile(corners + (trunk, 0.3, 0.02), (12, 1))
    vertices = np.tile(np.vstack((*sheet, flat)), (len(T), 1, 1))
    for side in SIDES:
        ids = np.concatenate([loops[f"loop_{part}_{side}"] for part in ("armhole", "cuff")])
        if side not in begun:
            vertices[:, ids, 0] += 3.0
        elif side != worn:
            vertices[30:, ids, 0] += 3.0
    vertices[30:, rest:, 2] += bed + 0.05 if up > 0 else up
    vertices[3:20, rest] = made.rows.face[:3] + (-0.2, -0.2, face)
    for k, corner in enumerate(((0.2, -0.2), (-0.2, 0.6), (0.2, 0.6)), 1):
        vertices[3:20, rest + k] = made.rows.face[:3] + (*corner, face)
    x, y = np.meshgrid((-0.1, 0.0, 0.1), (0.2, 0.3, 0.4))
    front = np.column_stack((x.ravel(), y.ravel(), np.full(x.size, bed), np.tile((0.0, 0.0, 1.0), (x.size, 1))))
    return RunRecord.made_up(
        t=T,
        vertices=vertices,
        faces=np.array(((0, 2, 1), (1, 2, 3))) + rest,
        torso_front=np.tile(front, (len(T), 1, 1)),
        gripper_closed=np.full((len(T), 2), held),
        **loops,
    )


@pytest.mark.parametrize(
    ("changes", "problem"),
    [
        ({}, ""),
        ({"worn": "left"}, "the left arm is still in its sleeve"),
        ({"begun": ("left",)}, "the right arm was in no sleeve"),
        ({"trunk": 0.0}, "trunk covered"),
        ({"up": -0.5}, "gown above mattress"),
        ({"held": True}, "the robot holds the gown"),
        ({"face": 0.03}, "face covered"),
    ],
)
def test_the_judge_asks_for_bare_arms_and_a_gown_that_lies(changes, problem):
    found = TASK.judge(record(**changes))
    assert found.success == (not problem), found
    assert problem in str(found)
