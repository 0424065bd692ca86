"""Where a person's chin, mouth and nose are looked at."""

import numpy as np
import pytest
from caretree.perception.estimates import Cover
from caretree.skills.belief.face import FACE, cover_of, face_points
from caretree.trees.tasks.dressing.check_face import CheckFace

from ..bench import LeafBench, beside_bed

MIDDLE = np.array((0.02, -0.56, 0.7))  # between the shoulders [m]


def skill(**answers):
    one = LeafBench(lambda context: CheckFace("free", context), beside_bed(**answers)).skill
    one.initialise()
    return one


@pytest.mark.parametrize("part", [FACE.chin, FACE.mouth_and_nose])
def test_the_places_are_headward_of_the_shoulders_about_the_midline_on_the_face(part):
    face = face_points(skill(), MIDDLE, part)
    headward = MIDDLE[1] - face[:, 1]
    assert (headward.min(), headward.max()) == pytest.approx(part)
    assert face[:, 0].mean() == pytest.approx(MIDDLE[0])
    assert np.ptp(face[:, 0]) == pytest.approx(2 * FACE.half_width)
    assert np.ptp(face[:, 2]) == 0.0


def test_what_shows_no_skin_covers_them():
    cover = Cover(stamp=0.0, confidence=0.9, share=0.7)
    one = skill(skin_cover=lambda frame, points_in_map: cover)
    assert cover_of(one, face_points(one, MIDDLE, FACE.chin)).share == 0.7
