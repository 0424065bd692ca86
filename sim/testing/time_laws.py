"""Laws of a world's clock."""

from __future__ import annotations

from ..waiting import wait
from ..world import WorldError
from .world_trial import PERIOD, WorldTrial

WAIT_MAX = 0.1  # [s] of wall time after which a wait comes back
SLACK = 0.1  # [s] that a busy machine may add
LATE = 0.2  # [s] by which a wait may come back too late on the world's clock
LOOKS = 15


def the_clock_goes_on_and_never_back(trial: WorldTrial) -> None:
    """Whoever waits comes out at the time that was asked for."""
    before = trial.now()
    for _ in range(LOOKS):
        asked = trial.now() + PERIOD
        try:
            wait(trial.world.clock, asked, wall=trial.wall)
        except WorldError as error:
            trial.hold(False, str(error))
        now = trial.now()
        trial.hold(now >= before, f"it went back by {before - now:.3f} s")
        trial.hold(now - asked <= LATE, f"a wait came back {now - asked:.2f} s too late")
        before = now


def a_wait_for_the_past_is_over_at_once(trial: WorldTrial) -> None:
    """It takes no time, and turns none back."""
    before, began = trial.now(), trial.wall()
    trial.world.clock.wait_until(before - 1.0)
    passed, took = trial.now() - before, trial.wall() - began
    trial.hold(passed >= 0.0, f"it turned the clock back by {-passed:.2f} s")
    trial.hold(passed <= LATE and took <= WAIT_MAX + SLACK, f"it took {max(passed, took):.2f} s")


def a_wait_comes_back_within_a_tenth_of_a_second(trial: WorldTrial) -> None:
    """Whatever it waits for: a wall clock that is waited for has a robot that moves on."""
    if trial.stepped:
        return  # its robot waits too
    began = trial.wall()
    trial.world.clock.wait_until(trial.now() + 10.0)
    took = trial.wall() - began
    trial.hold(took <= WAIT_MAX + SLACK, f"it took {took:.2f} s of wall time, {WAIT_MAX:g} s are allowed")
