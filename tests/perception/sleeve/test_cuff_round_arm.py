"""How far round an arm a cuff shows, from points and from a picture painted by hand."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure
from caretree.perception.sleeve.cuff_round_arm import cuff_round, share_round
from caretree.sim.world import Frame

DOWN = np.array(((1.0, 0.0, 0.0, 0.0), (0.0, -1.0, 0.0, 0.0), (0.0, 0.0, -1.0, 2.0), (0.0, 0.0, 0.0, 1.0)))
CHAIN = np.array(((-0.30, 0.0, 1.0), (0.0, 0.0, 1.0), (0.25, 0.0, 1.0)))  # along the picture's rows


@pytest.mark.parametrize(("turns", "share"), [((-np.pi, np.pi), 1.0), ((0.1, 0.9), 2 / 12), ((-1.5, 1.5), 6 / 12)])
@pytest.mark.parametrize("chain", [CHAIN, np.array(((0.0, 0.0, 0.0), (0.0, 0.02, 0.4))), CHAIN[:, [1, 2, 0]]])
def test_how_far_points_lie_round_a_chain(turns, share, chain):
    along = chain[1] - chain[0]
    across = np.linalg.svd(along[None])[2][1:]  # any two directions off it
    angles = np.linspace(*turns, 400)[:, None]
    points = 0.08 * (np.cos(angles) * across[0] + np.sin(angles) * across[1]) + chain[0] + 0.4 * along
    assert share_round(points, chain) == pytest.approx(share, abs=1.01 / 12)


def picture(rows, heights):
    """A camera above green stripes along the arm, each at rows (from, to) and some height [m] above its axis."""
    rgb, depth = np.full((120, 160, 3), 128, np.uint8), np.ones((120, 160), np.float32)
    for (first, last), height in zip(rows, heights, strict=True):
        rgb[first:last, 60:90], depth[first:last, 60:90] = (40, 150, 80), 1.0 - height
    return Frame(
        camera="head", stamp=1.0, rgb=rgb, depth=depth, intrinsics=(200.0, 200.0, 80.0, 60.0), pose_camera_in_map=DOWN
    )


def test_a_cuff_before_beside_and_behind_the_arm_is_round_it_and_one_beside_it_is_not():
    inside = picture([(44, 56), (56, 64), (64, 76)], (-0.05, 0.06, -0.05))
    beside = picture([(72, 84)], (-0.03,))
    assert cuff_round(inside, CHAIN).share > 0.4 > cuff_round(beside, CHAIN).share


def test_no_cuff_near_the_arm_is_said():
    with pytest.raises(PerceptionFailure):
        cuff_round(picture([(0, 15)], (0.0,)), CHAIN)
