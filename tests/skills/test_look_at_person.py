"""An arm is found when it is known well, by turning the head if need be, and the guard is told of the person."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.estimates import Head
from caretree.sim.world import SIDES
from caretree.skills.core.reasons import Reason
from caretree.skills.look_at_person import LookAtPerson
from caretree.skills.scripted.scripted_person import lying_posture

from .bench import LeafBench, beside_bed

LIES = {side: lying_posture(side) for side in SIDES}
LOST = PerceptionFailure(Problem.ARM_LOST, "arm")
NOBODY = PerceptionFailure(Problem.NOTHING_SEEN, "head")
HEAD = Head(stamp=0.0, confidence=0.9, crown_in_map=np.array((0.0, -0.86, 0.72)), middle=0.0)


def known_to(deviation):
    """The right arm, each of its joints known to `deviation` [m]."""
    return replace(LIES["right"], deviation=np.full(4, deviation))


def bench(right, head=HEAD, frames=None, **options):
    """A look for the right arm, and the angles of the head at each look [rad].

    How the arm shows: a list of answers, the last for ever after, or a function of the head's angle.
    """
    looks = []

    def arm(frame, *, side):
        if side == "left":
            raise LOST
        looks.append(run.world.observe().head_pan)
        answer = right(looks[-1]) if callable(right) else right[min(len(looks), len(right)) - 1]
        if isinstance(answer, PerceptionFailure):
            raise answer
        return answer

    def hidden(frame, *, side):
        raise LOST

    run = LeafBench(
        lambda context: LookAtPerson("look", context, side="right", **options),
        beside_bed(arm=arm, relocalised_arm=hidden, head=head),
    )
    run.world._frames = frames or run.world._frames
    return run, looks


def test_an_arm_in_view_is_found_and_the_guard_knows_the_person():
    run, looks = bench([LIES["right"]])
    told = {}
    run.context.guard.update_person = lambda points, *, part="person", radius: told.update({part: (points, radius)})
    assert run.ended() is None
    assert run.skill.posture.points_in_map == pytest.approx(LIES["right"].points_in_map)
    assert set(told) == {"right arm", "trunk", "legs", "head"}
    assert told["right arm"][0] == pytest.approx(LIES["right"].points_in_map)
    for part, width in {"right arm": 0.04, "head": 0.10, "trunk": 0.11, "legs": 0.08}.items():
        assert told[part][1] == pytest.approx(width, abs=0.02)  # [m]
    assert np.ptp(looks) == 0.0, "the head stands"


@pytest.mark.parametrize("aside", [0.35, -0.35])
def test_the_head_turns_to_either_side_until_the_arm_shows(aside):
    run, _ = bench(lambda pan: LIES["right"] if abs(pan - aside) < 0.05 else LOST)
    assert run.ended() is None
    assert run.seen[-1].head_pan == pytest.approx(aside, abs=0.05)  # [rad]


def test_an_arm_that_is_not_known_well_yet_is_looked_at_again():
    run, looks = bench([known_to(0.06), known_to(0.04), known_to(0.03), known_to(0.01)])
    assert run.ended() is None
    assert run.skill.posture.deviation == pytest.approx(np.full(4, 0.03))  # [m]
    assert len(looks) == 3


@pytest.mark.parametrize(
    ("right", "head", "reason"),
    [
        ([LOST], HEAD, Reason.ARM_LOST),
        ([known_to(0.06)], HEAD, Reason.ARM_LOST),
        ([LOST], NOBODY, Reason.NOTHING_SEEN),
    ],
    ids=("arm hidden", "never known well", "nobody there"),
)
def test_what_shows_from_nowhere_is_told_after_a_look_all_round(right, head, reason):
    run, _ = bench(right, head)
    assert run.ended() == reason
    pans = [seen.head_pan for seen in run.seen]
    assert (min(pans), max(pans)) == pytest.approx((-0.35, 0.35), abs=0.05)


@pytest.mark.parametrize(("before", "reason"), [(0.02, None), (0.06, Reason.ARM_LOST)])
def test_an_arm_that_is_covered_now_lies_where_it_was_seen_well(before, reason):
    shows = [known_to(before)]
    run, _ = bench(lambda pan: shows[-1], lambda frame: HEAD if shows[-1] is not LOST else NOBODY)
    assert run.ended() == reason
    shows.append(LOST)
    assert run.ended() == (reason and Reason.NOTHING_SEEN), "the second round"
    assert max(seen.head_pan for seen in run.seen) > 0.3, "nothing covers it there: it has looked all round"
    if reason is None:
        assert run.skill.posture.deviation == pytest.approx(np.full(4, before))


def test_an_arm_under_cloth_is_not_found_where_it_was():
    heap = []

    def frames(camera, time):
        flat = run.world._flat_frame(camera, time)
        return replace(flat, depth=flat.depth - np.float32(sum(heap)))

    run, _ = bench([LIES["right"]], frames=frames)
    assert run.ended() is None
    assert "covered" not in run.skill.feedback_message
    heap.append(0.3)  # [m] of cloth over everything
    assert run.ended() is None
    assert "is covered" in run.skill.feedback_message
    assert np.ptp([seen.head_pan for seen in run.seen]) < 0.5, "what is covered does not show from elsewhere"
    assert run.skill.posture.points_in_map == pytest.approx(LIES["right"].points_in_map)


def test_the_head_turns_to_the_trunk_wherever_the_robot_stands():
    run, looks = bench([LIES["right"]], part="trunk")
    assert run.ended() is None
    assert not looks
    seen = run.seen[-1]
    x, y, yaw = seen.pose_base_in_map
    heading = np.array((np.cos(yaw + seen.head_pan), np.sin(yaw + seen.head_pan)))
    aside = np.cross(np.append(heading, 0.0), (0.0 - x, -0.3 - y, 0.0))[2]
    assert abs(aside) < 0.1, "the chest lies ahead [m]"
