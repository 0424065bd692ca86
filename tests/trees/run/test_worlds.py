"""Worlds by name, and what they refuse."""

import numpy as np
import pytest
from caretree.sim.errors import CaretreeError
from caretree.sim.scripted.world import ScriptedWorld
from caretree.trees.run.task import load_task
from caretree.trees.run.worlds import make_world, prepare_stage


def test_the_scripted_world_comes_with_what_is_seen_there():
    world, senses = make_world("scripted", load_task("dressing"), seed=3)
    frame = world.look("head")
    assert senses.hook(frame).stamp == frame.stamp


@pytest.mark.parametrize(
    "option", [{"gown": "large"}, {"person": "small"}, {"model": "model.yaml"}, {"look": "plain"}, {"engine": "spring"}]
)
def test_the_scripted_world_has_no_cloth_and_no_person(option):
    with pytest.raises(CaretreeError, match=f"--{next(iter(option))} needs the bullet world"):
        make_world("scripted", load_task("wave"), seed=0, **option)


def test_the_scripted_world_is_as_easy_as_can_be():
    make_world("scripted", load_task("wave"), seed=0, kind="easy")
    with pytest.raises(CaretreeError, match="--world-kind needs the bullet world"):
        make_world("scripted", load_task("wave"), seed=0, kind="easy+falling_arms")


def test_the_bullet_world_is_as_hard_as_asked_for():
    world, _ = make_world("bullet", load_task("wave"), seed=100, kind="easy+falling_arms")
    assert world.scene.kind.name == "easy+falling_arms"
    assert world.scene.person.falls
    arms = world.truth_frame().arms
    world.clock.wait_until(1.0)
    assert np.abs(world.truth_frame().arms - arms).max() < 0.01, "they have come to rest before the run [m]"
    world.close()


def test_an_unknown_world_is_refused_with_those_there_are():
    with pytest.raises(CaretreeError, match="unknown world 'moon'; there are bullet, scripted, remote, ros1, or give"):
        make_world("moon", load_task("wave"), seed=0)


def test_a_world_with_one_beginning_cannot_begin_at_a_later_stage():
    task = load_task("dressing")
    stage = list(task.stages)[-1]
    with pytest.raises(CaretreeError, match="ScriptedWorld has one beginning only"):
        prepare_stage(ScriptedWorld(), task, stage)


def test_a_whole_task_begins_where_the_world_does():
    world = ScriptedWorld()
    prepare_stage(world, load_task("dressing"), None)
    assert not world.sent
