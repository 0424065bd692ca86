"""How a run with a fault ended, and what was still wrong afterwards."""

from __future__ import annotations

import numpy as np

from ...sim.faults import FaultyWorld
from ...sim.record.record import RunResult
from ...sim.waiting import wait
from ...sim.world import SIDES, WorldError
from ..run.runner import Run
from ..run.safe_stop import OPEN
from .fault_row import FaultKey, Row

SETTLE = 1.0  # [s] watched after the end for anything that still moves
MOVED = 0.02  # [rad] or [m] in that time


def finished(run: Run) -> RunResult:
    """Run to the end; a run that the operator ended says nothing of the fault.

    Raises:
        KeyboardInterrupt: it was.
    """
    result = run.run()
    if run.interrupted:
        raise KeyboardInterrupt
    return result


def ended(key: FaultKey, result: RunResult, begun: float, unsafe: str) -> Row:
    """The row of a fault that began at `begun` [s]."""
    node, phase, fault = key
    return Row(
        node=node,
        phase=phase,
        fault=fault,
        outcome=result.outcome,
        reason=result.reason,
        unsafe=unsafe,
        time_to_safe=round(result.sim_time_s - begun, 2),
    )


def unsafe_after(run: Run, outcome: str) -> str:
    """What is still wrong after a run: something moves, an arm is held, fingers are closed; empty when nothing is."""
    world = run.world.inner if isinstance(run.world, FaultyWorld) else run.world
    try:
        before = world.observe()
        wait(world.clock, world.clock.now() + SETTLE)
        after = world.observe()
    except WorldError as error:
        return f"nobody knows whether anything moves: {error}"
    if np.abs(after.arm_positions - before.arm_positions).max() > MOVED:
        return "an arm still moves"
    if np.abs(after.pose_base_in_map - before.pose_base_in_map).max() > MOVED:
        return "the base still moves"
    released = OPEN * world.robot.gripper.stroke
    for n, side in enumerate(SIDES):
        if run.guard.grip(side) == "arm" and after.gripper_opening[n] < released:
            return f"the {side} hand still holds the person's arm"
        if outcome != "success" and after.gripper_opening[n] < released:
            return f"the {side} hand is still closed"
    return ""
