from pathlib import Path

import numpy as np
import pytest
from caretree.sim.log.episode import episode_of
from caretree.sim.log.robot_log import JointRoles, Picture, RobotLog

JOINTS = ("l0", "r0", "head", "lf0", "lf1", "rf0", "rf1", "bx", "by", "byaw")
ROLES = JointRoles(arms=("l0", "r0"), fingers=(("lf0", "lf1"), ("rf0", "rf1")), head="head", base=("bx", "by", "byaw"))


def log(t, sent=(), pictures=(), **given):
    t = np.array(t, float)
    joints = {name: np.zeros((len(t), 3)) for name in JOINTS}
    for name, values in given.items():
        joints[name] = np.array(values, float)
    return RobotLog(
        path=Path("run.mcap"),
        robot="two arms",
        roles=ROLES,
        t=t,
        joints=joints,
        twist_base=np.zeros((len(t), 3)),
        wrench_hand=np.zeros((len(t), 2, 6)),
        sent=list(sent),
        pictures={"head": list(pictures)} if pictures else {},
    )


def column(episode, feature, name):
    found = episode.features[feature]
    return found.values[:, found.names.index(name)].tolist()


def rows(*positions):
    return [(position, 0.0, 0.0) for position in positions]


def test_a_row_has_what_was_measured_last_and_nothing_later():
    episode = episode_of(log([5.0, 5.15, 5.3], l0=rows(1, 2, 3)), rate=10)
    assert len(episode) == 4
    assert column(episode, "observation.state", "l0.pos") == [1, 1, 2, 3]


def test_an_arms_action_is_where_it_is_a_row_later():
    episode = episode_of(log([0.0, 0.1, 0.2], l0=rows(1, 2, 3)), rate=10)
    assert column(episode, "action", "l0.pos") == [2, 3, 3]


def test_a_grippers_opening_is_that_of_both_fingers_and_its_action_what_it_was_sent():
    sent = [(0.1, {"command": "GripperOpening", "side": "left", "opening": 0.0, "force_limit": 30.0})]
    fingers = {"lf0": rows(0.02, 0.02, 0.01), "lf1": rows(0.02, 0.02, 0.01)}
    episode = episode_of(log([0.0, 0.1, 0.2], sent, **fingers), rate=10)
    assert column(episode, "observation.state", "left_gripper.opening") == pytest.approx([0.04, 0.04, 0.02])
    assert column(episode, "action", "left_gripper.opening") == pytest.approx([0.04, 0.0, 0.0])
    assert column(episode, "action", "right_gripper.opening") == [0.0, 0.0, 0.0]


def test_a_speed_holds_for_its_duration_until_the_next_one_or_a_stop():
    def move(time, speed, duration=0.2):
        return time, {"command": "BaseVelocity", "velocity": [speed, 0.0, 0.0], "duration": duration}

    sent = [move(0.0, 0.5), move(0.1, 0.4), move(0.5, 0.3, 1.0), (0.7, {"command": "stop"})]
    episode = episode_of(log(np.arange(11) / 10.0, sent), rate=10)
    assert column(episode, "action", "base.x.vel") == pytest.approx([0.5, 0.4, 0.4, 0, 0, 0.3, 0.3, 0, 0, 0, 0])


def test_a_hands_twist_is_told_beside_the_action():
    twist = {"command": "HandTwist", "side": "right", "twist_in_map": [1, 2, 3, 4, 5, 6], "duration": 0.2}
    episode = episode_of(log([0.0, 0.1, 0.2, 0.3], [(0.1, twist)]), rate=10)
    assert column(episode, "sent.hand_twist", "right_hand.linear.x") == [0, 1, 1, 0]
    assert column(episode, "sent.hand_twist", "right_hand.angular.z") == [0, 6, 6, 0]
    assert column(episode, "sent.hand_twist", "left_hand.linear.x") == [0, 0, 0, 0]


def test_a_number_that_was_not_known_is_as_it_was_last():
    episode = episode_of(log([0.0, 0.1, 0.2, 0.3], l0=rows(np.nan, 2, np.nan, 4)), rate=10)
    assert column(episode, "observation.state", "l0.pos") == [0, 2, 2, 4]


def test_a_picture_is_shown_until_the_next_one():
    first, second = Picture(time=0.1, data=b"1"), Picture(time=0.25, data=b"2")
    episode = episode_of(log([0.0, 0.1, 0.2, 0.3], pictures=[first, second]), rate=10)
    assert episode.pictures == {"head": [None, first, first, second]}


def test_a_camera_that_showed_nothing_in_time_is_left_out():
    episode = episode_of(log([0.0, 0.1], pictures=[Picture(time=3.0, data=b"1")]), rate=10)
    assert episode.pictures == {}
