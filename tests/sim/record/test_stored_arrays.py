"""Arrays of a record are read by name, and what is wrong with the file is said in one sentence."""

import numpy as np
import pytest
from caretree.sim.errors import RecordError
from caretree.sim.record.stored_arrays import stored_arrays


def test_only_what_is_asked_for_is_read(tmp_path):
    np.savez(tmp_path / "a.npz", t=np.arange(3), x=np.ones(2))
    found = stored_arrays(tmp_path / "a.npz", ("t",), "")
    assert list(found) == ["t"]
    assert found["t"].tolist() == [0, 1, 2]


def test_a_file_that_is_not_there_lacks_an_array_or_is_damaged_is_told(tmp_path):
    path = tmp_path / "a.npz"
    with pytest.raises(RecordError, match=r"holds no a\.npz: it tells the time"):
        stored_arrays(path, ("t",), ": it tells the time")
    np.savez(path, x=np.ones(2))
    with pytest.raises(RecordError, match=r"a\.npz lacks t"):
        stored_arrays(path, ("t",), "")
    path.write_bytes(b"PK\x03\x04 broken")
    with pytest.raises(RecordError, match="is damaged and cannot be read"):
        stored_arrays(path, ("t",), "")
