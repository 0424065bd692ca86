"""Whether mouth and nose are free, as far as the head's camera shows them."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.estimates import Cover
from caretree.sim.evaluate import limits
from caretree.sim.scene.person_spec import PERSONS, SHAPE
from caretree.skills.core.reasons import Reason
from caretree.skills.scripted.scripted_person import lying_posture
from caretree.trees.tasks.dressing.check_face import CheckFace
from py_trees.common import Status

from ....skills.bench import LeafBench, beside_bed

SHOULDERS = np.mean([lying_posture(side).points_in_map[0] for side in ("left", "right")], axis=0)  # [m]


def cover(share):
    return Cover(stamp=0.0, confidence=0.9, share=share)


def look(seen, asked=None):
    def skin_cover(frame, points_in_map):
        if asked is not None:
            asked.append(points_in_map)
        if isinstance(seen, PerceptionFailure):
            raise seen
        return seen

    senses = beside_bed(skin_cover=skin_cover, arm=lambda frame, side, **_: lying_posture(side))
    run = LeafBench(lambda context: CheckFace("free", context), senses)
    return run, run.ended(seconds=5.0)


@pytest.mark.parametrize(
    ("seen", "reason"),
    [
        (cover(0.0), None),
        (cover(0.3), None),
        (cover(0.5), Reason.FACE_COVERED),
        (cover(1.0), Reason.FACE_COVERED),
        (PerceptionFailure(Problem.OUT_OF_REACH, "face"), Reason.NOTHING_SEEN),
    ],
)
def test_cloth_over_mouth_and_nose_is_no_success(seen, reason):
    run, ended = look(seen)
    assert ended == reason
    assert run.skill.status == (Status.SUCCESS if reason is None else Status.FAILURE)


@pytest.mark.parametrize("scale", [spec.scale for spec in PERSONS.values()])
def test_it_looks_where_people_of_any_size_breathe(scale):
    asked = []
    look(cover(0.0), asked)
    headward = SHOULDERS[1] - asked[0][:, 1]
    assert headward.min() < SHAPE.face_y * scale + limits.FACE_REACH / 2
    assert headward.max() > SHAPE.face_y * scale - limits.FACE_REACH / 2
    assert np.abs(asked[0][:, 0] - SHOULDERS[0]).max() < 0.03
