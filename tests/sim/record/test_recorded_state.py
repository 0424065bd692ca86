import numpy as np
import pytest
from caretree.sim.errors import RecordError
from caretree.sim.record.recorded_state import recorded_state

T = np.array((0.0, 0.1, 0.2, 0.3))


@pytest.fixture
def record(tmp_path):
    """Four frames, each of its own shape; a hand holds cloth in the second one, an arm in the third."""
    links = np.zeros((4, 2, 7))
    links[:, 0, :6], links[:, 1, :6] = (1, 2, 0, 1, 2, 1), (3, 2, 0, 3, 2, 1)
    np.savez(
        tmp_path / "truth.npz",
        t=T,
        vertices=np.arange(4)[:, None, None] * np.ones((4, 5, 3)),
        arms=np.zeros((4, 2, 4, 3)),
        gripper_closed=np.array(((0, 0), (0, 1), (0, 0), (0, 0)), bool),
        holds_arm=np.array(((-1, -1), (-1, -1), (-1, 0), (-1, -1))),
        robot_capsules=links,
    )
    return tmp_path


def test_the_frame_nearest_to_the_time_is_taken(record):
    state = recorded_state(record, 0.27)
    assert state.t == 0.3
    np.testing.assert_array_equal(state.vertices, 3 * np.ones((5, 3)))
    np.testing.assert_array_equal(state.robot, (2.0, 2.0))


def test_the_time_of_the_last_event_counts_which_comes_after_the_last_frame(record):
    assert recorded_state(record, 0.35).t == 0.3


@pytest.mark.parametrize("time", [0.1, 0.2])
def test_a_run_does_not_begin_while_a_hand_holds_cloth_or_an_arm(record, time):
    with pytest.raises(RecordError, match=r"hold something; they are empty at 0\.[03]0 s"):
        recorded_state(record, time)


@pytest.mark.parametrize("time", [-0.1, 0.4])
def test_a_time_outside_the_record_is_refused(record, time):
    with pytest.raises(RecordError, match=r"lasts from 0 to 0\.3 s"):
        recorded_state(record, time)


def test_no_record_an_old_one_and_a_damaged_one_are_named(record):
    with pytest.raises(RecordError, match=r"holds no truth\.npz"):
        recorded_state(record / "elsewhere", 0.0)
    file = record / "truth.npz"
    whole = file.read_bytes()
    np.savez(file, t=T)
    with pytest.raises(RecordError, match="lacks vertices"):
        recorded_state(record, 0.0)
    file.write_bytes(whole[:-100])
    with pytest.raises(RecordError, match="damaged"):
        recorded_state(record, 0.0)
