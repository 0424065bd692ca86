"""Rows on a cluster: those of this machine, the task's own file goes along, and a lost call loses its own rows."""

import sys

import pytest
from caretree.trees.campaign import rows_on_cluster as module
from caretree.trees.campaign.inject import Campaign
from caretree.trees.campaign.rows_on_cluster import parts
from caretree.trees.campaign.run_maker import RunRecipe
from caretree.trees.run.task import load_task

from ...fake_ray import FakeRay

TASK = """from caretree.skills import HoldStill, Retreat
from caretree.trees import FailSafe


def build(context):
    return FailSafe("s", HoldStill("a", context, seconds=1.0), Retreat("b", context, hand_distance=0.0))
"""


@pytest.fixture
def ray(monkeypatch):
    fake = FakeRay(cores=2)
    monkeypatch.setitem(sys.modules, "ray", fake)
    monkeypatch.setattr(module, "PLACES", 2)
    return fake


@pytest.fixture
def path(tmp_path):
    path = tmp_path / "mine.py"
    path.write_text(TASK)
    return str(path)


def campaign(path, **more):
    task = load_task(path)
    return Campaign(task, lambda: task.scripted(0), faults=("dead_sensor", "occlusion"), **more)


def test_rows_come_back_and_a_lost_call_loses_its_own(ray, path):
    here = {row.key: row for row in campaign(path).rows()}
    there = campaign(path, address="ray://x", recipe=RunRecipe(task=path))
    assert {row.key: row for row in there.rows()} == here
    assert ray.most_in_flight == 2
    assert ray.left
    ray.killed = {0}
    kept = {row.key for row in there.rows()}
    lost = set(here) - kept
    assert len({(node, phase) for node, phase, _ in lost}) == 2
    assert {row.key for row in there.rows(lost)} <= lost


def test_neighbouring_places_go_together(path):
    found = campaign(path)
    ways = {key: way for key in found.plan() if (way := found.way(key[0], key[1])) is not None}
    groups = parts(ways)
    assert [key for group in groups for key in group] == list(ways)
    assert {len({key[:2] for key in group}) for group in groups[:-1]} <= {module.PLACES}
