"""Cloth on the person is taken by a hand that comes down from above, slowly, with fingers little open."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.estimates import Estimate, GraspPoint
from caretree.skills.belief.person_tracking import watch_arm
from caretree.skills.control.take_from_above import FromAbove, take_from_above
from caretree.skills.core.reasons import Reason
from caretree.skills.core.skill import Skill
from caretree.skills.geometry.stances import outwards
from caretree.skills.scripted.scripted_person import lying_posture

from ..bench import LeafBench, beside_bed

STAND = (0.80, -0.62, np.pi)  # beside the right shoulder, facing the bed [m, m, rad]
PLACE = np.array((0.0, -0.40, 0.85))


class Take(Skill):
    """Takes cloth whose normal leans over to the robot's side."""

    reasons = (Reason.GRASP_MISSED, Reason.UNREACHABLE, Reason.COMMAND_LOST, Reason.MOTION_BLOCKED)
    lean = np.deg2rad(50.0)

    def steps(self):
        point = GraspPoint(
            stamp=0.0,
            confidence=0.9,
            target="cloth",
            position_in_map=PLACE,
            approach_in_map=np.array((-np.sin(self.lean), 0.0, -np.cos(self.lean))),
            closing_in_map=np.array((0.0, 1.0, 0.0)),
        )
        watch_arm(self, "right")
        self.context.guard.update_person(np.array(((0.0, -0.9, 0.70), (0.0, 0.7, 0.70))), radius=0.12)
        yield from take_from_above(self, "right", point, outwards("right"), FromAbove())


def taken(cloth):
    senses = {"gripped_cloth": cloth, "arm": lambda frame, side, **_: lying_posture(side)}
    run = LeafBench(lambda context: Take("take", context), beside_bed(stand=STAND, **senses))
    return run, run.ended()


def test_it_comes_from_above_whatever_way_the_cloth_faces_and_closes_there():
    run, failure = taken(Estimate(stamp=0.0, confidence=0.9))
    assert failure is None
    assert run.way("right")[-1] == pytest.approx(PLACE, abs=0.02)
    assert run.openings("right")[-1] < 0.005
    down = -run.world.observe().pose_hand_in_map[1, 2, 2]
    assert np.rad2deg(np.arccos(down)) <= 36.0


def test_right_beside_the_person_the_way_down_is_slow():
    run, _ = taken(Estimate(stamp=0.0, confidence=0.9))
    way = run.way("right")
    speed = np.linalg.norm(np.diff(way, axis=0), axis=1) * 15  # [m/s]
    left = np.linalg.norm(way[:-1] - PLACE, axis=1)
    closing = int(np.argmax(run.openings("right") < 0.045))
    near, before = (left < 0.005)[:closing], ((left > 0.04) & (left < 0.10))[:closing]
    assert speed[:closing][near].max() < 0.03
    assert speed[:closing][before].max() > 0.04


def test_a_miss_ends_open_and_drawn_back():
    run, failure = taken(PerceptionFailure(Problem.NOTHING_SEEN, "cloth"))
    assert failure == Reason.GRASP_MISSED
    assert run.openings("right")[-1] > 0.08
    assert run.way("right")[-1, 2] > PLACE[2] + 0.05  # [m]
