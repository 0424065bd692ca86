from types import SimpleNamespace

from caretree.skills.core.lease import MotionLease


def test_one_holder_at_a_time_until_its_motion_has_stopped():
    time = [0.0]
    lease = MotionLease(lambda: time[0], patience=2.0)
    first, second = SimpleNamespace(name="first"), SimpleNamespace(name="second")
    assert lease.acquire(first)
    assert lease.acquire(first)
    assert not lease.acquire(second)
    answers = iter([False, False, True])
    lease.release_when(first, lambda: next(answers))
    for _ in range(2):
        lease.advance()
        assert not lease.acquire(second)
        assert not lease.acquire(first), "a skill that is still stopping may not start again either"
    lease.advance()
    assert lease.acquire(second)


def test_a_release_that_does_not_end_is_named():
    time = [0.0]
    lease = MotionLease(lambda: time[0], patience=2.0)
    owner = SimpleNamespace(name="pull")
    lease.acquire(owner)
    lease.release_when(owner, lambda: False)
    time[0] = 1.9
    assert lease.stuck() is None
    time[0] = 2.1
    assert lease.stuck() is owner
    lease.clear()
    assert lease.stuck() is None
    assert lease.holder is None


def test_only_the_holder_can_give_back():
    lease = MotionLease(lambda: 0.0)
    first, second = SimpleNamespace(name="first"), SimpleNamespace(name="second")
    lease.acquire(first)
    lease.release(second)
    assert lease.holder is first
    lease.release(first)
    assert lease.holder is None
