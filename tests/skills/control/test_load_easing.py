"""A pull slows down over the last newtons before its greatest load."""

import numpy as np
import pytest
from caretree.skills.control.load_easing import LoadEasing


@pytest.mark.parametrize(
    ("load", "share"), [(0.0, 1.0), (2.0, 1.0), (3.0, 0.5), (3.2, 0.4), (3.9, 0.25), (4.0, 0.25), (9.0, 0.25)]
)
def test_it_slows_down_evenly_and_never_below_its_least_share(load, share):
    easing = LoadEasing(margin=2.0, min_share=0.25)
    assert easing.share(np.array((0.0, -load, 0.0)), max_load=4.0) == pytest.approx(share)
