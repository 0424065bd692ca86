from dataclasses import replace

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.estimates import ChestFront, Head
from caretree.sim.scripted.world import ScriptedWorld
from caretree.sim.world import Frame
from caretree.skills.belief.person_tracking import (
    bare_share,
    careful,
    doubt_arms,
    hand_share,
    head_view,
    see_person,
    swung_to,
    visible_share,
    watch_arm,
    watch_of,
)
from caretree.skills.core.context import Context
from caretree.skills.core.skill import Skill
from caretree.skills.geometry.hold import Hold
from caretree.skills.geometry.person_zone import TRUNK
from caretree.skills.scripted.scripted_person import lying_posture
from caretree.trees.guard.guard import GuardedWorld

from ..fake_senses import fake_senses

DOWN = np.array(((0.0, 1.0, 0.0, 0.4), (1.0, 0.0, 0.0, -0.2), (0.0, 0.0, -1.0, 2.2), (0.0, 0.0, 0.0, 1.0)))


def looking_down(stamp=0.0, covered=(), colour=(0, 0, 0)):
    """A view straight down on the bed, whose mattress is 1.6 m away; `covered` pixel columns show something nearer."""
    depth = np.full((150, 200), 1.6, np.float32)
    depth[:, list(covered)] = 1.2
    depth += 1e-3 * np.random.default_rng(int(1000 * stamp)).standard_normal(depth.shape).astype(np.float32)
    rgb = np.full((150, 200, 3), colour, np.uint8)
    return Frame(
        camera="head",
        stamp=stamp,
        rgb=rgb,
        depth=depth,
        intrinsics=(150.0, 150.0, 100.0, 75.0),
        pose_camera_in_map=DOWN,
    )


HIDDEN = PerceptionFailure(Problem.OUT_OF_REACH, "chest of the person")
LOST = PerceptionFailure(Problem.ARM_LOST, "right arm")
HEAD = Head(stamp=0.0, confidence=0.9, crown_in_map=np.array((0.0, -0.86, 0.72)), middle=0.0)


class Watcher(Skill):
    commands = False


def make(arm, elsewhere=LOST, frames=None, head=HEAD, chest=HIDDEN):
    """A skill that sees an arm as `arm` says, and as `elsewhere` says where it does not show any more."""
    world = ScriptedWorld(frames=frames or (lambda camera, time: looking_down(time)))
    guard = GuardedWorld(world)
    senses = fake_senses(arm=arm, relocalised_arm=elsewhere, head=head, chest_front=chest)
    context = Context(world=guard, guard=guard, senses=senses)
    return Watcher("watch", context), world


def test_one_look_serves_several_ticks():
    asked = []
    skill, world = make(lambda frame, side: asked.append(frame.stamp) or lying_posture(side))
    for _ in range(15):
        watch_arm(skill, "right")
        world.clock.wait_until(world.clock.now() + 1 / 15)
    assert 3 <= len(asked) <= 5
    assert skill.context.guard.zone.seen("right arm")


def test_an_arm_in_front_of_where_it_was_is_not_hidden():
    lifted = range(200)
    assert visible_share(looking_down(covered=lifted), lying_posture("right")) == 0.0
    assert visible_share(looking_down(covered=lifted, colour=(214, 158, 124)), lying_posture("right")) == 1.0


def test_an_arm_is_bare_where_skin_shows():
    """Cloth that lies right on it hides nothing by its depth."""
    everywhere = range(200)
    assert bare_share(looking_down(covered=everywhere, colour=(214, 158, 124)), lying_posture("right")) == 1.0
    assert bare_share(looking_down(covered=everywhere), lying_posture("right")) == 0.0


def test_an_arm_under_cloth_is_taken_to_stay_and_is_lost_in_the_end():
    covered, asked, searched = [], [], []

    def arm(frame, side):
        asked.append(frame.stamp)
        return lying_posture(side)

    def elsewhere(frame, side):
        searched.append(frame.stamp)
        return LOST

    skill, world = make(arm, elsewhere, lambda camera, time: looking_down(time, covered))
    assert visible_share(looking_down(), lying_posture("right")) == 1.0
    first = watch_arm(skill, "right", period=0.0)
    covered.extend(range(200))
    assert visible_share(looking_down(covered=covered), first) == 0.0
    world.clock.wait_until(5.0)
    assert watch_arm(skill, "right", period=0.0, patience=10.0) is first
    watch_arm(skill, "right", period=0.0, patience=10.0)
    assert len(asked) == 1, "a tracker would follow what is not the arm"
    assert searched == [5.0], "looking for it all over the picture takes its time"
    world.clock.wait_until(11.0)
    with pytest.raises(PerceptionFailure) as lost:
        watch_arm(skill, "right", period=0.0, patience=10.0)
    assert lost.value.problem == Problem.ARM_LOST


def test_an_arm_in_its_sleeve_has_stayed_where_its_hand_shows():
    """Its sleeve hid it for 300 s, and then it was not drawn up any more, 20 times in turn (128)."""
    there, bare_from = lying_posture("right"), [0]

    def frame(camera, time):
        seen = looking_down(time, range(200))
        seen.rgb[:, bare_from[-1] :], seen.depth[:, bare_from[-1] :] = (214, 158, 124), 1.55
        return seen

    skill, world = make(lambda frame, side: there, frames=frame)
    first = watch_arm(skill, "right", period=0.0)
    bare_from.append(103)  # the column of the wrist
    world.clock.wait_until(11.0)
    assert hand_share(frame("head", 11.0), there) > 0.75 > visible_share(frame("head", 11.0), there)
    assert watch_arm(skill, "right", period=0.0, patience=10.0) is first
    bare_from.append(200)
    world.clock.wait_until(20.0)
    assert watch_arm(skill, "right", period=0.0, patience=10.0) is first
    world.clock.wait_until(22.0)
    with pytest.raises(PerceptionFailure):
        watch_arm(skill, "right", period=0.0, patience=10.0)


def test_skin_that_is_not_where_a_hand_was_is_not_that_hand():
    nearer = looking_down(covered=range(200), colour=(214, 158, 124))
    assert hand_share(nearer, lying_posture("right")) == 0.0


@pytest.mark.parametrize(("off", "deviation", "stays"), [(0.1, 0.05, True), (0.1, 0.02, False), (0.14, 0.09, False)])
def test_an_arm_that_is_seen_less_well_where_it_was_known_well_has_stayed(off, deviation, stays):
    """Half hidden, its hand was seen 0.11 m aside, and the arm that lay in its sleeve was begun again (175)."""
    there = lying_posture("right")
    aside = there.points_in_map + np.array(((0, 0, 0), (0, 0, 0), (0, 0, 0), (off, 0, 0)))
    seen = [there, replace(there, points_in_map=aside, deviation=np.full(4, deviation))]
    skill, _ = make(lambda frame, side: seen.pop(0))
    watch_arm(skill, "right", period=0.0)
    again = watch_arm(skill, "right", period=0.0)
    np.testing.assert_array_equal(again.points_in_map, there.points_in_map if stays else aside)


def test_an_arm_whose_wrist_was_seen_closely_has_swung_about_its_shoulder():
    there = lying_posture("right")
    skill, _ = make(lambda frame, side: there)
    watch_arm(skill, "right", period=0.0)
    arm = there.points_in_map[2] - there.points_in_map[0]
    across = np.cross(arm, (0.0, 0.0, 1.0))
    wrist = there.points_in_map[2] + 0.04 * across / np.linalg.norm(across)
    swung = swung_to(skill, "right", 2.0, wrist).points_in_map
    np.testing.assert_array_equal(swung[0], there.points_in_map[0])
    assert np.linalg.norm(wrist - swung[2]) < 0.005, "as near as an arm of its length comes [m]"
    assert np.linalg.norm(swung[3] - there.points_in_map[3]) > 0.04
    assert watch_of(skill).arms["right"].points_in_map is swung
    zone = skill.context.guard.zone
    assert zone.distance(swung[3])[0] == 0.0 < zone.distance(there.points_in_map[3])[0], "the guard knows"


def test_an_arm_that_is_found_elsewhere_is_taken_to_be_there():
    there = lying_posture("right")
    elsewhere = replace(there, points_in_map=there.points_in_map + (0.2, 0.0, 0.0))
    covered = []
    skill, world = make(there, elsewhere, lambda camera, time: looking_down(time, covered))
    watch_arm(skill, "right")
    covered.extend(range(200))
    world.clock.wait_until(1.0)
    assert watch_arm(skill, "right", hold=Hold("left", 0.9)).points_in_map[0] == pytest.approx(there.points_in_map[0])
    world.clock.wait_until(2.0)
    np.testing.assert_array_equal(watch_arm(skill, "right").points_in_map, elsewhere.points_in_map)


def test_who_looks_at_the_person_does_not_see_an_arm_that_is_covered():
    covered, searched = [], []
    there = lying_posture("right")
    elsewhere = replace(there, points_in_map=there.points_in_map + (0.2, 0.0, 0.0))

    def search(frame, side):
        searched.append(side)
        return elsewhere if side == "right" and len(searched) > 2 else LOST

    skill, world = make(
        lambda frame, side: lying_posture(side), search, lambda camera, time: looking_down(time, covered)
    )
    assert see_person(skill) == ["left", "right"]
    covered.extend(range(200))
    world.clock.wait_until(1.0)
    assert see_person(skill) == []
    assert searched == ["left", "right"]
    world.clock.wait_until(2.0)
    assert see_person(skill) == []
    assert len(searched) == 2, "looking for it all over the picture takes its time"
    world.clock.wait_until(4.0)
    assert see_person(skill) == ["right"]
    assert watch_of(skill).arms["right"].points_in_map == pytest.approx(elsewhere.points_in_map)


def test_the_chest_is_as_high_as_the_lowest_that_was_seen_of_it():
    heights = [0.24, 0.19, 0.26]

    def chest(frame, shoulders_in_map):
        height = heights.pop(0)
        return ChestFront(stamp=frame.stamp, confidence=1.0, height=height, breastbone=height - 0.03)

    skill, world = make(lying_posture("right"), chest=chest)
    zone, above, gaps = skill.context.guard.zone, np.array(((-0.1, -0.3, 1.0), (-0.1, -0.3, 1.0))), []
    while heights:
        see_person(skill)
        gaps.append(zone.gaps(above[None], np.zeros(1))[0][0, [name == TRUNK for name in zone.names]].min())
        world.clock.wait_until(world.clock.now() + 1.0)
    # [m] below the point; the mattress lies at 0.7
    assert gaps == pytest.approx((0.3 - 0.24, 0.3 - 0.19, 0.3 - 0.19), abs=0.01)


def test_after_the_person_has_moved_an_arm_is_unknown_until_it_is_found_anew():
    searched = []
    there = lying_posture("right")

    def anew(frame, side, moved):
        searched.append(moved)
        return LOST if len(searched) == 1 else replace(there, points_in_map=there.points_in_map + (0.1, 0.0, 0.0))

    skill, world = make(lambda frame, side: lying_posture(side), anew)
    watch_arm(skill, "right")
    doubt_arms(skill)
    with pytest.raises(PerceptionFailure):
        watch_arm(skill, "right", hold=Hold("left", 0.9))
    assert watch_arm(skill, "right").points_in_map == pytest.approx(there.points_in_map + (0.1, 0.0, 0.0))
    assert searched == [True, True]
    world.clock.wait_until(1.0)
    assert watch_arm(skill, "right").points_in_map == pytest.approx(there.points_in_map), "tracked as ever"
    assert skill.context.guard.zone.seen("right arm"), "the guard knows"


def test_those_who_ask_within_one_tick_share_a_picture():
    taken = []

    def frames(camera, time):
        taken.append(time)
        return looking_down(time)

    skill, world = make(lambda frame, side: lying_posture(side), frames=frames)
    assert head_view(skill) is head_view(skill)
    watch_arm(skill, "right", period=0.0)
    assert taken == [0.0]
    world.clock.wait_until(1 / 15)
    assert head_view(skill).stamp == pytest.approx(1 / 15)
    assert len(taken) == 2


def test_an_arm_never_found_is_not_invented():
    skill, _ = make(PerceptionFailure(Problem.NOTHING_SEEN, "right arm"))
    with pytest.raises(PerceptionFailure):
        watch_arm(skill, "right")


def test_hands_are_slow_near_what_was_seen_and_fast_elsewhere():
    skill, _ = make(lying_posture("right"))
    assert careful(skill, 0.5)(np.array((0.0, 0.0, 1.0))) == 0.13, "nobody seen yet: the person may be here"
    watch_arm(skill, "right")
    limit = careful(skill, 0.5)
    assert limit(np.array(((0.5, -0.2, 0.9), (1.2, 0.6, 1.2)))).tolist() == [0.13, 0.5]
