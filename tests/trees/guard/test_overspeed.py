import numpy as np
from caretree.skills.core.reasons import Reason

from .guarded import make, twist


def test_measured_speed_above_the_limit_fails_the_skill():
    world, guard = make(near=True)
    world.send(twist(y=0.4, duration=10.0))  # past the guard, as a runaway controller would
    fault = None
    for tick in range(1, 15):
        world.clock.wait_until(tick / 15)
        guard.check()
        hand = world.observe().pose_hand_in_map[0, :3, 3]
        guard.update_person(hand + np.array((0.2, 0, 0)))
        fault = fault or guard.take_fault()
    assert fault.reason == Reason.SPEED_LIMIT
    world.clock.wait_until(2.0)
    assert guard.still()
