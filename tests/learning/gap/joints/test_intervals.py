from dataclasses import replace

import numpy as np
import pytest
from caretree.learning.gap.joints.block import Block
from caretree.learning.gap.joints.intervals import AT_BOUND, intervals, value_within
from caretree.learning.gap.joints.log import JointLog
from caretree.sim.effects.effect import Parameter
from scipy.signal import lfilter

from ..solved import solved

T = np.arange(0.0, 10.0, 0.05)
PUSH = Parameter(name="push", unit="F", lower=0.0)


def log(residual):
    still = np.zeros((len(T), 1))
    return JointLog(
        name="a",
        role="fit",
        t=T,
        dt=0.05,
        cutoff=float("inf"),
        q=still,
        dq=still,
        ddq=still,
        rigid=still,
        measured=residual[:, None],
        residual=residual[:, None],
        raw=residual[:, None],
        slow=np.ones(1),
        trim=0,
    )


def block(column):
    parameter = Parameter(name="size", unit="F")
    return Block(
        name="any",
        target="axis",
        recalibration=False,
        channels=(0,),
        parameters=(parameter,),
        build=lambda _: column[:, None, None],
    )


@pytest.mark.parametrize("column", [np.ones_like(T), np.sin(2.0 * np.pi * 0.5 * T)], ids=["offset", "wave"])
def test_noise_with_a_memory_is_allowed_for(column):
    rng = np.random.default_rng(3)
    memory, held, too_sure, draws = 0.9, 0, 0, 300
    for _ in range(draws):
        noise = lfilter([np.sqrt(1.0 - memory**2)], [1.0, -memory], rng.normal(size=len(T) + 200))[200:]
        theta = np.array([column @ (2.0 * column + noise) / (column @ column)])
        half = intervals((block(column),), theta, np.ones(1), [log(2.0 * column + noise)]).linear[0]
        held += abs(theta[0] - 2.0) <= half
        too_sure += abs(theta[0] - 2.0) <= 1.96 / np.sqrt(column @ column)
    assert 0.9 < held / draws < 0.99
    assert too_sure / draws < 0.85


def test_every_log_has_noise_of_its_own():
    rng, wave, held, draws = np.random.default_rng(5), np.sin(2.0 * np.pi * 0.5 * T), 0, 200
    kept = {"a": wave, "b": 0.1 * wave}  # what tells of the number is in the log that is loud
    whole = Block(**{**vars(block(wave)), "build": lambda log: kept[log.name][:, None, None]})
    for _ in range(draws):
        logs = [
            log(kept["a"] + rng.normal(size=len(T))),
            replace(log(kept["b"] + 0.1 * rng.normal(size=len(T))), name="b"),
        ]
        x, y = np.concatenate([kept["a"], kept["b"]]), np.concatenate([each.residual[:, 0] for each in logs])
        theta = np.array([x @ y / (x @ x)])
        held += abs(theta[0] - 1.0) <= intervals((whole,), theta, np.ones(1), logs).linear[0]
    assert 0.9 < held / draws < 0.99


def test_what_a_column_shares_with_another_is_not_known_of_either():
    rng = np.random.default_rng(4)
    one, near = np.sin(T), np.sin(T) + 0.01 * np.cos(3.0 * T)
    y = one + 0.1 * rng.normal(size=len(T))
    alone = intervals((block(one),), np.ones(1), np.ones(1), [log(y)]).linear
    both = intervals((block(one), block(near)), np.array([1.0, 0.0]), np.ones(1), [log(y)]).linear
    assert both[0] > 20.0 * alone[0]
    known = intervals(
        (block(one), block(near)), np.array([1.0, 0.0]), np.ones(1), [log(y)], ridge=np.array([0.0, 1e12])
    ).linear
    assert known[0] == pytest.approx(alone[0], rel=0.05)


def test_a_threshold_has_an_interval_too(axis_set):
    _, _, effects, _, _ = solved(axis_set(lambda q, v, a: 60.0 * np.maximum(q - 0.05, 0.0)))
    assert [f.name for f in effects] == ["contact"]
    threshold = next(p for p in effects[0].parameters if p.name == "threshold")
    assert threshold.low < 0.05 < threshold.high
    assert threshold.high - threshold.low < 0.05
    side = next(p for p in effects[0].parameters if p.name == "side")
    assert side.low == side.high == 1.0


def test_no_interval_leaves_what_is_physical_and_one_at_its_end_is_doubted():
    inside, outside = value_within(PUSH, "N", 0.5, -0.5, 1.5), value_within(PUSH, "N", 0.0, -0.5, 0.5)
    assert (inside.low, inside.high, inside.doubt) == (0.0, 1.5, "")
    assert outside.doubt == AT_BOUND
    assert intervals((), np.zeros(0), np.ones(1), [replace(log(T), role="fit")]).linear.shape == (0,)
