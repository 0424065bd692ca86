"""Rows in processes of their own are those of this process; one that is killed loses its own."""

import pytest
from caretree.sim.errors import CaretreeError
from caretree.trees.campaign.inject import Campaign
from caretree.trees.campaign.rows_process import RowsProcess, rows_in_processes
from caretree.trees.campaign.run_maker import RunRecipe
from caretree.trees.run.task import load_task

DIES = """
import os, signal
from caretree.skills import HoldStill, Retreat
from caretree.skills.core.skill import Skill
from caretree.trees import FailSafe, sequence


class Look(Skill):
    commands = False

    def steps(self):
        print("this is no answer")
        if self.world.observe().wrench_hand_in_map.min() < -30.0:
            os.kill(os.getpid(), signal.SIGKILL)
        yield


def build(context):
    return FailSafe("safely", sequence("s", Look("look", context)), Retreat("let go", context, hand_distance=0.0))
"""


def asked(name, keys):
    task = load_task(name)
    campaign = Campaign(task, lambda: task.scripted(0))
    ways = {key: way for key in keys if (way := campaign.way(key[0], key[1])) is not None}
    return ways, {row.key: row for row in campaign.rows(ways)}


def test_rows_of_several_processes_are_those_of_this_one():
    keys = [("wait", "start", "occlusion"), ("hand up", "cancel", "dead_sensor"), ("let go", "start", "lost_command")]
    ways, here = asked("wave", keys)
    assert {row.key: row for row in rows_in_processes(RunRecipe(task="wave"), ways, 2)} == here
    process = RowsProcess(RunRecipe(task="wave"), ways, forks=True)
    assert {row.key: row for row in process.rows()} == here
    process.end()


def test_one_that_is_killed_loses_its_own_row(tmp_path):
    path = tmp_path / "dies.py"
    path.write_text(DIES)
    ways, _ = asked(str(path), [("look", "start", "stale_frame"), ("look", "start", "force_spike")])
    rows = list(rows_in_processes(RunRecipe(task=str(path)), ways, 2))
    assert [row.fault for row in rows] == ["stale_frame"]


def test_what_it_refuses_is_told():
    process = RowsProcess(RunRecipe(task="no such task"), {}, forks=False)
    with pytest.raises(CaretreeError, match="no such task"):
        list(process.rows())
    process.end()
