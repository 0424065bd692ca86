"""Who may come how near to what."""

import numpy as np
import pytest
from caretree.skills.geometry.clearance import CLEARANCE, LinkClearance, link_kind
from caretree.skills.geometry.person_zone import PersonZone

NAMES = ("left_finger_1", "left_palm_1", "left_forearm", "right_finger_1")
RADII = np.full(4, 0.05)


def zone():
    """Head, trunk and right arm as balls of 10 cm on the x axis, 1 m apart."""
    made = PersonZone(np.zeros((2, 3)))
    for x, part in enumerate(("head", "trunk", "right arm")):
        made.update(np.array((float(x), 0.0, 0.0)), part=part, radius=0.1)
    return made


def room_at(place, **options):
    ends = np.broadcast_to(np.asarray(place, float), (4, 2, 3))
    return LinkClearance(NAMES, RADII).room(ends, zone(), options.pop("held", {}), **options)


def test_what_is_left_of_a_gap_depends_on_the_link_and_on_the_part():
    room, away = room_at((0.0, 0.0, 0.3))  # 15 cm over the head
    assert room[:, 0] == pytest.approx(
        0.15 - np.array((CLEARANCE.fingers_head, CLEARANCE.palm_head, CLEARANCE.link_head, CLEARANCE.fingers_head))
    )
    assert away[0, 0] == pytest.approx((0.0, 0.0, 1.0))
    at_arm = room_at((2.0, 0.0, 0.3))[0]
    assert at_arm[0, 2] > at_arm[1, 2] > at_arm[2, 2], "fingers come nearest"


def test_nothing_may_touch_the_head():
    touching = room_at((0.0, 0.0, 0.15))[0]
    assert (touching[:, 0] < 0.0).all()


def test_a_hand_may_touch_the_arm_that_it_holds_and_no_other_part():
    inside = room_at((2.0, 0.0, 0.05), held={"left": "right arm"})[0]
    assert (inside[:2, 2] > 1.0).all()
    assert (inside[2:, 2] < 0.0).all(), "neither its own forearm nor the other hand"
    assert (room_at((1.0, 0.0, 0.05), held={"left": "right arm"})[0][:, 1] < 0.0).all()


def test_a_way_leads_round_an_arm_that_the_other_hand_holds_up():
    """A finger that was let 2 cm nearer met it with 35 N."""
    clearance, parts, held = LinkClearance(NAMES, RADII), ("head", "right arm"), {"left": "right arm"}
    acting, planned = (clearance.least_gaps(parts, held, planned=which) for which in (False, True))
    assert planned[3, 1] == CLEARANCE.lifted_arm > acting[3, 1] == CLEARANCE.fingers_arm
    assert (planned[:3] == acting[:3]).all(), "the arm that holds it stays where it is"
    assert (planned[:, 0] == acting[:, 0]).all(), "the head"


@pytest.mark.parametrize(
    ("name", "kind"),
    [("left_finger_2", "fingers"), ("right_wrist_2", "palm"), ("right_wrist_1", "link"), ("torso_1", "link")],
)
def test_kinds_of_links(name, kind):
    assert link_kind(name) == kind
