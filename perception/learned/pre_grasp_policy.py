"""The pre-grasp policy: pictures of a gown that hangs from one hand, and what the other hand is to do there.

It was trained on level pictures of six directions.  The head camera looks down, and from where it happens to be; so
what it sees of the gown is drawn anew, as a level camera at the distance of training would see it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Protocol

import numpy as np

from ...sim.pregrasp.action import hand_path
from ...sim.pregrasp.affordance import best_action
from ...sim.pregrasp.numbers import PRIMITIVES, VIEWS, ViewNumbers
from ...sim.pregrasp.policy import Policy
from ...sim.pregrasp.views import UP, Views, camera_pose, lens
from ...sim.world import Frame
from ..errors import PerceptionFailure, Problem
from ..estimates import PreGrasp, Primitive
from ..image.projection import points_in_map
from ..image.surfaces import GOWN_SURFACES

PACKAGED = Path(__file__).parent / "weights" / "pregrasp.onnx"
FABRIC = 50  # pixels of a redrawn picture; with fewer there is no gown


class Chooser(Protocol):
    """What is needed of a policy: `Policy` has it."""

    def values(self, views: Views) -> np.ndarray:
        """(n, 3, H, W) value of each action, -inf where no gown shows."""
        ...

    def confidence(self, value: float) -> float:
        """Chance of success of an action of a value, 0 to 1."""
        ...


def chosen_pre_grasp(
    policy: Chooser,
    frames: Sequence[Frame],
    surfaces_in: Callable[[Frame], np.ndarray],
    *,
    poses_hand_in_map: Sequence[np.ndarray],
    distance: tuple[float, float],
    exclude: Sequence[np.ndarray] = (),
    same_place: float = 0.07,
) -> PreGrasp:
    """The best action of all views; `corner_in_map` is where the fingers close.

    Args:
        policy: that chooses.
        frames: views of the head camera, oldest first.
        surfaces_in: gives the (H, W) `Surface` of each pixel of a frame.
        poses_hand_in_map: (4, 4) of the holding hand at each frame, from the joint angles.
        distance: least and greatest distance from the holding hand of where the fingers go in [m].
        exclude: (3,) points in the frame of the holding hand that were tried in vain [m].
        same_place: distance from such a point within which an action is the same [m].

    Raises:
        PerceptionFailure: no view shows the gown, or none of it in reach is left.
    """
    views = level_views(frames, surfaces_in, poses_hand_in_map)
    values = policy.values(views)
    places, spots = views.places()
    away = np.linalg.norm(places, axis=1)
    barred = (away < distance[0]) | (away > distance[1])
    for k, pose in enumerate(poses_hand_in_map):  # the pictures' frame is level, the hand's is not
        turned = _upright(pose).T @ pose[:3, :3]
        for place in exclude:
            barred |= (spots[:, 0] == k) & (np.linalg.norm(places - turned @ place, axis=1) < same_place)
    view, row, column = spots[barred].T
    values[view, :, row, column] = -np.inf
    if not np.isfinite(values).any():
        raise PerceptionFailure(Problem.NOTHING_SEEN, "place on the gown to grasp, in any view")
    action = best_action(values, views)
    path, pose = hand_path(views, action), poses_hand_in_map[action.view]
    out = _upright(pose)
    sweep = path.end - path.inside
    place = views.place(action.view, action.row, action.column)
    best = float(values[action.view, action.primitive, action.row, action.column])
    primitive: Primitive = PRIMITIVES[action.primitive]
    return PreGrasp(
        stamp=frames[action.view].stamp,
        confidence=policy.confidence(best),
        primitive=primitive,
        view=action.view,
        position_in_map=pose[:3, 3] + out @ place,
        approach_in_map=out @ path.turn[:, 2],
        sweep_in_map=out @ sweep,
        corner_in_map=pose[:3, 3] + out @ (place + sweep),
    )


def level_views(
    frames: Sequence[Frame],
    surfaces_in: Callable[[Frame], np.ndarray],
    poses_hand_in_map: Sequence[np.ndarray],
    numbers: ViewNumbers = VIEWS,
) -> Views:
    """Pictures of the gown as level cameras see it, each from the direction of a frame's camera.

    Args:
        frames: of any camera.
        surfaces_in: gives the (H, W) `Surface` of each pixel of a frame.
        poses_hand_in_map: (4, 4) of the holding hand at each frame.
        numbers: of the level cameras.

    Raises:
        PerceptionFailure: none of them shows the gown.
    """
    fx, fy, cx, cy = lens(numbers)
    rgb = np.zeros((len(frames), numbers.height, numbers.width, 3), np.uint8)
    depth = np.zeros(rgb.shape[:3], np.float32)
    turns = np.zeros(len(frames))
    for k, (frame, pose) in enumerate(zip(frames, poses_hand_in_map, strict=True)):
        out = _upright(pose)
        ahead = out.T @ (pose[:3, 3] - frame.pose_camera_in_map[:3, 3])
        turns[k] = np.arctan2(ahead[1], ahead[0])
        gown = np.isin(surfaces_in(frame), GOWN_SURFACES) & (frame.depth > 0)
        points = (points_in_map(frame)[gown] - pose[:3, 3]) @ out
        camera = camera_pose(float(turns[k]), numbers)
        x, y, z = ((points - camera[:3, 3]) @ camera[:3, :3]).T
        far = np.maximum(z, 0.1)
        columns, rows = np.rint(fx * x / far + cx).astype(int), np.rint(fy * y / far + cy).astype(int)
        shows = (z > 0.1) & (rows >= 0) & (rows < numbers.height) & (columns >= 0) & (columns < numbers.width)
        order = np.flatnonzero(shows)[np.argsort(-z[shows], kind="stable")]  # the nearest is written last
        rgb[k, rows[order], columns[order]] = frame.rgb[gown][order]
        depth[k, rows[order], columns[order]] = z[order]
    if (depth > 0).sum() < FABRIC:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "gown in the hand")
    return Views(rgb=rgb, depth=depth, numbers=numbers, turns=turns)


def _upright(pose: np.ndarray) -> np.ndarray:
    """(3, 3) of an upright frame that turns about the vertical with a hand at a pose (4, 4)."""
    yaw = np.arctan2(-pose[0, 1], pose[1, 1])  # as the presented hand's turn is told
    ahead = np.array((np.cos(yaw), np.sin(yaw), 0.0))
    return np.column_stack([ahead, np.cross(UP, ahead), UP])


@lru_cache
def packaged_policy() -> Policy:
    """The policy that the package ships, loaded once."""
    return Policy(PACKAGED)
