import numpy as np
import pytest
from caretree.sim.errors import RecordError
from caretree.sim.record.measured import MeasuredLog, read_measured

from .recorded_lift import write_record

ARMS = np.array((((-0.2, -0.5, 0.7), (-0.35, -0.33, 0.67), (-0.48, -0.15, 0.66), (-0.55, -0.02, 0.65)),) * 2) * (
    1,
    1,
    1,
)
ARMS[1, :, 0] *= -1


def test_what_was_measured_comes_back(tmp_path):
    found = read_measured(write_record(tmp_path, ARMS))
    assert found.t[0] == 5.0
    assert found.pose_hand.shape == (len(found.t), 2, 7)
    np.testing.assert_allclose(np.linalg.norm(found.pose_hand[:, :, 3:], axis=2), 1.0)
    np.testing.assert_array_equal(found.arm_side, [1])
    np.testing.assert_array_equal(found.arm_points[0], ARMS[1])


def test_a_run_in_which_nothing_was_measured_has_no_file(tmp_path):
    MeasuredLog().write(tmp_path)
    with pytest.raises(RecordError, match=r"holds no measured.npz: the run was cut short, or is older"):
        read_measured(tmp_path)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"t": None}, "lacks t"),
        ({"head_pan": np.zeros(3)}, "head_pan has shape"),
        ({"wrench_hand": np.nan}, "not finite"),
        ({"t": -1.0}, "times do not grow"),
    ],
)
def test_a_damaged_file_is_told(tmp_path, change, told):
    folder = write_record(tmp_path, ARMS)
    with np.load(folder / "measured.npz") as stored:
        arrays = dict(stored)
    for name, value in change.items():
        if value is None:
            del arrays[name]
        elif isinstance(value, float):
            arrays[name] = arrays[name] * value
        else:
            arrays[name] = value
    np.savez(folder / "measured.npz", **arrays)
    with pytest.raises(RecordError, match=told):
        read_measured(folder)


def test_half_a_file_is_told(tmp_path):
    folder = write_record(tmp_path, ARMS)
    whole = (folder / "measured.npz").read_bytes()
    (folder / "measured.npz").write_bytes(whole[: len(whole) // 2])
    with pytest.raises(RecordError, match="damaged and cannot be read"):
        read_measured(folder)
