"""Room on the disk is kept, and given when it is needed."""

import os
from pathlib import Path

import pytest
from caretree.sim.errors import RecordError
from caretree.sim.record.reserve import RESERVE, Reserve


def test_room_is_kept_until_it_is_freed(tmp_path):
    path = tmp_path / "reserve"
    path.write_bytes(b"of a run that was killed")
    reserve = Reserve(path)
    assert path.stat().st_size == RESERVE
    reserve.free()
    reserve.free()
    assert not path.exists()


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no /dev/full on this system to fill up")
def test_a_disk_without_room_is_told_before_the_run_begins(tmp_path):
    path = tmp_path / "reserve"
    path.symlink_to("/dev/full")
    with pytest.raises(RecordError, match="the disk is full: stopped while keeping room"):
        Reserve(path)
    assert not path.is_symlink(), "nothing is left behind"
    with pytest.raises(RecordError, match="keeping room for the record"):
        Reserve(Path(tmp_path / "nowhere" / "reserve"))
