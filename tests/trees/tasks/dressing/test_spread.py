"""The stage `spread`, rehearsed with sleeves that are low and a collar that is off its place."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.skills.scripted.scripted_senses import ScriptedSenses
from caretree.trees.run.runner import run
from caretree.trees.run.task import load_task
from caretree.trees.run.worlds import prepare_stage

DRAWS = {
    **{f"gown/{name}": name for name in ("seat", "spread")},
    **{f"{side} strap/pull up": f"{side} strap" for side in ("left", "right")},
}
STRAP, FRONT = 0.3, 0.15  # how much farther up the arm a sleeve is after it was drawn by either


class WornGown(ScriptedSenses):
    """Armholes at `reach` of the upper arm until they are drawn up, and a collar that is `off` (x, y) until it is laid.

    Attributes:
        done: what was done to it, in turn.
    """

    def __init__(self, world, reach, off, *, stays=False):
        super().__init__(world)
        self.low, self.off, self.stays, self.done = dict.fromkeys(("left", "right"), reach), off, stays, []

    def worn_sleeve(self, frame, *, side, arm_in_map):
        return replace(super().worn_sleeve(frame, side=side, arm_in_map=arm_in_map), reach=self.low[side])

    def drawn(self, progress):
        """Told of what goes on: what was drawn up is higher up, what was laid straight lies there."""
        if progress.status != "success" or progress.name not in DRAWS:
            return
        self.done.append(DRAWS[progress.name])
        for side in self.low:
            self.low[side] += {"seat": FRONT, f"{side} strap": STRAP}.get(self.done[-1], 0.0)
        if self.done[-1] == "spread" and not self.stays:
            self.off = (0.0, 0.0)

    def collar_middle(self, frame, *, near_in_map, away=(0.0, 0.0)):
        seen = super().collar_middle(frame, near_in_map=near_in_map, away=away)
        return replace(seen, position_in_map=near_in_map + (*np.add(self.off, away), 0.13))


def rehearsed(reach, off=(0.0, 0.0), *, stays=False):
    """How the stage ends, and what was done to the gown in turn."""
    task = load_task("dressing")
    world, _ = task.scripted(1)
    prepare_stage(world, task, "spread")
    senses = WornGown(world, reach, off, stays=stays)
    result = run(task, world, seed=1, senses=senses, params=task.parameters("spread"), on_progress=senses.drawn)
    return result.outcome, senses.done


@pytest.mark.parametrize(
    ("reach", "ends", "done"),
    [
        (0.85, "success", []),
        (0.60, "success", ["seat"]),
        (0.30, "success", ["left strap", "right strap", "seat"]),
        (0.52, "safe_stop", ["seat"]),
    ],
)
def test_sleeves_are_drawn_up_together_once_by_their_straps_first_where_they_are_far_down(reach, ends, done):
    assert rehearsed(reach) == (ends, done)


@pytest.mark.parametrize("off", [(0.14, 0.0), (-0.14, 0.0), (0.0, -0.18)])
def test_a_collar_that_is_off_its_place_is_laid_straight(off):
    assert rehearsed(0.85, off) == ("success", ["spread"])


def test_low_sleeves_are_drawn_up_before_the_collar_is_laid_straight():
    assert rehearsed(0.70, (0.14, 0.0)) == ("success", ["seat", "spread"])


def test_a_collar_that_stays_on_the_throat_ends_the_task_without_a_claim():
    outcome, done = rehearsed(0.85, (0.0, -0.25), stays=True)
    assert outcome == "safe_stop"
    assert set(done) == {"spread"}
    assert len(done) <= 4
