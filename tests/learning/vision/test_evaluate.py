"""The comparison: one who knows the truth scores perfectly, one who sees nothing scores nothing."""

import numpy as np
import pytest
from caretree.learning.vision import evaluate as module
from caretree.learning.vision.evaluate import evaluate
from caretree.learning.vision.labels import JOINTS, KEY_POINTS, SHOWN
from caretree.learning.vision.pictures import draw_picture
from caretree.learning.vision.table import rows, table

from .still_room import still_state


class Knowing:
    """Sees what the picture that was drawn last shows."""

    def __init__(self, drawn):
        self._drawn = drawn

    @property
    def truth(self):
        return self._drawn[-1].labels

    def _point(self, name):
        k = KEY_POINTS.index(name)
        return (self.truth.points_in_map[k].astype(float), 1.0) if self.truth.seen[k] == SHOWN else None

    def surfaces(self, frame):
        return self.truth.surface

    def confidence(self, frame):
        return np.ones(frame.depth.shape)

    def sheet(self, frame):
        return self.truth.sheet

    def corner(self, frame, side, hook_in_map):
        return self._point(f"corner_{side}")

    def strap(self, frame, side, near_in_map):
        return self._point(f"strap_{side}")

    def arm(self, frame, side):
        points = np.array([self.truth.points_in_map[KEY_POINTS.index(f"{joint}_{side}")] for joint in JOINTS])
        return points, np.ones(4, bool)

    def key_points(self, frame):
        found = {name: self._point(name) for name in KEY_POINTS}
        return {name: point for name, point in found.items() if point is not None}


class Blind(Knowing):
    """Sees nothing."""

    def surfaces(self, frame):
        return np.zeros(frame.depth.shape, np.uint8)

    def confidence(self, frame):
        return None

    def sheet(self, frame):
        return None

    def _point(self, name):
        return None

    def arm(self, frame, side):
        return None


@pytest.fixture(scope="module")
def tallies():
    drawn = []

    def drawing(*args, **options):
        drawn.append(draw_picture(*args, **options))
        return drawn[-1]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "draw_picture", drawing)
        patch.setattr(module, "SETS", {"plain": ("test", "plain")})
        patch.setattr(module, "_persons", lambda: {"skin 10": {"skin": 10}})
        states = [still_state("hung", 114), still_state("laid", 114), still_state("worn", 114)]
        return evaluate(states, {"knowing": Knowing(drawn), "blind": Blind(drawn)}, pictures=3, seed=1)


def test_who_knows_the_truth_scores_perfectly(tallies):
    knowing = tallies["knowing"]
    assert knowing.iou("gown, plain, hung") == (1.0, 3)
    assert knowing.median("sheet, plain, laid")[0] == 0.0
    assert knowing.calibration_error("surface")[0] == 0.0
    assert knowing.median("joint, skin 10, shown")[0] < 1e-6
    assert knowing.rate("no gown, corner") == (0.0, 12)


def test_who_sees_nothing_scores_nothing(tallies):
    blind = tallies["blind"]
    assert blind.iou("gown, plain, hung") == (0.0, 3)
    assert blind.median("joint, skin 10, shown")[0] == np.inf


def test_the_table_has_both_side_by_side(tallies):
    text = table(rows(tallies), "3 pictures")
    assert "| what | asked for | knowing | blind | n |" in text
    assert "| gown IoU, plain, hung | 0.95 | 1.000 | 0.000 | 3 |" in text
    assert "not found" in text
