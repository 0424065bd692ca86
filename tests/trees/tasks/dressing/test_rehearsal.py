"""What the rehearsal of the dressing sees of a sleeve: on its arm once it was drawn up, until it is laid out."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure
from caretree.sim.scripted.world import ScriptedWorld
from caretree.skills.scripted.scripted_person import lying_arm
from caretree.trees.run.task import load_task
from caretree.trees.run.worlds import prepare_stage
from caretree.trees.tasks.dressing.rehearsal import GownScript

SHOULDER, WRIST, FINGERTIP = 0, 2, 3
OPEN, CLOSED, ROUND_ARM = 0.10, 0.002, 0.07  # between the fingertips [m]


class Hands(ScriptedWorld):
    """Its right hand is at `place` [m], so far `opening` [m]."""

    place, opening = np.zeros(3), OPEN

    def observe(self):
        seen = super().observe()
        poses = np.tile(np.eye(4), (2, 1, 1))
        poses[1, :3, 3] = self.place
        return replace(seen, pose_hand_in_map=poses, gripper_opening=np.array((OPEN, self.opening)))


def worn(senses, world, side="left"):
    frame = world.look("head")
    senses.arm(frame, side=side)
    try:
        return senses.worn_sleeve(frame, side=side, arm_in_map=lying_arm(side)).reach > 0.7
    except PerceptionFailure:
        return False


@pytest.mark.parametrize(
    ("at", "opening", "expected"),
    [(SHOULDER, CLOSED, True), (SHOULDER, OPEN, False), (SHOULDER, ROUND_ARM, False), (WRIST, CLOSED, False)],
)
def test_a_sleeve_is_on_its_arm_once_its_strap_was_held_at_the_shoulder(at, opening, expected):
    world = Hands()
    senses = GownScript(world)
    world.place, world.opening = lying_arm("left")[at] + (0.0, -0.1, 0.1), opening
    assert worn(senses, world) is expected
    world.place, world.opening = np.zeros(3), OPEN
    assert worn(senses, world) is expected
    assert not worn(senses, world, "right")


def test_it_is_off_again_where_its_strap_was_held_beyond_the_hand():
    world = Hands()
    senses = GownScript(world).on(world)
    world.opening = CLOSED
    for at, expected in ((SHOULDER, True), (FINGERTIP, False), (WRIST, False)):
        world.place = lying_arm("left")[at]
        assert worn(senses, world) is expected


@pytest.mark.parametrize(("stage", "expected"), [("dress", False), ("spread", True)])
def test_where_the_run_begins_with_the_gown_worn_both_are_on(stage, expected):
    task = load_task("dressing")
    world, senses = task.scripted(0)
    prepare_stage(world, task, stage)
    assert [worn(senses, world, side) for side in ("left", "right")] == [expected, expected]
