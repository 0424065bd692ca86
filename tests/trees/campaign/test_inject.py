"""The fault campaign: what it reaches, what it finds, and that every fault of a sound task ends safely."""

from dataclasses import replace

import pytest
from caretree.sim.errors import CaretreeError
from caretree.sim.faults import FAULTS, FaultyWorld, parse_fault
from caretree.sim.scripted.world import ScriptedWorld
from caretree.sim.world import GripperOpening, SensorLost, World
from caretree.skills.core.reasons import Reason
from caretree.skills.core.skill import Skill
from caretree.trees.campaign.fault_row import Row, table
from caretree.trees.campaign.fresh_rows import fresh_rows
from caretree.trees.campaign.inject import Campaign
from caretree.trees.campaign.ways import triggers_of
from caretree.trees.nodes.composers import fallback, sequence
from caretree.trees.nodes.decorators import FailSafe, RecoverBy
from caretree.trees.run.runner import Run, run
from caretree.trees.run.task import load_task, task_names
from caretree.trees.run.worlds import prepare_stage

from ..planted import Look, Plan, Release, run_of, task_of


def campaign(task, **kwargs):
    return Campaign(task, lambda: task.scripted(0), **kwargs)


class Grasp(Skill):
    """Takes hold of the person's arm, as a lift does."""

    def steps(self):
        self.world.send(GripperOpening(side="left", opening=0.0))
        yield from self.wait(1.0)
        self.context.guard.declare_grip("left", "arm")
        yield from self.wait(0.5)
        if self.world.observe().gripper_opening[0] < 0.01:
            from caretree.skills.core.reasons import SkillFailure

            raise SkillFailure(Reason.ARM_SLIPPED)


def holding(seed):
    world = ScriptedWorld(seed=seed)
    world.between_fingers["left"] = 0.05
    return world, None


@pytest.mark.no_cover  # counting lines doubles its time
@pytest.mark.parametrize("name", task_names())
def test_every_fault_at_every_node_and_phase_that_a_bare_world_reaches_ends_safely(name):
    """Without its own script the dressing ends at the rail; rehearsing all of it takes hours (docs/results.md)."""
    rows = list(campaign(replace(load_task(name), script=None)).rows())
    assert len(rows) == len({row.key for row in rows})
    assert [row for row in rows if not row.survived] == []
    reached = {(row.node, row.phase) for row in rows if row.outcome != "not_reached"}
    assert len(reached) >= 5


def test_faults_that_a_world_does_not_play_are_left_out_before_the_first_row():
    class NoPhysics(World):
        """A robot's adapter: nothing of it makes a person stir."""

        def __init__(self):
            inner = ScriptedWorld()
            self.clock, self.room, self.robot = inner.clock, inner.room, inner.robot
            self.kinematics = inner.kinematics
            self.observe, self.look, self.send, self.stop = inner.observe, inner.look, inner.send, inner.stop

    NoPhysics.__abstractmethods__ = frozenset()
    task = replace(load_task("wave"), script=None)
    tried = Campaign(task, lambda: (NoPhysics(), None))
    assert tried.left_out == ("grip_slip", "person_moves")
    assert not {fault for _, _, fault in tried.plan()} & set(tried.left_out)
    with pytest.raises(CaretreeError, match="cannot play grip_slip"):
        list(Campaign(task, lambda: (NoPhysics(), None), faults=("grip_slip",)).rows())


def test_the_dressing_is_rehearsed_from_the_rail_to_the_bed():
    task = load_task("dressing")
    world, senses = task.scripted(0)
    result = run(task, world, senses=senses)
    assert [(stage.name, stage.status, stage.attempts) for stage in result.stages] == [
        (name, "success", 1) for name in ("take down", "lay", "dress", "spread")
    ]
    assert result.outcome == "success"


@pytest.mark.parametrize(("stage", "end"), [("lay", 60.0), ("spread", 90.0)])
def test_a_stage_of_the_dressing_is_rehearsed_alone(stage, end):
    task = load_task("dressing")
    world, senses = task.scripted(1)
    prepare_stage(world, task, stage)
    result = run(task, world, seed=1, senses=senses, params=task.parameters(stage))
    assert (result.outcome, len(result.stages)) == ("success", 1), result.reason
    assert result.sim_time_s < end


def test_recoveries_and_safe_branches_are_reached_too():
    rows = list(campaign(load_task("wave"), faults=("lost_command",)).rows())
    reached = {(row.node, row.phase): row.outcome for row in rows}
    assert reached["wait", "start"] == "success"
    assert reached["let go", "start"] == "safe_stop"
    assert reached["hand up", "cancel"] == "safe_stop"


def test_an_arm_is_never_left_held():
    def build(context):
        body = sequence(
            "s",
            Grasp("grasp arm", context),
            Plan("lift", context, outcomes=[True], ticks=30),
            Release("put down", context),
        )
        return FailSafe("safe", body, Release("let go", context))

    rows = list(campaign(task_of(build, holding)).rows())
    assert [row for row in rows if not row.survived] == []
    outcomes = {(row.node, row.phase, row.fault): row.outcome for row in rows}
    assert outcomes["lift", "step", "force_spike"] == "safe_stop"
    assert outcomes["lift", "step", "dead_sensor"] == "safe_stop"
    assert outcomes["grasp arm", "step", "grip_slip"] == "safe_stop"
    assert outcomes["lift", "step", "occlusion"] == "success"


def test_an_unsafe_task_is_found_out():
    """The task forgets the arm in its hand: it says success and holds on."""

    def build(context):
        return FailSafe("safe", Grasp("grasp arm", context), Release("let go", context))

    rows = list(campaign(task_of(build, holding), faults=("occlusion",)).rows())
    bad = [row for row in rows if not row.survived]
    assert {row.unsafe for row in bad} == {"the left hand still holds the person's arm"}
    assert "UNSAFE" in table(rows)
    assert "not survived: occlusion@grasp arm:step: success, the left hand still holds the person's arm" in table(rows)


def test_an_unrecovered_fault_without_a_safe_branch_still_ends_safely():
    rows = list(campaign(task_of(lambda context: Plan("p", context, outcomes=[True], ticks=20))).rows())
    assert [row for row in rows if not row.survived] == []


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_happens_where_it_is_told(fault):
    world = FaultyWorld(ScriptedWorld(), [parse_fault(f"{fault}@hand back:step")])
    Run(load_task("wave"), world).run()
    ((spec, time),) = world.begun
    assert spec.node == "hand back"
    assert 2.0 < time < 3.1


def test_a_lost_command_is_recovered_by_its_reason():
    world = FaultyWorld(ScriptedWorld(), [parse_fault("lost_command@hand up:start")])
    run = Run(load_task("wave"), world)
    result = run.run()
    assert result.outcome == "success"
    assert result.stages[0].attempts == 2
    failed = [event for event in run.trace.events if event.get("reason") == "COMMAND_LOST"]
    assert failed


def test_a_fault_at_an_unknown_node_is_refused():
    with pytest.raises(Exception, match="names no skill of this task; there are 'hand back', 'hand up'"):
        Run(load_task("wave"), FaultyWorld(ScriptedWorld(), [parse_fault("occlusion@nobody:start")]))


def test_finished_rows_are_not_run_again():
    task = load_task("wave")
    everything = campaign(task, faults=("occlusion",))
    done = {key for key in everything.plan() if key[0] != "hold still"}
    left = [key for key in everything.plan() if key not in done]
    assert {row.node for row in everything.rows(left)} == {"hold still"}


def test_what_is_not_reached_is_said():
    def build(context):
        never = RecoverBy(
            "r",
            Look("look", context, outcomes=[True], ticks=0),
            {Reason.NOTHING_SEEN: lambda: Plan("recover", context, outcomes=[True])},
        )
        return FailSafe("safe", never, Release("let go", context))

    rows = list(campaign(task_of(build), faults=("occlusion",)).rows())
    reached = {(row.node, row.phase) for row in rows if row.outcome != "not_reached"}
    assert ("look", "start") in reached
    assert ("look", "step") not in reached, "it ends at once"
    assert ("recover", "start") in reached, "look is made to fail"
    assert Row(node="a", phase="step", fault="b", outcome="not_reached").survived
    assert not Row(node="a", phase="step", fault="b", outcome="failure").survived


def test_a_run_on_a_world_with_faults_repeats_exactly():
    hashes = {
        run_of(
            lambda context: load_task("wave").build(context),
            FaultyWorld(ScriptedWorld(), [parse_fault("lost_command@hand up:start")]),
        )
        .run()
        .trace_hash
        for _ in range(2)
    }
    assert len(hashes) == 1


def test_an_operator_who_ends_a_run_ends_the_campaign():
    class Pressed(Look):
        """Ctrl-C in the second run, the first with a fault."""

        def steps(self):
            if self.world.observe().time > 0.3 and len(begun) > 1:
                raise KeyboardInterrupt
            begun.append(1)
            yield from self.wait(0.5)

    begun = []

    def build(context):
        return FailSafe(
            "safe",
            sequence("s", Pressed("a", context, outcomes=[True]), Pressed("b", context, outcomes=[True])),
            Release("let go", context),
        )

    rows = campaign(task_of(build), faults=("occlusion",)).rows()
    with pytest.raises(KeyboardInterrupt):
        list(rows)


def test_alternatives_and_recoveries_inside_each_other_are_reached():
    def plan(context, name):
        return Plan(name, context, outcomes=[True])

    def build(context):
        def recovery():
            return fallback("r", plan(context, "recovery"), plan(context, "other recovery"))

        first = fallback("first", plan(context, "a"), plan(context, "b"))
        second = sequence("second", plan(context, "c"), plan(context, "d"))
        body = RecoverBy("again", fallback("f", first, second), {Reason.GRASP_MISSED: recovery})
        return FailSafe("safe", body, Release("release", context))

    task = task_of(build)
    found = triggers_of(build(Run(task, ScriptedWorld()).context))
    assert found["a"] == {}
    assert set(found["b"]) == {"a"}
    assert set(found["c"]) == set(found["d"]) == {"a", "b"}
    assert found["recovery"] == {"a": Reason.GRASP_MISSED, "b": Reason.GRASP_MISSED, "c": Reason.GRASP_MISSED}
    assert found["other recovery"] == {**found["recovery"], "recovery": Reason.INTERNAL_ERROR}
    campaign = Campaign(task, lambda: (ScriptedWorld(), None), faults=("stale_frame",))
    reached = {row.node for row in campaign.rows() if row.outcome != "not_reached" and row.phase == "start"}
    assert reached == {"a", "b", "c", "d", "recovery", "other recovery", "release"}


class Outliving(ScriptedWorld):
    """One robot for all runs."""

    def __init__(self):
        super().__init__()
        self.restarts = 0

    def restart(self):
        self.restarts += 1


def test_a_world_that_outlives_its_runs_begins_anew_before_each():
    world = Outliving()
    campaign = Campaign(load_task("wave"), lambda: (world, None), faults=("stale_frame",))
    assert world.restarts == 1
    maker = campaign._maker
    maker.run()
    assert world.restarts == 2


def test_runs_that_share_a_robot_have_no_jobs():
    with pytest.raises(CaretreeError, match="Outliving has one robot for all runs: no --jobs, no --address"):
        Campaign(load_task("wave"), lambda: (Outliving(), None), jobs=2)


def test_a_run_of_a_shared_robot_that_ended_early_says_how_and_the_next_one_is_tried():
    """In another process no two runs are alike: one that ends before its fault must not be passed over in silence."""
    runs = []

    class Dies(Outliving):
        def observe(self):
            if runs[-1] is self and len(runs) == 2:  # the first run of a row, not that without a fault
                raise SensorLost("nothing has come on /robot/joint_states")
            return super().observe()

    def made():
        runs.append(Dies())
        return runs[-1], None

    campaign = Campaign(load_task("wave"), made, faults=("occlusion", "lost_command"))
    keys = [("hand up", "step", "occlusion"), ("hand up", "step", "lost_command")]
    first, second = fresh_rows(campaign._maker, {key: campaign.way(*key[:2]) for key in keys})
    assert first.outcome == "not_reached"
    assert "nothing has come on /robot/joint_states" in first.reason
    assert first.unsafe == "nobody knows whether anything moves: nothing has come on /robot/joint_states"
    assert second.outcome == "success"
