"""The stage `spread`, rehearsed with sleeves that are low and a collar that is on the throat."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.skills.scripted.scripted_senses import ScriptedSenses
from caretree.trees.run.runner import run
from caretree.trees.run.task import load_task
from caretree.trees.run.worlds import prepare_stage


class LowSleeves(ScriptedSenses):
    """Armholes at `reach` of the upper arm until they are drawn up, and a collar `headward` of where it usually is."""

    def __init__(self, world, reach, headward):
        super().__init__(world)
        self.low, self.headward, self.taken = dict.fromkeys(("left", "right"), reach), headward, []

    def worn_sleeve(self, frame, *, side, arm_in_map):
        return replace(super().worn_sleeve(frame, side=side, arm_in_map=arm_in_map), reach=self.low[side])

    def drawn(self, progress):
        """Told of what goes on: a sleeve that was seated is higher up."""
        if progress.name.endswith("/seat") and progress.status == "success":
            side = progress.name.split()[0]
            self.taken.append(side)
            self.low[side] += 0.15

    def collar_middle(self, frame, *, near_in_map, away=(0.0, 0.0), flat=None):
        seen = super().collar_middle(frame, near_in_map=near_in_map, away=away, flat=flat)
        return replace(seen, position_in_map=seen.position_in_map - np.array((0.0, self.headward, 0.0)))


def rehearsed(reach, headward=0.0):
    """How the stage ends, and which armholes were taken by their front edge, in turn."""
    task = load_task("dressing")
    world, _ = task.scripted(1)
    prepare_stage(world, task, "spread")
    senses = LowSleeves(world, reach, headward)
    result = run(task, world, seed=1, senses=senses, params=task.parameters("spread"), on_progress=senses.drawn)
    return result.outcome, senses.taken


@pytest.mark.parametrize(
    ("reach", "taken"), [(0.85, []), (0.70, ["right", "left"]), (0.52, ["right", "left", "right", "left"])]
)
def test_low_sleeves_are_drawn_up_turn_by_turn_until_they_sit_and_twice_at_most(reach, taken):
    assert rehearsed(reach) == ("success", taken)


def test_no_sleeve_is_drawn_up_where_the_collar_is_on_the_throat():
    outcome, taken = rehearsed(0.75, headward=0.20)
    assert taken == []
    assert outcome == "safe_stop"
