"""Two hands that take one cloth and carry it, each to its own place."""

import numpy as np
import pytest
from caretree.skills.control.carry import Carry
from caretree.skills.control.hands import gap_between_arms, hand_now
from caretree.skills.control.two_hands import carry_each, take_each
from caretree.skills.core.reasons import Reason, SkillFailure
from caretree.skills.core.skill import Skill
from caretree.skills.geometry.stances import stance_at_head
from caretree.skills.motion.errors import PathBlocked

from ..bench import LeafBench, beside_bed

MISSED = SkillFailure(Reason.GRASP_MISSED, "nothing")
FAR = PathBlocked("no way")
LOST = SkillFailure(Reason.COMMAND_LOST, "nothing moved")


def taken(**outcomes):
    """What `take_each` returns where each hand's grasp raises, or not (None), and which hands tried."""
    tried = []

    def grasp(side, outcome):
        tried.append(side)
        yield
        if outcome is not None:
            raise outcome

    grasps = {side: lambda side=side, outcome=outcome: grasp(side, outcome) for side, outcome in outcomes.items()}
    taking = take_each(grasps)
    try:
        while True:
            next(taking)
    except StopIteration as end:
        return end.value, tried


@pytest.mark.parametrize(
    ("left", "right", "held"),
    [
        (None, None, ["left", "right"]),
        (MISSED, None, ["right"]),
        (None, MISSED, ["left"]),
        (FAR, None, ["right"]),
    ],
)
def test_one_that_misses_does_not_keep_the_other_from_it(left, right, held):
    assert taken(left=left, right=right) == (held, ["left", "right"])


def test_where_none_holds_any_the_last_problem_is_told():
    with pytest.raises(SkillFailure) as miss:
        taken(left=FAR, right=MISSED)
    assert miss.value is MISSED


def test_anything_worse_ends_it_at_once():
    with pytest.raises(SkillFailure) as lost:
        taken(left=LOST, right=None)
    assert lost.value is LOST


class CarryBoth(Skill):
    """Carries both hands by `shifts`."""

    shifts, apart = None, None

    def steps(self):
        places = {side: hand_now(self, side)[:3, 3] + shift for side, shift in self.shifts.items()}
        yield from carry_each(self, places, Carry(), self.apart)


def carried(shifts, apart=0.04):
    def make(context):
        skill = CarryBoth("carry", context)
        skill.shifts, skill.apart = shifts, apart
        return skill

    gaps = []
    run = LeafBench(
        make, beside_bed(stand=stance_at_head()), each_tick=lambda run: gaps.append(gap_between_arms(run.skill))
    )
    assert run.ended() is None
    return run, min(gaps)


def test_both_go_at_once_each_to_its_place():
    shifts = {"left": (0.05, 0.0, 0.10), "right": (0.0, 0.05, 0.10)}
    run, _ = carried(shifts)
    for side, shift in shifts.items():
        way = run.way(side)
        assert way[-1] - run.start.pose_hand_in_map[0 if side == "left" else 1, :3, 3] == pytest.approx(
            shift, abs=0.015
        )
    rise = [run.way(side)[:, 2] - run.way(side)[0, 2] for side in shifts]
    assert np.abs(rise[0] - rise[1]).max() < 0.03  # [m]


def test_they_stop_before_the_arms_meet():
    towards = {"left": (0.0, 0.0, 0.0), "right": (0.0, 0.0, 0.0)}
    run, _ = carried(towards)
    hands = run.start.pose_hand_in_map[:, :3, 3]
    between = hands[1] - hands[0]
    run, nearest = carried({"left": 0.5 * between, "right": -0.5 * between}, apart=0.10)
    assert nearest > 0.07  # [m]
    assert np.linalg.norm(run.way("right")[-1] - run.way("left")[-1]) < 0.8 * np.linalg.norm(between)
