"""The laws that every world keeps, simulated or real, as gymnasium's `check_env` is for environments."""

from __future__ import annotations

import time
from collections.abc import Callable

from ..world import World
from . import broken_laws, motion_laws, senses_laws, time_laws
from .world_trial import Breaks, WorldLawBroken, WorldTrial

STOPS, AGAIN = 20, 0.1  # at most, and between two of them [s]
Law = Callable[[WorldTrial], None]
LAWS: tuple[Law, ...] = (
    senses_laws.it_says_what_its_robot_is_made_of,
    time_laws.the_clock_goes_on_and_never_back,
    time_laws.a_wait_for_the_past_is_over_at_once,
    time_laws.a_wait_comes_back_within_a_tenth_of_a_second,
    senses_laws.an_observation_is_whole,
    senses_laws.observations_are_new_and_vary,
    senses_laws.an_observation_stays_as_it_is,
    motion_laws.a_trajectory_ends_where_it_should,
    motion_laws.the_head_turns_as_it_is_told,
    motion_laws.stopping_ends_every_motion,
    motion_laws.stopping_right_after_a_command_ends_it,
    motion_laws.stopping_works_from_another_thread,
    motion_laws.a_new_command_replaces_the_old_one,
    motion_laws.a_twist_lasts_its_duration,
    motion_laws.the_base_drives_for_its_duration,
    motion_laws.fingers_go_where_they_are_sent_and_stay,
    motion_laws.what_was_really_sent_comes_back,
    motion_laws.a_joint_that_the_robot_does_not_have_is_refused,
    senses_laws.frames_are_whole_new_and_in_place,
    senses_laws.an_unknown_camera_is_lost,
    motion_laws.closing_twice_is_closing_once,
)
BROKEN_LAWS: dict[str, Law] = {
    "senses": broken_laws.dead_senses_are_lost,
    "clock": broken_laws.a_dead_clock_is_told,
    "emergency_stop": broken_laws.the_emergency_stop_is_told,
}


def check_world(
    make_world: Callable[[], World], *, breaks: Breaks | None = None, wall: Callable[[], float] = time.perf_counter
) -> list[str]:
    """Try every law on a world.

    Its robot stands with 0.3 m of room around it, with empty hands; it moves by some centimetres, about a minute long.

    Args:
        make_world: makes it; asked once, and once more for each way to break it.
        breaks: how to break it on purpose; the laws that only show then are left out where it says none.
        wall: the wall clock [s].

    Returns:
        What was left out, by the names in `Breaks`.

    Raises:
        WorldLawBroken: the world does not keep a law of its contract.
    """
    trial = WorldTrial(make_world(), wall)
    try:
        for law in LAWS:
            _try(law, trial)
    finally:
        _leave(trial.world)
    left_out = []
    for name, law in BROKEN_LAWS.items():
        break_it = getattr(breaks, name, None)
        if break_it is None:
            left_out.append(name)
            continue
        trial = WorldTrial(make_world(), wall)
        try:
            trial.observe()
            break_it(trial.world)
            _try(law, trial)
        finally:
            _leave(trial.world)
    return left_out


def _leave(world: World) -> None:
    """Leave no robot moving, whatever ended the trial: a broken law, Ctrl-C, a driver that raises when stopped."""
    for _ in range(STOPS):
        try:
            world.stop()
        except Exception:
            time.sleep(AGAIN)
        else:
            break
    world.close()


def _try(law: Law, trial: WorldTrial) -> None:
    trial.law = law.__name__
    try:
        law(trial)
    except WorldLawBroken:
        raise
    except Exception as error:
        trial.hold(False, f"{type(error).__name__}: {error}")
