"""Processor time of the simulated room against Bullet's own steps in it: `python benchmarks/around_bullet.py`.

The robot stands with the gown in both hands and swings an arm; nothing looks and nothing is recorded.  Times depend on
the machine, the ratio hardly does.
"""

import sys
import time

import numpy as np
from caretree.sim.bullet.world import BulletWorld
from caretree.sim.world import JointTrajectory

SEED, DURATION = 102, float(sys.argv[1]) if len(sys.argv) > 1 else 5.0  # [s] of simulated time
TICK = 1 / 15  # [s]

world = BulletWorld(seed=SEED)
world.set_initial_state("gown_in_hands")
arms = world.observe().arm_positions[0]
there = arms + np.array((0.3, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
joints = tuple(f"left_{joint}" for joint in ("s0", "s1", "e0", "e1", "w0", "w1", "w2"))
world.send(JointTrajectory(joints=joints, times=np.array((0.0, DURATION)), positions=np.array((arms, there))))
bullet, began = world.stopwatch.processor["bullet"], time.process_time()
while world.clock.now() < DURATION:
    world.observe()
    world.clock.wait_until(world.clock.now() + TICK)
whole, bullet = time.process_time() - began, world.stopwatch.processor["bullet"] - bullet
print(f"{DURATION:g} s simulated: {whole:.2f} s of processor time, {bullet:.2f} s of them in Bullet's steps")
print(f"whole / Bullet: {whole / bullet:.3f}")
