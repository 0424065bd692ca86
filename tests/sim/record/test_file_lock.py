"""One holder of a lock at a time, and none after it is gone."""

import os

from caretree.sim.record.file_lock import lock_file


def test_one_holder_at_a_time(tmp_path):
    path = tmp_path / "lock"
    first = lock_file(path)
    assert first is not None
    assert lock_file(path) is None
    os.close(first)
    second = lock_file(path)
    assert second is not None
    os.close(second)


def test_a_lock_on_a_file_that_was_taken_away_is_not_believed(tmp_path, monkeypatch):
    import fcntl

    path, taken = tmp_path / "lock", []
    flock = fcntl.flock

    def slow(file, how):
        flock(file, how)
        if not taken:  # between opening and locking, its last holder takes the file away
            path.unlink()
            taken.append(file)

    monkeypatch.setattr(fcntl, "flock", slow)
    assert lock_file(path) is not None
    assert lock_file(path) is None
