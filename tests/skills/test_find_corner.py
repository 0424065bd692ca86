"""Looking for a corner of the hung gown's neckline from place to place."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.estimates import CORNER_OF, GraspPoint
from caretree.sim.scripted.world import ScriptedWorld
from caretree.skills.core.context import Context
from caretree.skills.find_corner import FindCorner
from caretree.trees.guard.guard import GuardedWorld
from py_trees.common import Status

from .fake_senses import fake_senses

HOOK = np.array((2.7, 0.4, 1.55))
NOTHING = PerceptionFailure(Problem.NOTHING_SEEN, "a corner")
DISTANCE = 1.0  # from the base to the hook [m]
SECOND_VIEW = np.deg2rad(-30.0)  # about the hook [rad]
BEHIND = {"rail_back": (2.7, 1.9, -np.pi / 2)}  # a waypoint
VIEWS = 3  # from one side of the rail


def grasp(target, place=HOOK, confidence=0.9):
    return GraspPoint(
        stamp=0.0,
        confidence=confidence,
        target=target,
        position_in_map=place,
        approach_in_map=np.array((0.0, 1.0, 0.0)),
        closing_in_map=np.array((1.0, 0.0, 0.0)),
    )


class Room:
    """The robot before the rail; `shown` answers where a corner is seen, `hung` one that was seen before."""

    def __init__(self, shown, hung=lambda side, near: NOTHING, waypoints=()):
        self.world = ScriptedWorld(seed=1)
        self.world.room.waypoints.update(waypoints)
        self.guard = GuardedWorld(self.world)
        self.asked = []

        def corner(frame, **details):
            self.asked.append(details["side"])
            return shown(len(self.asked), details["side"])

        self.context = Context(
            world=self.guard,
            guard=self.guard,
            seed=1,
            senses=fake_senses(
                hook=grasp("near_hang"),
                shown_corner=corner,
                hung_corner=lambda frame, **details: hung(details["side"], details["near_in_map"]),
            ),
        )

    def run(self):
        skill = FindCorner("find", self.context)
        for _ in range(2000):
            self.context.lease.advance()
            skill.tick_once()
            self.world.clock.wait_until(self.world.clock.now() + 1 / 15)
            if skill.status != Status.RUNNING:
                break
        return skill


def test_goes_round_until_one_shows():
    room = Room(lambda n, side: NOTHING if n < 2 else grasp(CORNER_OF["right"]))
    found = room.run()
    assert found.status == Status.SUCCESS
    assert (found.sleeve, found.other_sleeve, found.hand, found.other_hand) == ("right", "left", "left", "right")
    pose = room.world.observe().pose_base_in_map
    ahead = np.array((np.cos(pose[2]), np.sin(pose[2])))
    assert pose[:2] + DISTANCE * ahead == pytest.approx(HOOK[:2], abs=0.06)
    turns = [
        abs((pose[2] - room.world.room.waypoints[name][2] - SECOND_VIEW + np.pi) % (2 * np.pi) - np.pi)
        for name in ("rail", "rail_back")
        if name in room.world.room.waypoints
    ]
    assert min(turns) < 0.06


def test_asked_again_it_looks_for_the_other_one_first():
    room = Room(lambda n, side: grasp(CORNER_OF[side or "left"]))
    assert room.run().sleeve == "left"
    assert room.run().sleeve == "right"
    assert room.asked == [None, "right"]


def test_takes_the_same_again_where_the_other_shows_from_nowhere():
    room = Room(lambda n, side: NOTHING if side == "right" else grasp(CORNER_OF["left"]))
    room.run()
    assert room.run().sleeve == "left"
    assert room.asked == [None, *["right", None] * VIEWS, None]


def test_one_whose_side_does_not_show_any_more_is_found_where_it_was():
    was, swung = HOOK - (0.1, 0.0, 0.4), HOOK - (0.12, 0.0, 0.4)
    room = Room(
        lambda n, side: grasp(CORNER_OF["right"], was) if n == 1 else NOTHING,
        lambda side, near: grasp(CORNER_OF[side], swung) if np.allclose(near, was) else NOTHING,
    )
    assert room.run().sleeve == "right"
    again = room.run()
    assert (again.status, again.sleeve) == (Status.SUCCESS, "right")
    assert again.corner.position_in_map == pytest.approx(swung)
    assert len(room.asked) == 1 + 2 * VIEWS  # one that shows its side is preferred, from wherever it does


def test_one_that_shows_in_part_is_taken_where_none_shows_whole_from_behind():
    first, second = CORNER_OF["left"], CORNER_OF["right"]
    room = Room(lambda n, side: grasp(first, confidence=0.15) if n in (2, 7) else NOTHING, waypoints=BEHIND)
    found = room.run()
    assert (found.status, found.sleeve, len(room.asked)) == (Status.SUCCESS, "left", 2 * VIEWS + 1)
    assert ahead_of(room) @ ahead_at_start(room) > 0.0
    shown = {2: grasp(first, confidence=0.15), 5: grasp(second)}
    room = Room(lambda n, side: shown.get(n, NOTHING), waypoints=BEHIND)
    found = room.run()
    assert (found.status, found.sleeve) == (Status.SUCCESS, "right")
    assert ahead_of(room) @ ahead_at_start(room) < 0.0


def ahead_of(room):
    yaw = room.world.observe().pose_base_in_map[2]
    return np.array((np.cos(yaw), np.sin(yaw)))


def ahead_at_start(room):
    yaw = room.world.room.waypoints["rail"][2]
    return np.array((np.cos(yaw), np.sin(yaw)))


def test_fails_where_nothing_shows():
    assert Room(lambda n, side: NOTHING).run().status == Status.FAILURE
