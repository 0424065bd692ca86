"""Where a sleeve shows along an arm, from pictures painted by hand."""

import numpy as np
import pytest
from caretree.perception.classical import ClassicalSenses
from caretree.perception.errors import PerceptionFailure
from caretree.perception.sleeve.worn_sleeve import worn_sleeve
from caretree.sim.scripted.world import scripted_room
from caretree.sim.world import Frame

DOWN = np.array(((1.0, 0.0, 0.0, 0.0), (0.0, -1.0, 0.0, 0.0), (0.0, 0.0, -1.0, 2.0), (0.0, 0.0, 0.0, 1.0)))
MAGENTA, GREEN = (180, 40, 110), (40, 150, 80)
BLUE, PALE = (100, 160, 220), (190, 200, 225)
ARM = np.array(((-0.30, 0.0, 1.0), (0.0, 0.0, 1.0), (0.25, 0.0, 1.0), (0.40, 0.0, 1.0)))  # along the picture's rows


def picture(armhole, cuff, rows=(50, 70)):
    """A camera 1 m above two upright stripes at the pixel columns (from, to), 5 mm a pixel."""
    rgb = np.full((120, 160, 3), 128, np.uint8)
    for (first, last), colour in ((armhole, MAGENTA), (cuff, GREEN)):
        rgb[rows[0] : rows[1], first:last] = colour
    return Frame(
        camera="head",
        stamp=1.0,
        rgb=rgb,
        depth=np.ones((120, 160), np.float32),
        intrinsics=(200.0, 200.0, 80.0, 60.0),
        pose_camera_in_map=DOWN,
    )


@pytest.mark.parametrize(
    ("armhole", "cuff", "places"), [((30, 40), (55, 65), (0.25, 0.67)), ((20, 26), (18, 20), (0.05, -0.02))]
)
def test_bindings_along_the_upper_arm(armhole, cuff, places):
    seen = worn_sleeve(picture(armhole, cuff), "right", ARM)
    assert (seen.armhole_at, seen.cuff_at) == pytest.approx(places, abs=0.06)


@pytest.mark.parametrize(("outside", "inside_out"), [(0, 1.0), (3, 0.25), (4, 0.0)])
def test_fabric_between_the_bindings_tells_whether_it_shows_its_inside(outside, inside_out):
    frame = picture((30, 34), (60, 64))
    for n in range(4):  # stripes along the arm, of which so many show the outside
        frame.rgb[52 + 4 * n : 56 + 4 * n, 34:60] = BLUE if n < outside else PALE
    frame.rgb[60:100, 64:120] = PALE  # elsewhere it counts for nothing
    assert worn_sleeve(frame, "right", ARM).inside_out == pytest.approx(inside_out, abs=0.05)


def test_no_fabric_tells_nothing():
    assert worn_sleeve(picture((30, 34), (60, 64)), "right", ARM).inside_out == 0.0


def test_the_other_sleeve_does_not_count():
    with pytest.raises(PerceptionFailure):
        worn_sleeve(picture((30, 40), (55, 65), rows=(0, 15)), "right", ARM)


def test_a_sleeve_that_shows_farther_down_reaches_less_far_up():
    places = (((20, 26), (60, 70)), ((29, 35), (75, 85)))
    high, low = (worn_sleeve(picture(armhole, cuff), "right", ARM).reach for armhole, cuff in places)
    assert 1.0 > high > low + 0.1 > 0.3


def test_bindings_along_the_forearm_are_told_by_the_forearm():
    seen = ClassicalSenses(scripted_room(), np.random.default_rng(1)).sleeve_on_forearm(
        picture((90, 94), (120, 126)), side="right", arm_in_map=ARM
    )
    assert (seen.armhole_at, seen.cuff_at) == pytest.approx((0.24, 0.87), abs=0.06)
