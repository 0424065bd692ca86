"""What one frame says about the skin of one arm: points on it, and how far every pixel is from skin."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame, Side
from ..image.plain_opencv import plain_opencv
from .lying_body import LyingBody, Trunk, side_sign
from .person_facts import PERSON
from .skin import DEFAULT as SKIN_DEFAULT
from .skin import SkinTuning, skin_on_bed


@dataclass(frozen=True, kw_only=True)
class SkinViewTuning(Quantities):
    """Numbers of what of a person's skin is taken for one arm."""

    trunk_margin: float = quantity(0.03, "m", "between the trunk and skin of the arm", "choice: above depth noise")
    trunk_share: float = quantity(
        0.95, "1", "of the trunk's width that no arm can be in", "choice: an arm at rest touches the flank"
    )
    above_shoulder: float = quantity(
        0.10, "m", "headward of the shoulders, as far as skin may be the arm's", "choice: the head is beyond"
    )
    max_points: int = quantity(350, "1", "of skin in one fit", "choice: more take longer and say the same")
    far: float = quantity(1000.0, "px", "from skin, where a picture has none", "choice: beyond every picture's border")


DEFAULT = SkinViewTuning()


@dataclass(frozen=True, kw_only=True)
class SkinView:
    """What one frame says about skin.

    Attributes:
        points: (n, 3) skin in the map, thinned [m].
        depth: (H, W) [m].
        to_skin: (H, W) distance of every pixel to the nearest skin pixel [px].
        gradient: (2, H, W) of `to_skin` along u and v.
        intrinsics: (fx, fy, cx, cy) [px].
        pose_camera_in_map: (4, 4).
        trunk: where the arm cannot be, if it is known.
    """

    points: np.ndarray
    depth: np.ndarray
    to_skin: np.ndarray
    gradient: np.ndarray
    intrinsics: tuple[float, float, float, float]
    pose_camera_in_map: np.ndarray
    trunk: Trunk | None = None


def skin_view(
    frame: Frame,
    bed: np.ndarray,
    body: LyingBody,
    side: Side,
    tuning: SkinViewTuning = DEFAULT,
    skin_tuning: SkinTuning = SKIN_DEFAULT,
) -> SkinView:
    """The skin beside the trunk of a body on one side.

    Args:
        frame: a view of the person.
        bed: (2, 3) lower and upper corner of the bed in the map [m].
        body: that lies there.
        side: of the arm.
        tuning: numbers.
        skin_tuning: numbers of what counts as skin.
    """
    import cv2

    points, skin = skin_on_bed(frame, bed, inner=True, tuning=skin_tuning)
    aside = (points[:, 0] - body.middle) * side_sign(side)
    beside_trunk = aside > PERSON.trunk_half_width * body.scale + tuning.trunk_margin
    mine = points[beside_trunk & (points[:, 1] > body.shoulder_y - tuning.above_shoulder)]
    if len(mine) > tuning.max_points:
        mine = mine[np.linspace(0, len(mine) - 1, tuning.max_points).astype(int)]
    if skin.any():
        with plain_opencv():
            to_skin = cv2.distanceTransform((~skin).astype(np.uint8), cv2.DIST_L2, 5)
            gradient = np.stack(
                [
                    cv2.Sobel(to_skin, cv2.CV_32F, 1, 0, ksize=3, scale=0.125),  # 1/8 makes Sobel's sum a slope
                    cv2.Sobel(to_skin, cv2.CV_32F, 0, 1, ksize=3, scale=0.125),
                ]
            )
    else:
        to_skin, gradient = np.full(skin.shape, tuning.far, np.float32), np.zeros((2, *skin.shape), np.float32)
    return SkinView(
        points=mine,
        trunk=body.trunk(side, tuning.trunk_share),
        depth=frame.depth,
        to_skin=to_skin,
        gradient=gradient,
        intrinsics=frame.intrinsics,
        pose_camera_in_map=frame.pose_camera_in_map,
    )
