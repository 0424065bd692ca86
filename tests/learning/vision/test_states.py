"""States: kept as they were made, and runs of the wrong kind refused."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.learning.vision import states as module
from caretree.learning.vision.states import _bytes, _postures, hanging, make_states, read_states, recorded
from caretree.sim.errors import CaretreeError
from caretree.sim.scene.initial_state import InitialState

from .still_room import still_state


def test_what_is_made_is_read_again_and_not_made_twice(tmp_path, monkeypatch):
    made = []
    monkeypatch.setattr(module, "prepared", lambda seed, state, gown=None: made.append(seed) or still_state(seed=seed))
    make_states(tmp_path, range(110, 112))
    count = len(made)
    assert count == 5 + 2  # every seed hung and in hands, every second one laid, every third one worn in both ways
    make_states(tmp_path, range(110, 112))
    assert len(made) == count
    found, digest = read_states(tmp_path)
    assert np.array_equal(found[0].vertices, still_state().vertices)
    assert digest == read_states(tmp_path)[1]


def test_only_what_is_asked_for_is_prepared_and_hung_gowns_come_to_hang(tmp_path, monkeypatch):
    prepared, hung = [], []
    monkeypatch.setattr(module, "prepared", lambda seed, state, gown=None: prepared.append(state) or still_state())
    monkeypatch.setattr(module, "hanging", lambda seed: hung.append(seed) or [still_state("hung", seed)] * 2)
    make_states(tmp_path, range(113, 115), kinds=("hung",), hang=True)
    assert prepared == [InitialState.GOWN_ON_HOOK] * 2
    assert hung == [113]  # room 114 is for tests
    assert len(read_states(tmp_path)[0]) == 2 + 2


def test_a_gown_rolls_up_as_it_comes_to_hang():
    before, after = hanging(110, (0.0, 1.5))
    assert (before.kind, after.kind, after.seed) == ("hung", "hung", 110)
    assert np.ptp(after.vertices[:, 0]) < np.ptp(before.vertices[:, 0])
    assert np.abs(after.vertices - before.vertices).max() > 0.1


def test_same_state_same_bytes():
    assert _bytes([still_state()]) == _bytes([still_state()])


def test_an_empty_folder_says_what_makes_states(tmp_path):
    with pytest.raises(CaretreeError, match="caretree learn vision states"):
        read_states(tmp_path)


def test_a_folder_without_a_record_is_refused(tmp_path):
    with pytest.raises(CaretreeError, match="no record of a dressing run"):
        recorded(tmp_path)


def test_a_recorded_robot_stands_as_its_joints_were_read(tmp_path):
    t = np.array((0.0, 0.5, 1.0))
    np.savez(
        tmp_path / "measured.npz",
        t=t,
        pose_base=np.outer(t, np.ones(3)),
        arm_positions=np.broadcast_to(t[:, None, None], (3, 2, 7)),
        head_pan=10.0 * t,
        gripper_opening=np.full((3, 2), 0.04),
    )
    postures = _postures(tmp_path, np.array((0.4, 1.0, 2.0)))
    assert postures.shape == (3, 20)
    assert postures[0] == pytest.approx([*[0.5] * 17, 5.0, 0.04, 0.04])
    assert (postures[1] == postures[2]).all()
    with pytest.raises(CaretreeError, match="does not say how the robot stood"):
        _postures(tmp_path / "nowhere", t)


def test_a_posture_is_kept_with_its_state(tmp_path):
    stood = replace(still_state(), posture=np.arange(20.0))
    (tmp_path / "state_a.npz").write_bytes(_bytes([stood, still_state()]))
    (known, unknown), _ = read_states(tmp_path)
    assert (known.posture == np.arange(20.0)).all()
    assert unknown.posture is None
