"""Rows of one run that branches are those of fresh runs, and a branch that is killed loses its own."""

import os
import signal

import numpy as np
import pytest
from caretree.sim.scripted.world import ScriptedWorld
from caretree.skills.core.skill import Skill
from caretree.trees.campaign.fresh_rows import fresh_rows
from caretree.trees.campaign.inject import Campaign
from caretree.trees.campaign.run_maker import RunMaker
from caretree.trees.nodes.composers import sequence
from caretree.trees.nodes.decorators import FailSafe
from caretree.trees.run.task import load_task

from ..planted import Look, Release, task_of

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="this system cannot fork")


def both(task, stage=None, count=None):
    """(branched, fresh) rows of a task, or of so many drawn of them."""
    campaign = Campaign(task, lambda: task.scripted(0), stage=stage, jobs=2)
    assert campaign.forks
    plan = campaign.plan()
    keys = (
        plan if count is None else [plan[k] for k in np.random.default_rng(0).choice(len(plan), count, replace=False)]
    )
    ways = {key: way for key in keys if (way := campaign.way(key[0], key[1])) is not None}
    fresh = fresh_rows(RunMaker(task, lambda: task.scripted(0), stage=stage), ways)
    return {row.key: row for row in campaign.rows(ways)}, {row.key: row for row in fresh}


def test_all_rows_of_a_task_are_those_of_fresh_runs():
    branched, fresh = both(load_task("wave"))
    assert len(branched) > 100
    assert branched == fresh


@pytest.mark.extra
@pytest.mark.no_cover  # counting lines doubles its time
@pytest.mark.parametrize(("stage", "count"), [("lay", 24), (None, 4)])
def test_rows_of_the_dressing_are_those_of_fresh_runs(stage, count):
    branched, fresh = both(load_task("dressing"), stage, count)
    assert any(row.outcome != "not_reached" for row in fresh.values())
    assert branched == fresh


class Sensitive(Skill):
    """Kills its process when the force sensor shows a blow; notes the process in which it ends."""

    commands = False

    def steps(self):
        for _ in range(5):
            if self.world.observe().wrench_hand_in_map.min() < -30.0:
                os.kill(os.getpid(), signal.SIGKILL)
            yield
        os.write(ENDED[1], f"{os.getpid()} ".encode())


ENDED = (-1, -1)


@pytest.fixture
def ended(monkeypatch):
    """Pipe that gets the process of every run of `Sensitive` that came to its end."""
    pipe = os.pipe()
    monkeypatch.setitem(globals(), "ENDED", pipe)
    yield pipe
    for end in pipe:
        os.close(end)


def sensitive():
    body = lambda context: sequence("s", Sensitive("a", context), Look("b", context, outcomes=[True]))  # noqa: E731
    return task_of(lambda context: FailSafe("f", body(context), Release("let go", context)))


def test_a_branch_that_is_killed_loses_its_own_rows_only(ended):
    faults = ("force_spike", "stale_frame", "dead_sensor")
    campaign = Campaign(sensitive(), lambda: (ScriptedWorld(), None), faults=faults, jobs=2)
    rows = list(campaign.rows())
    lost = set(campaign.plan()) - {row.key for row in rows}
    assert {("a", "start", "force_spike"), ("a", "step", "force_spike")} <= lost
    assert {fault for _, _, fault in lost} == {"force_spike"}
    assert len(rows) == len({row.key for row in rows})


def test_faults_that_nobody_feels_take_no_run_of_their_own(ended):
    """Nothing is looked at, and nothing is held: all these rows are the same run, but for where it is stopped."""
    faults = ("stale_frame", "occlusion", "dead_camera", "grip_slip")
    campaign = Campaign(sensitive(), lambda: (ScriptedWorld(), None), faults=faults)
    os.read(ended[0], 1 << 16)  # the run without faults
    wanted = [key for key in campaign.plan() if key[1] != "cancel" and key[0] != "let go"]
    rows = list(campaign.rows(wanted))
    assert len(rows) == len(wanted)
    assert {row.outcome for row in rows} == {"success"}
    assert len(os.read(ended[0], 1 << 16).split()) == 1
