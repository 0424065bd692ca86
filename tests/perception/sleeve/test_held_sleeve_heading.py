"""Which way a held sleeve points, from pictures painted by hand."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure
from caretree.perception.sleeve.held_sleeve_heading import sleeve_heading
from caretree.sim.world import Frame

DOWN = np.array(((1.0, 0.0, 0.0, 0.0), (0.0, -1.0, 0.0, 0.0), (0.0, 0.0, -1.0, 2.0), (0.0, 0.0, 0.0, 1.0)))
MAGENTA, GREEN = (180, 40, 110), (40, 150, 80)


def picture(armhole, cuff):
    """A camera 1 m above two upright stripes at the pixel columns (from, to), 5 mm a pixel."""
    rgb = np.full((120, 160, 3), 128, np.uint8)
    for (first, last), colour in ((armhole, MAGENTA), (cuff, GREEN)):
        rgb[50:70, first:last] = colour
    return Frame(
        camera="head",
        stamp=1.0,
        rgb=rgb,
        depth=np.ones((120, 160), np.float32),
        intrinsics=(200.0, 200.0, 80.0, 60.0),
        pose_camera_in_map=DOWN,
    )


@pytest.mark.parametrize(("armhole", "cuff", "along"), [((70, 80), (90, 100), 0.10), ((90, 100), (70, 80), -0.10)])
def test_the_cuff_is_seen_on_its_side_of_the_armhole(armhole, cuff, along):
    seen = sleeve_heading(picture(armhole, cuff), "right", np.array((0.0, 0.0, 1.0)))
    np.testing.assert_allclose(seen.cuff_from_armhole_in_map, (along, 0.0, 0.0), atol=0.012)


def test_bindings_far_from_the_grip_say_nothing():
    with pytest.raises(PerceptionFailure):
        sleeve_heading(picture((70, 80), (90, 100)), "right", np.array((1.0, 0.0, 1.0)))
