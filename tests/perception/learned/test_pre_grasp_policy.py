"""What the head camera sees of a gown in one hand, drawn anew for the policy; and its action, in the map."""

from __future__ import annotations

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure
from caretree.perception.image.surfaces import Surface
from caretree.perception.learned.pre_grasp_policy import chosen_pre_grasp, level_views
from caretree.sim.pregrasp.numbers import ACTION, DIRECT, PRIMITIVES, VIEWS
from caretree.sim.pregrasp.views import UP, Views
from caretree.sim.world import Frame

HAND = np.array((2.0, 1.0, 1.5))  # [m]
DOWN = 0.4  # by which the head looks down [rad]
YAW = 0.7  # of the hand [rad]


def hand_pose(yaw: float = YAW) -> np.ndarray:
    """(4, 4) of a hand that points down, turned about the vertical."""
    pose = np.eye(4)
    pose[:3, :3] = np.array(((np.cos(yaw), -np.sin(yaw), 0.0), (np.sin(yaw), np.cos(yaw), 0.0), (0.0, 0.0, 1.0)))
    pose[:3, :3] = pose[:3, :3] @ np.diag((-1.0, 1.0, -1.0))
    pose[:3, 3] = HAND
    return pose


def frame(distance: float = 1.0) -> Frame:
    """A head that looks along x and down at an upright sheet below the hand, 0.4 m wide and 0.8 m long."""
    forward = np.array((np.cos(DOWN), 0.0, -np.sin(DOWN)))
    right = np.array((0.0, -1.0, 0.0))
    pose = np.eye(4)
    pose[:3, :3] = np.column_stack([right, np.cross(forward, right), forward])
    pose[:3, 3] = HAND + (-distance, 0.0, 0.1)
    fx, cx, cy = 250.0, 159.5, 119.5
    v, u = np.mgrid[:240, :320].astype(float)
    rays = np.stack([(u - cx) / fx, (v - cy) / fx, np.ones_like(u)], 2) @ pose[:3, :3].T
    depth = distance / rays[..., 0]  # of the plane x = HAND[0]
    at = pose[:3, 3] + depth[..., None] * rays - HAND
    sheet = (np.abs(at[..., 1]) < 0.2) & (at[..., 2] < 0.0) & (at[..., 2] > -0.8)
    return Frame(
        camera="head",
        stamp=3.0,
        rgb=np.full((240, 320, 3), 200, np.uint8),
        depth=np.where(sheet, depth, 0.0).astype(np.float32),
        intrinsics=(fx, fx, cx, cy),
        pose_camera_in_map=pose,
    )


def cloth(seen: Frame) -> np.ndarray:
    return np.where(seen.depth > 0, Surface.OUTSIDE, Surface.OTHER)


class Told:
    """A policy whose values are highest at a place in the map, or next to it."""

    def __init__(self, place: np.ndarray, primitive: int = DIRECT) -> None:
        self.place, self.primitive = place, primitive

    def values(self, views: Views) -> np.ndarray:
        values = np.full((len(views.depth), len(PRIMITIVES), *views.depth.shape[1:]), -np.inf)
        places, spots = views.places()
        yaw = np.array(((np.cos(-YAW), -np.sin(-YAW), 0.0), (np.sin(-YAW), np.cos(-YAW), 0.0), (0.0, 0.0, 1.0)))
        view, row, column = spots.T
        values[view, self.primitive, row, column] = -np.linalg.norm(places - yaw @ (self.place - HAND), axis=1)
        return values

    def confidence(self, value: float) -> float:
        return float(np.exp(value))


WANTED = HAND + (0.0, 0.15, -0.6)


def test_a_level_picture_shows_the_sheet_where_it_is() -> None:
    views = level_views([frame()], cloth, [hand_pose()])
    assert views.turn(0) == pytest.approx(-YAW)
    places, _ = views.places()
    assert (places[:, 2].min(), places[:, 2].max()) == (pytest.approx(-0.8, abs=0.02), pytest.approx(0.0, abs=0.02))
    around = np.array((np.cos(-YAW), np.sin(-YAW), 0.0))
    assert np.abs(places @ around).max() < 0.01
    assert np.abs(places @ np.cross(UP, around)).max() == pytest.approx(0.2, abs=0.02)
    whole = 0.4 * 0.8 / VIEWS.pixel**2
    assert len(places) == pytest.approx(whole, rel=0.1)  # without holes
    assert (views.rgb[views.depth > 0] == 200).all()


@pytest.mark.parametrize(("primitive", "aside"), [(0, 1.0), (1, 0.0), (2, -1.0)])
def test_the_fingers_go_where_the_policy_says(primitive: int, aside: float) -> None:
    frames, poses = [frame(1.3), frame(1.0)], [hand_pose(YAW + 0.5), hand_pose()]
    found = chosen_pre_grasp(Told(WANTED, primitive), frames, cloth, poses_hand_in_map=poses, distance=(0.1, 2.0))
    assert (found.view, found.primitive, found.stamp) == (1, PRIMITIVES[primitive], 3.0)
    assert np.linalg.norm(found.position_in_map - WANTED) < 0.02
    assert np.allclose(found.approach_in_map, (np.cos(ACTION.yaw), np.sin(ACTION.yaw), 0.0), atol=1e-6)
    left = np.array((-np.sin(ACTION.yaw), np.cos(ACTION.yaw), 0.0))
    assert np.allclose(found.sweep_in_map, aside * ACTION.sweep * left, atol=1e-6)
    assert np.allclose(found.corner_in_map, found.position_in_map + found.sweep_in_map)
    assert found.confidence > 0.97


def test_what_failed_or_is_out_of_reach_is_left_out() -> None:
    pose = hand_pose()
    tried = pose[:3, :3].T @ (WANTED - HAND)
    given = {"poses_hand_in_map": [pose], "distance": (0.1, 2.0)}
    other = chosen_pre_grasp(Told(WANTED), [frame()], cloth, exclude=[tried], **given)
    assert 0.07 <= np.linalg.norm(other.corner_in_map - WANTED) < 0.1
    near = chosen_pre_grasp(Told(WANTED), [frame()], cloth, poses_hand_in_map=[pose], distance=(0.1, 0.4))
    assert np.linalg.norm(near.corner_in_map - HAND) == pytest.approx(0.4, abs=0.02)
    with pytest.raises(PerceptionFailure):
        chosen_pre_grasp(Told(WANTED), [frame()], cloth, poses_hand_in_map=[pose], distance=(3.0, 4.0))


def test_without_a_gown_there_is_nothing_to_choose() -> None:
    with pytest.raises(PerceptionFailure):
        level_views([frame()], lambda seen: np.zeros(seen.depth.shape, np.uint8), [hand_pose()])
