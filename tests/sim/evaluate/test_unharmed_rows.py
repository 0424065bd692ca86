"""The rows "unharmed" as the evaluator reads them."""

import numpy as np
from caretree.sim.evaluate.truth_file import read_truth
from caretree.sim.evaluate.unharmed_rows import ROWS


def test_a_person_who_lies_still_is_there_in_every_frame(make_record, tmp_path):
    truth = read_truth(make_record(tmp_path / "run"))
    rows = truth.unharmed
    assert rows is not None
    assert truth.lacks == ()
    assert rows.person_capsules.shape == (len(truth.t), 2, 7)
    np.testing.assert_array_equal(rows.person_capsules[0], rows.person_capsules[-1])
    assert rows.robot_capsule_names == ("left_palm", "right_palm")
    assert rows.bed_top == -0.1  # [m]


def test_without_one_of_them_none_is_there(damaged_record):
    truth = read_truth(damaged_record(lambda z: z.pop("face")))
    assert truth.unharmed is None
    assert truth.lacks == ("face",)


def test_without_all_of_them_nothing_lacks(damaged_record):
    def forget(z):
        for name in ROWS:
            del z[name]

    truth = read_truth(damaged_record(forget))
    assert (truth.unharmed, truth.lacks) == (None, ())
