"""Where an arm comes to rest, which arm a hand holds, and when an arm lies; the way down: test_release_arm."""

from collections import deque
from dataclasses import replace

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.image.cloud import unit
from caretree.perception.person.arm_fit import turned_about_shoulder
from caretree.skills.belief.person_tracking import Watch, doubt_arms, posture_in_hand
from caretree.skills.control.arm_grip import over_arm
from caretree.skills.control.lowering import (
    LOWERING,
    carried_by_bed,
    held_arm,
    lies,
    lower_arm,
    resting_place,
    share_of_way,
)
from caretree.skills.core.reasons import Reason, SkillFailure
from caretree.skills.geometry.arm_path import ArmPath
from caretree.skills.geometry.hold import Hold
from caretree.skills.geometry.stances import HEADWARD, outwards
from caretree.skills.scripted.scripted_person import lying_posture

from ..bench import above_arm, beside_bed
from ..moving import idle


def skill(**options):
    """A skill of a robot beside the bed that may look and does nothing."""
    return idle(beside_bed(**options)()[1])


def raised(side, height=0.17, aside=0.0):
    """An arm whose elbow is so much higher than where it rests, and farther away from the body [m]."""
    posture = lying_posture(side)
    elbow = posture.points_in_map[1] + (0.0, 0.0, height) + aside * outwards(side)
    return replace(posture, points_in_map=turned_about_shoulder(posture.points_in_map, 1.0, elbow))


@pytest.mark.parametrize(("height", "expected"), [(0.0, True), (0.01, True), (0.04, False), (0.17, False)])
def test_an_arm_lies_where_all_of_it_is_near_the_mattress(height, expected):
    assert lies(skill(), raised("right", height)) is expected


def test_an_arm_whose_forearm_alone_is_up_does_not_lie():
    posture = lying_posture("right")
    points = posture.points_in_map.copy()
    points[2:, 2] += 0.1
    assert not lies(skill(), replace(posture, points_in_map=points))


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("coordinate", [1.0, 1.5])
def test_an_arm_comes_to_rest_below_where_it_is_about_its_shoulder(side, coordinate):
    posture = raised(side)
    here, shoulder = ArmPath.of(posture).point(coordinate), posture.points_in_map[0]
    place = resting_place(skill(), side, posture, coordinate)
    assert np.linalg.norm(place - shoulder) == pytest.approx(np.linalg.norm(here - shoulder))
    assert place[2] == pytest.approx(0.64)  # [m], the mattress is at 0.60
    now, then = (np.arctan2((p - shoulder) @ outwards(side), (p - shoulder) @ -HEADWARD) for p in (here, place))
    assert then <= now + 1e-9, "never farther out"


@pytest.mark.parametrize("side", ["left", "right"])
def test_an_arm_that_would_reach_over_the_edge_is_drawn_in_until_the_wrist_rests_on_the_bed(side):
    wide = raised(side, aside=0.15)
    wrist = resting_place(skill(), side, wide, 2.0)
    assert wide.points_in_map[2] @ outwards(side) > 0.52
    assert wrist @ outwards(side) == pytest.approx(0.5, abs=0.03)  # [m], half the bed's width


@pytest.mark.parametrize("side", ["left", "right"])
def test_an_arm_is_spread_as_far_as_asked_and_the_mattress_is_wide(side):
    def heading(spread):
        asked = replace(LOWERING, spread=spread)
        wrist = resting_place(skill(), side, narrow, 2.0, tuning=asked) - narrow.points_in_map[0]
        return float(np.arctan2(wrist @ outwards(side), wrist @ -HEADWARD))

    narrow = raised(side, aside=-0.10)
    assert heading(0.0) < 0.4, "straight down"
    assert heading(0.5) == pytest.approx(0.5)
    on_the_edge = heading(1.2)
    assert 0.5 < on_the_edge < 0.8
    assert heading(0.9) == pytest.approx(on_the_edge)


def test_the_arm_that_a_hand_holds_is_the_one_between_its_fingers():
    unseen = PerceptionFailure(Problem.NOTHING_SEEN, "person")
    asks = skill(hands={"left": over_arm(raised("right"), 1.3, 0.0)}, arm=unseen, head=unseen)
    watch = asks.context.memory.of(Watch, Watch)
    assert held_arm(asks, "left") is None, "nobody has been seen"
    watch.arms["left"] = raised("left")
    assert held_arm(asks, "left") is None, "the other arm is too far away"
    watch.arms.update({each: raised(each) for each in ("left", "right")})
    arm, hold = held_arm(asks, "left")
    assert (arm, hold.hand) == ("right", "left")
    assert hold.coordinate == pytest.approx(1.3, abs=0.02)


def test_an_arm_whose_owner_has_moved_is_lowered_about_its_shoulder_found_or_not():
    unseen = PerceptionFailure(Problem.NOTHING_SEEN, "person")
    hand = over_arm(raised("right"), 1.3, 0.0)
    asks = skill(hands={"left": hand}, arm=unseen, head=unseen, relocalised_arm=unseen)
    watch = asks.context.memory.of(Watch, Watch)
    watch.arms["right"] = raised("right", aside=0.1)
    doubt_arms(asks)
    assert held_arm(asks, "left") is None, "nobody said that the hand holds it"
    asks.context.guard.held_arms = lambda: {"left": "right arm"}
    arm, hold = held_arm(asks, "left")
    assert (arm, hold.hand) == ("right", "left")
    there = posture_in_hand(asks, arm, hold)
    assert there.points_in_map[0] == pytest.approx(watch.before["right"].points_in_map[0])
    on_axis = unit(ArmPath.of(there).point(hold.coordinate) - there.points_in_map[0])
    assert on_axis == pytest.approx(unit(hand[:3, 3] - there.points_in_map[0]), abs=1e-4)
    assert not watch.arms, "and nothing is believed of it otherwise"


@pytest.mark.parametrize("doubted", [False, True])
def test_what_is_known_of_an_arm_follows_a_hand_that_could_not_lower_it(doubted):
    unseen = PerceptionFailure(Problem.NOTHING_SEEN, "person")
    hand = over_arm(raised("right", height=0.08), 1.3, 0.0)
    asks = skill(hands={"left": hand}, arm=unseen, head=unseen, relocalised_arm=unseen)
    watch = asks.context.memory.of(Watch, Watch)
    watch.arms["right"] = raised("right")
    if doubted:
        doubt_arms(asks)
    held = "right", Hold("left", 1.3)
    with pytest.raises(SkillFailure) as failed:
        for _ in lower_arm(asks, "left", held, tuning=replace(LOWERING, timeout=-1.0)):
            pass
    assert failed.value.reason == Reason.TIMEOUT
    known = (watch.before if doubted else watch.arms)["right"]
    assert np.linalg.norm(ArmPath.of(known).point(1.3) - hand[:3, 3]) < 0.02


@pytest.mark.parametrize(("coordinate", "share"), [(0.1, 0.1), (0.5, 0.5), (1.0, 1.0), (1.8, 1.0)])
def test_cloth_nearer_to_the_shoulder_comes_down_by_less_as_the_arm_does(coordinate, share):
    """As fast as the wrist, the hand with the strap pressed the upper arm with 32 N (102)."""
    posture = lying_posture("right")
    asks = skill(arm=posture, hands={"left": over_arm(posture, 1.0, 0.0), "right": above_arm(coordinate, 0.2)})
    assert share_of_way(asks, "left", "right", ("right", Hold("left", 1.0))) == 1.0, "nobody knows of the arm"
    asks.context.memory.of(Watch, Watch).arms["right"] = posture
    assert share_of_way(asks, "left", "right", None) == 1.0
    assert share_of_way(asks, "left", "right", ("right", Hold("left", 1.0))) == pytest.approx(share, abs=0.15)


def moved_on(aside, height, push):
    """Whether the bed carries an arm, by 2 s of a hand that goes `aside` [m/s] at a height [m], pushed up [N]."""
    window, load = deque(), np.array((0.0, 0.0, push))
    ways = [(t, np.array((aside * t, 0.0, height))) for t in np.arange(0.0, 2.0, 1 / 15)]
    told = [carried_by_bed(window, t, place, load, LOWERING) for t, place in ways]
    return any(told)


def test_a_hand_that_still_goes_aside_does_not_stand():
    assert not moved_on(0.03, 0.22, 2.0)
    with pytest.raises(SkillFailure, match=r"stands 0\.22 m") as stop:
        moved_on(0.0, 0.22, 2.0)
    assert stop.value.reason == Reason.MOTION_BLOCKED


def test_the_bed_carries_an_arm_that_slides_on_it():
    assert moved_on(0.03, 0.05, LOWERING.bed_load + 1.0)
