"""What is read of truth.npz is there, whole, and of the right shape and type."""

import numpy as np
import pytest
from caretree.sim.errors import RecordError
from caretree.sim.evaluate.arrays_file import check_indices, check_shapes, read_arrays


def test_optional_arrays_are_read_where_they_are(tmp_path):
    np.savez(tmp_path / "truth.npz", t=np.arange(3), face=np.zeros(6))
    assert set(read_arrays(tmp_path, ("t",), optional=("face", "bed_top"))) == {"t", "face"}
    with pytest.raises(RecordError, match="lacks bed_top"):
        read_arrays(tmp_path, ("t", "bed_top"))


def test_a_record_without_truth_is_one_sentence(tmp_path):
    with pytest.raises(RecordError, match=r"holds no truth\.npz"):
        read_arrays(tmp_path, ("t",))


def test_a_letter_stands_for_one_length(tmp_path):
    sizes = {}
    arrays = {"a": np.zeros((4, 3)), "b": np.zeros((4, 2)), "c": np.zeros(5)}
    check_shapes(tmp_path, arrays, {"a": ("T", 3), "b": ("T", None)}, sizes)
    assert sizes == {"T": 4}
    with pytest.raises(RecordError, match=r"c has shape \(5,\), but \(4\) is asked for"):
        check_shapes(tmp_path, arrays, {"c": ("T",)}, sizes)


def test_names_are_text_and_all_else_is_numbers(tmp_path):
    text, numbers = np.array(["a", "b"]), np.zeros(2)
    check_shapes(tmp_path, {"link_names": text, "face": numbers}, {"link_names": (2,), "face": (2,)}, {})
    for name, array, kind in (("link_names", numbers, "text"), ("face", text, "numbers")):
        with pytest.raises(RecordError, match=f"{name} holds .*, but {kind}"):
            check_shapes(tmp_path, {name: array}, {name: (2,)}, {})


@pytest.mark.parametrize("index", [np.array([0, 4]), np.array([-1]), np.array([0.0])])
def test_vertex_numbers_are_integers_below_the_count(tmp_path, index):
    check_indices(tmp_path, {"loop": np.array([0, 3])}, ["loop"], 4)
    with pytest.raises(RecordError, match="vertex numbers from 0 to 3"):
        check_indices(tmp_path, {"loop": index}, ["loop"], 4)
