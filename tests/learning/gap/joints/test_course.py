import numpy as np
from caretree.learning.gap.joints.log import JointLog
from caretree.learning.gap.joints.payloads.course import told

T = np.arange(0.0, 20.0, 0.05)
RNG = np.random.default_rng(2)


def log():
    still = np.zeros((len(T), 1))
    return JointLog(
        name="a",
        role="fit",
        t=T,
        dt=0.05,
        cutoff=2.0,
        q=still,
        dq=still,
        ddq=still,
        rigid=still,
        measured=still,
        residual=still,
        raw=still,
        slow=np.ones(1),
        trim=7,
    )


def test_a_load_that_comes_and_goes_is_told_to_the_row():
    a = log()
    load = np.sin(0.9 * T)[:, None] + 2.0
    acts = ((T >= 6.0) & (T < 13.0))[:, None]
    left = a.shared(load * acts, sharp=True)
    left = left + 0.05 * RNG.normal(size=left.shape)
    spans = told(a, left, np.stack([0.0 * left, load[a.inner]]), np.ones(1), 1.0)
    assert [s for s, _, _ in spans] == [0, 1, 0]
    begin, end = (T[a.inner][spans[k][1]] for k in (1, 2))
    assert abs(begin - 6.0) <= 0.1
    assert abs(end - 13.0) <= 0.1


def test_what_is_over_at_once_is_no_load_of_its_own():
    a = log()
    left = np.zeros((len(T[a.inner]), 1))
    left[:20], left[200:220] = 1.0, 1.0  # one second each
    spans = told(a, left, np.stack([0.0 * left, 0.0 * left + 1.0]), np.ones(1), 5.0)
    assert spans == [(0, 0, len(left))]


def test_what_is_worth_less_than_its_price_is_no_change():
    a = log()
    left = np.zeros((len(T[a.inner]), 1))
    left[100:102] = 1.0
    spans = told(a, left, np.stack([0.0 * left, 0.0 * left + 1.0]), np.ones(1), 5.0)
    assert spans == [(0, 0, len(left))]
