"""A gown that is down is let go of, also where a hand met the person on its way; one in the air is not."""

import numpy as np
import pytest
from caretree.trees.tasks.dressing.lay import is_down
from caretree.trees.tasks.dressing.let_gown_go import LetGownGo
from py_trees.common import Status

from ....skills.bench import LeafBench, beside_bed


def test_both_hands_open_rise_and_draw_back():
    run = LeafBench(lambda context: LetGownGo("let go", context), beside_bed())
    run.world.between_fingers.update(left=0.002, right=0.002)
    assert run.ended(seconds=60.0) is None
    assert run.skill.status == Status.SUCCESS
    for side in ("left", "right"):
        assert run.openings(side)[-1] > 0.08, "open [m]"
        assert np.ptp(run.way(side)[:, 2]) > 0.1, "up and off the cloth [m]"
    assert run.seen[-1].pose_base_in_map[1] == pytest.approx(1.6, abs=0.05)


class Still:
    """A world in which both hands are so high above the mattress [m]."""

    def __init__(self, left, right):
        self.room = self
        self.bed = np.array(((-0.45, -1.0, 0.5), (0.45, 1.0, 0.58)))
        self.pose_hand_in_map = np.tile(np.eye(4), (2, 1, 1))
        self.pose_hand_in_map[:, 2, 3] = self.bed[1, 2] + np.array((left, right))

    def observe(self):
        return self


@pytest.mark.parametrize(("left", "right", "down"), [(0.15, 0.12, True), (0.15, 0.35, False), (0.7, 0.7, False)])
def test_a_gown_is_down_with_both_hands(left, right, down):
    class Context:
        world = Still(left, right)

    assert is_down(Context()) is down
