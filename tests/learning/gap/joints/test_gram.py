import numpy as np
import pytest
from caretree.learning.gap.joints.block import Block
from caretree.learning.gap.joints.gram import assemble
from caretree.learning.gap.joints.log import JointLog
from caretree.learning.gap.joints.noise import estimate_noise
from caretree.learning.gap.joints.search import Search
from caretree.sim.effects.effect import Parameter


def test_a_channel_that_no_block_touches_keeps_what_it_has():
    t, rng = np.arange(0.0, 5.0, 0.02), np.random.default_rng(0)
    still, y = np.zeros((len(t), 2)), rng.normal(size=(len(t), 2))
    y[:, 0] += 3.0
    motion = {"t": t, "dt": 0.02, "q": still, "dq": still, "ddq": still, "slow": np.ones(2)}
    log = JointLog(name="a", role="fit", cutoff=3.0, trim=0, rigid=still, measured=y, residual=y, raw=y, **motion)
    block = Block(
        name="offset",
        target="q1",
        recalibration=False,
        channels=(0,),
        parameters=(Parameter(name="value", unit="F"),),
        build=lambda log: np.ones((len(log.t), 1, 1)),
    )
    search = Search(gram=assemble([block], [log]), noise=estimate_noise([y], "residual"))
    left = search.rss((0,))
    assert left[1] == pytest.approx(np.sum(y[:, 1] ** 2)) == search.rss(())[1]
    assert left[0] < 0.2 * search.rss(())[0]
