"""Estimates of the network in the types of the other senses; what is not sure is not said."""

from types import SimpleNamespace

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.estimates import ArmPosture, GownSide, GraspPoint
from caretree.perception.image.surfaces import Surface
from caretree.perception.learned.learned_sight import JOINTS, LearnedSight
from caretree.perception.learned.sight import KeyPoint, Sight

FRAME = SimpleNamespace(stamp=2.5, pose_camera_in_map=np.eye(4))


def sight(confidence=0.9, place=(1.0, 0.0, 0.5), surface=Surface.OUTSIDE):
    point = KeyPoint(
        confidence=confidence, position_in_map=None if place is None else np.array(place), pixel=np.zeros(2)
    )
    names = ["hook", *(f"{what}_left" for what in ("corner", "strap", *JOINTS))]
    return Sight(
        surfaces=np.full((20, 20), surface, np.uint8),
        confidence=np.ones((20, 20)),
        sheet=np.zeros((20, 20, 3)),
        key_points=dict.fromkeys(names, point),
    )


def sees(*sights):
    given = iter(sights)
    return LearnedSight(SimpleNamespace(see=lambda frame, bed_in_map: next(given)))


def test_key_points_become_grasps():
    grasp = sees(sight()).corner(FRAME, "left")
    assert isinstance(grasp, GraspPoint)
    assert (grasp.target, grasp.stamp, grasp.confidence) == ("collar_corner_left", 2.5, 0.9)
    assert np.allclose(grasp.approach_in_map, (1, 0, 0))
    assert np.isclose(grasp.closing_in_map @ grasp.approach_in_map, 0)
    assert sees(sight()).strap(FRAME, "left").target == "sleeve_left"
    assert sees(sight()).hook(FRAME).target == "near_hang"


def test_one_frame_is_seen_once():
    seer = sees(sight())
    seer.hook(FRAME)
    assert seer.gown_side(FRAME) == GownSide(stamp=2.5, confidence=1.0, outside=True)


@pytest.mark.parametrize(("camera", "name"), [("head", "packaged_network"), ("right_hand", "packaged_hand_network")])
def test_a_hand_s_camera_has_a_network_of_its_own(camera, name, monkeypatch):
    monkeypatch.setattr(f"caretree.perception.learned.learned_sight.{name}", lambda: SimpleNamespace(see=see))

    def see(frame, bed_in_map):
        return sight(confidence=0.7)

    frame = SimpleNamespace(camera=camera, stamp=2.5, pose_camera_in_map=np.eye(4))
    assert LearnedSight().hook(frame).confidence == 0.7


def test_the_inside_is_told():
    assert not sees(sight(surface=Surface.INSIDE)).gown_side(FRAME).outside


def test_what_is_not_sure_is_not_said():
    with pytest.raises(PerceptionFailure) as unsure:
        sees(sight(confidence=0.4)).corner(FRAME, "left")
    assert unsure.value.problem == Problem.NOTHING_SEEN
    with pytest.raises(PerceptionFailure) as deep:
        sees(sight(place=None)).strap(FRAME, "left")
    assert deep.value.problem == Problem.NO_DEPTH
    with pytest.raises(PerceptionFailure):
        sees(sight(surface=Surface.SKIN)).gown_side(FRAME)


def test_an_arm_has_four_joints_and_is_as_sure_as_the_least_of_them():
    arm = sees(sight()).arm(FRAME, "left")
    assert isinstance(arm, ArmPosture)
    assert arm.points_in_map.shape == (4, 3)
    assert arm.confidence == 0.9
    assert np.allclose(arm.deviation, 0.05 / 0.9)
