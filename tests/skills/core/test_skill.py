import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.sim.errors import CaretreeError
from caretree.sim.scripted.world import ScriptedWorld
from caretree.sim.world import EmergencyStop, HandTwist, SensorLost, SensorStale
from caretree.skills.core.context import Context
from caretree.skills.core.ports import Input, Key, Output, PortError
from caretree.skills.core.reasons import Failure, Reason, SkillFailure
from caretree.skills.core.skill import Skill
from caretree.skills.core.world_handle import LeaseError
from caretree.skills.motion.errors import MotionBlocked, PathBlocked
from caretree.trees.guard.guard import GuardedWorld
from py_trees.common import Status

from ..fake_senses import fake_senses


def make_context(**kwargs):
    world = ScriptedWorld()
    guard = GuardedWorld(world)
    return Context(world=guard, guard=guard, **kwargs), world


class Count(Skill):
    commands = False
    ticks = Input(int)
    counted = Output(int)

    def steps(self):
        for n in range(self.ticks):
            self.counted = n + 1
            yield


class Raise(Skill):
    error = Input(Exception)

    def steps(self):
        yield
        raise self.error


def test_steps_yield_once_per_tick_and_return_to_succeed():
    context, _ = make_context()
    skill = Count("count", context, ticks=2, counted=Key("n"))
    skill.tick_once()
    assert (skill.status, context.board.get("n")) == (Status.RUNNING, 1)
    skill.tick_once()
    skill.tick_once()
    assert (skill.status, context.board.get("n")) == (Status.SUCCESS, 2)


def test_outputs_are_unset_on_entry():
    context, _ = make_context()
    skill = Count("count", context, ticks=1, counted=Key("n"))
    while skill.status != Status.SUCCESS:
        skill.tick_once()
    assert "n" in context.board

    def late():
        yield
        skill.counted = 5

    skill.steps = late
    skill.tick_once()
    assert "n" not in context.board, "an earlier round's value must not be read in this one"
    skill.tick_once()
    assert context.board.get("n") == 5


@pytest.mark.parametrize(
    ("error", "reason"),
    [
        (SkillFailure(Reason.UNREACHABLE, "0.2 m short"), Reason.UNREACHABLE),
        (SensorLost("the head camera is dead"), Reason.SENSOR_LOST),
        (SensorStale("the head image is 2 s old"), Reason.SENSOR_STALE),
        (EmergencyStop("the red button"), Reason.EMERGENCY_STOP),
        (PerceptionFailure(Problem.NOTHING_SEEN, "the gown"), Reason.NOTHING_SEEN),
        (PerceptionFailure(Problem.ARM_LOST, "the left arm"), Reason.ARM_LOST),
        (PathBlocked("no way to the rail"), Reason.PATH_BLOCKED),
        (MotionBlocked("the elbow hits the rail"), Reason.MOTION_BLOCKED),
        (KeyError("x"), Reason.INTERNAL_ERROR),
        (PortError("x"), Reason.INTERNAL_ERROR),
    ],
)
def test_each_kind_of_failure_has_a_reason(error, reason):
    context, _ = make_context()
    skill = Raise("raise", context, error=error)
    skill.tick_once()
    skill.tick_once()
    assert skill.status == Status.FAILURE
    assert skill.failure.reason == reason
    assert skill.failure.node == "raise"
    assert skill.feedback_message.startswith(reason.value)
    assert bool(context.errors) == (reason == Reason.INTERNAL_ERROR)


def test_an_interrupt_of_the_operator_is_not_swallowed():
    context, _ = make_context()

    class Interrupted(Skill):
        def steps(self):
            yield
            raise KeyboardInterrupt

    skill = Interrupted("interrupted", context)
    skill.tick_once()
    with pytest.raises(KeyboardInterrupt):
        skill.tick_once()


def test_a_fault_of_the_guard_ends_the_running_skill_only():
    context, _ = make_context()
    faults = [None, Failure(Reason.FORCE_LIMIT, "20 N")]
    context.guard.take_fault = lambda: faults.pop() if faults else None
    skill = Raise("raise", context, error=KeyError())
    faults[:] = [Failure(Reason.FORCE_LIMIT, "19 N")]
    skill.tick_once()
    assert skill.status == Status.RUNNING, "a fault from before its start belongs to another skill"
    faults[:] = [Failure(Reason.FORCE_LIMIT, "20 N")]
    skill.tick_once()
    assert (skill.failure.reason, skill.failure.detail) == (Reason.FORCE_LIMIT, "20 N")


def test_a_skill_that_only_looks_may_not_command():
    context, _ = make_context()

    class Sneaky(Skill):
        commands = False

        def steps(self):
            self.world.send(HandTwist(side="left", twist_in_map=np.zeros(6)))
            yield

    skill = Sneaky("sneaky", context)
    skill.tick_once()
    assert "may not command" in skill.failure.detail
    with pytest.raises(LeaseError):
        skill.world.stop()


def test_success_while_still_moving_keeps_the_lease_until_it_stands():
    context, world = make_context()

    class Hasty(Skill):
        def steps(self):
            self.world.send(HandTwist(side="left", twist_in_map=np.array((0.1, 0, 0, 0, 0, 0)), duration=5.0))
            yield

    skill = Hasty("hasty", context)
    skill.tick_once()
    world.clock.wait_until(0.1)
    skill.tick_once()
    assert skill.status == Status.SUCCESS
    assert context.lease.holder is skill
    world.clock.wait_until(0.15)
    context.lease.advance()
    assert context.lease.holder is skill, "it has been told to stop but still runs on"
    world.clock.wait_until(0.4)
    context.lease.advance()
    assert context.lease.holder is None
    assert context.guard.still()


def test_generators_run_their_own_clean_up_when_preempted():
    context, _ = make_context()
    seen = []

    class Tidy(Skill):
        commands = False

        def steps(self):
            try:
                yield
                yield
            finally:
                seen.append("tidy")

    skill = Tidy("tidy", context)
    skill.tick_once()
    skill.stop(Status.INVALID)
    skill.stop(Status.INVALID)
    assert seen == ["tidy"]


def test_an_error_in_cancel_still_stops_the_robot():
    context, world = make_context()

    class Clumsy(Skill):
        def steps(self):
            self.world.send(HandTwist(side="left", twist_in_map=np.array((0.1, 0, 0, 0, 0, 0)), duration=5.0))
            while True:
                yield

        def cancel(self):
            raise ZeroDivisionError("planted")

    skill = Clumsy("clumsy", context)
    skill.tick_once()
    world.clock.wait_until(0.1)
    skill.stop(Status.INVALID)
    for _ in range(3):
        world.clock.wait_until(world.clock.now() + 0.1)
        context.lease.advance()
    assert context.lease.holder is None
    assert context.guard.still()
    assert "planted" in context.errors[0]


def test_forgotten_yields_and_steps_are_told():
    context, _ = make_context()

    class NoYield(Skill):
        def steps(self):
            return None

    skill = NoYield("no yield", context)
    skill.tick_once()
    assert "must be a generator" in skill.failure.detail


def test_waiting_and_until_follow_the_worlds_clock():
    context, world = make_context()

    class Patient(Skill):
        commands = False

        def steps(self):
            yield from self.wait(1.0)
            yield from self.until(lambda: False, timeout=0.5, reason=Reason.COMMAND_LOST)

    skill = Patient("patient", context)
    times = {}
    for tick in range(40):
        world.clock.wait_until(0.1 * tick)
        skill.tick_once()
        if skill.status == Status.FAILURE:
            times[skill.failure.reason] = world.clock.now()
            break
    assert times == {Reason.COMMAND_LOST: pytest.approx(1.5, abs=0.11)}


def test_senses_that_a_task_offers_do_not_replace_those_given_before():
    given, offered = fake_senses(), fake_senses()
    context, _ = make_context(senses=given)
    context.offer_senses(offered)
    assert context.senses is given
    context, _ = make_context()
    context.offer_senses(offered)
    assert context.senses is offered


def test_a_run_without_senses_says_so_when_it_is_asked():
    context, _ = make_context()
    with pytest.raises(CaretreeError, match="this run has no senses"):
        context.senses  # noqa: B018 - asking is what fails


def test_memory_makes_an_object_once():
    context, _ = make_context()
    first = context.memory.of(dict, dict, name="left")
    assert context.memory.of(dict, name="left") is first
    with pytest.raises(Exception, match="memory holds no dict 'right'"):
        context.memory.of(dict, name="right")
