"""Laws that only show in a world that is broken on purpose."""

from __future__ import annotations

import numpy as np

from ..waiting import wait
from ..world import EmergencyStop, HandTwist, SensorLost, WorldError
from .time_laws import SLACK, WAIT_MAX
from .world_trial import PERIOD, STALE, WorldTrial

GIVEN = 2.0 * STALE  # [s] after which what no longer comes is lost
UP = 0.02 * np.eye(6)[2]


def dead_senses_are_lost(trial: WorldTrial) -> None:
    """What was seen last cannot be taken for what is."""
    ends = trial.now() + GIVEN
    while trial.now() < ends:
        trial.world.clock.wait_until(trial.now() + PERIOD)
    began = trial.wall()
    try:
        seen = trial.observe()
    except SensorLost:
        took = trial.wall() - began
        trial.hold(took <= 1.0, f"it took {took:.1f} s to say so")
        return
    trial.hold(False, f"an observation of {trial.now() - seen.time:.2f} s ago is given as a new one")


def a_dead_clock_is_told(trial: WorldTrial) -> None:
    """A wait for it comes back, and waiting for it on and on ends with an error."""
    began = trial.wall()
    trial.world.clock.wait_until(trial.now() + 10.0)
    took = trial.wall() - began
    trial.hold(trial.stepped or took <= WAIT_MAX + SLACK, f"a wait took {took:.2f} s of wall time")
    try:
        wait(trial.world.clock, trial.now() + 10.0, wall=trial.wall)
    except WorldError:
        return
    trial.hold(False, "it goes on")


def the_emergency_stop_is_told(trial: WorldTrial) -> None:
    """An observation says so, a command raises EmergencyStop, and stop() is as safe as ever."""
    wait(trial.world.clock, trial.now() + STALE, wall=trial.wall)
    trial.hold(trial.observe().emergency_stop, "the observation does not say that it is pressed")
    try:
        trial.world.send(HandTwist(side="left", twist_in_map=UP))
    except EmergencyStop:
        pass
    except Exception as error:
        trial.hold(False, f"a command raised {type(error).__name__}, but EmergencyStop is asked for")
    else:
        trial.hold(False, "a command was taken as if nothing were pressed")
    try:
        trial.world.stop()
    except Exception as error:
        trial.hold(False, f"stop() raised {type(error).__name__}: {error}")
