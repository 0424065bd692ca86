"""What is tried again at an arm before it is given up, and before the other one is dressed."""

import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.sim.faults import FaultyWorld, parse_fault
from caretree.skills.carry_sleeve import CarrySleeve
from caretree.skills.check_sleeve import CheckSleeve
from caretree.skills.core.reasons import Reason, SkillFailure
from caretree.skills.geometry.stances import stance
from caretree.skills.grasp_sleeve import GraspSleeve
from caretree.skills.lift_arm import LiftArm
from caretree.skills.look_at_person import LookAtPerson
from caretree.skills.lower_arm import LowerArm
from caretree.skills.navigate import Navigate
from caretree.skills.pull_along_arm import PullAlongArm
from caretree.skills.retreat import Retreat
from caretree.trees.run.runner import Run
from caretree.trees.run.task import load_task
from caretree.trees.tasks.dressing.check_over_hand import CheckOverHand


def rehearsed(*faults):
    """Names and status of all that the stage told, in turn, rehearsed with these faults until it succeeds."""
    task, told = load_task("dressing"), []
    inner, senses = task.scripted(1)
    world = FaultyWorld(inner, [parse_fault(fault) for fault in faults])
    told_of = {"on_progress": lambda progress: told.append((progress.name, progress.status))}
    run = Run(task, world, seed=1, senses=senses, params=task.parameters("dress"), **told_of)
    assert run.run().outcome == "success"
    return told


@pytest.mark.parametrize("side", ["right", "left"])
def test_an_arm_that_is_lost_is_looked_for_from_farther_off(monkeypatch, side):
    said, look, drive, lift = [], LookAtPerson.steps, Navigate.steps, LiftArm.steps

    def lost_at_first(self):
        if self.name == f"{side} arm/look" and not any(step == f"{side} arm/far/look" for step, _ in said):
            said.append((self.name, None))
            raise SkillFailure(Reason.ARM_LOST, "")
        said.append((self.name, None))
        yield from look(self)

    def told(self):
        said.append((self.name, self.goal))
        yield from drive(self)

    def lifts(self):
        said.append((self.name, None))
        yield from lift(self)

    for skill, steps in ((LookAtPerson, lost_at_first), (Navigate, told), (LiftArm, lifts)):
        monkeypatch.setattr(skill, "steps", steps)
    rehearsed()
    names = [name for name, _ in said]
    first = names.index(f"{side} arm/look")
    expected = ["look", "far/go off", "far/look", "far/come back", "look"]
    assert names[first : first + 5] == [f"{side} arm/{name}" for name in expected]
    assert said[first + 1][1] == f"bed_{side}"
    assert said[first + 3][1] == pytest.approx(stance(side, "lift"))
    assert f"{side} arm/lift" in names[first + 5 :]


@pytest.mark.parametrize("side", ["right", "left"])
def test_an_arm_that_meets_the_hand_that_lowers_it_is_lowered_on_and_its_sleeve_pulled_up(side):
    leaf = f"{side} arm/lower it and let go"
    ended = rehearsed(f"force_spike@{leaf}:step")
    failed = ended.index((leaf, "failure"))
    rest = [name for name, status in ended[failed + 1 :] if status == "success"]
    assert rest[:3] == [f"{side} arm/lower it on", leaf, f"{side} arm/pull up"]


@pytest.mark.parametrize("side", ["right", "left"])
def test_a_hand_that_meets_the_dressed_arm_as_it_draws_back_does_not_take_the_sleeve_off_again(side):
    leaf = f"{side} arm/back off"
    ended = rehearsed(f"force_spike@{leaf}:step")
    failed = ended.index((leaf, "failure"))
    assert (f"{side} arm/on/back off", "success") in ended[failed:]
    assert ended.count((f"{side} arm/lift", "success")) == 1


@pytest.mark.parametrize(
    ("lows", "pulls"),
    [(0, 0), (1, 1), (5, 1)],  # one that stays low is left so, as the next pull met the arm with 27 N (146)
)
def test_a_first_sleeve_that_is_low_is_pulled_up_again_before_the_other_arm_is_lifted(monkeypatch, lows, pulls):
    look, looked = CheckSleeve.steps, []

    def low_at_first(self):
        if self.name == "first sleeve/up the arm":
            looked.append(self.min_reach)
            if len(looked) <= lows:
                raise SkillFailure(Reason.SLEEVE_LOW, "")
        yield from look(self)

    monkeypatch.setattr(CheckSleeve, "steps", low_at_first)
    done = [name for name, status in rehearsed() if status == "success"]
    assert done[: done.index("left arm/lift")].count("first sleeve/pull up") == pulls
    assert 0.0 < looked[0] < 0.7


@pytest.mark.parametrize("side", ["right", "left"])
@pytest.mark.parametrize(("misses", "lifts"), [(1, 1), (2, 2)])
def test_a_sleeve_is_taken_off_again_only_where_a_look_from_the_shoulder_says_so_too(monkeypatch, side, misses, lifts):
    look, missed = CheckSleeve.steps, []

    def beside_at_first(self):
        if self.name == f"{side} arm/is inside" and len(missed) < misses:
            missed.append(self.name)
            raise SkillFailure(Reason.SLEEVE_MISSED, "")
        yield from look(self)

    monkeypatch.setattr(CheckSleeve, "steps", beside_at_first)
    ended = rehearsed()
    first = ended.index((f"{side} arm/is inside", "failure"))
    told = [name for name, status in ended[first + 1 :] if status == "success"]
    closely = ["go round to its side", "go up to it", "go up and look"]
    assert told[:3] == [f"{side} arm/surely/{name}" for name in closely]
    assert ended.count((f"{side} arm/lift", "success")) == lifts


def test_a_second_sleeve_out_of_reach_from_its_side_is_fetched_from_the_other_before_the_arm_is_lifted(monkeypatch):
    def out_of_reach_on_its_side(steps):
        def tried(self):
            if self.name.startswith("second sleeve/") and self.world.observe().pose_base_in_map[0] < 0.0:
                raise SkillFailure(Reason.UNREACHABLE, "")
            yield from steps(self)

        return tried

    for skill in (CarrySleeve, GraspSleeve):
        monkeypatch.setattr(skill, "steps", out_of_reach_on_its_side(skill.steps))
    done = [name for name, status in rehearsed() if status == "success"]
    fetched = ["go to the other side", "carry it across", "clear of it", "go back to its side"]
    first = done.index(f"second sleeve/{fetched[0]}")
    assert done[first : first + 4] == [f"second sleeve/{name}" for name in fetched]
    assert first < done.index("left arm/lift")


def test_an_arm_that_is_not_where_it_was_taken_to_be_up_is_looked_at_from_farther_off(monkeypatch):
    lower, missed = LowerArm.steps, []

    def misses(self):
        if self.name in ("right arm/in the end/lower", "right arm/in the end/lower there"):
            missed.append(self.name)
            raise SkillFailure(Reason.GRASP_MISSED, "")
        yield from lower(self)

    monkeypatch.setattr(LowerArm, "steps", misses)
    said = rehearsed()
    assert len(missed) == 2
    assert ("right arm/in the end/lower from there", "success") in said
    assert not any(name.startswith("right arm/again/") for name, _ in said), "the sleeve stays on the arm"


def test_an_arm_is_begun_again_although_the_guard_stopped_the_hands_as_they_drew_back(monkeypatch):
    retreat, grasp, said = Retreat.steps, GraspSleeve.steps, []

    def too_fast(self):
        said.append(self.name)
        if self.name == "left arm/again/free hands" and said.count(self.name) == 1:
            raise SkillFailure(Reason.SPEED_LIMIT, "left forearm at 0.34 m/s")
        yield from retreat(self)

    def out_of_reach(self):
        said.append(self.name)
        if self.name == "left arm/grasp the sleeve" and said.count(self.name) == 1:
            raise SkillFailure(Reason.UNREACHABLE, "")
        yield from grasp(self)

    monkeypatch.setattr(Retreat, "steps", too_fast)
    monkeypatch.setattr(GraspSleeve, "steps", out_of_reach)
    rehearsed()
    assert said.count("left arm/again/free hands") == 2


@pytest.mark.parametrize("side", ["right", "left"])
def test_a_sleeve_that_is_over_the_hand_is_drawn_on_and_not_laid_out_or_lifted_into(monkeypatch, side):
    look, pull = CheckOverHand.steps, PullAlongArm.steps
    caught = []

    def over_it_once_caught(self):
        if self.name.startswith(f"{side} arm/") and caught:
            return
        yield from look(self)

    def caught_at_first(self):
        if self.name == f"{side} arm/pull over the hand" and not caught:
            caught.append(self.name)
            raise SkillFailure(Reason.MOTION_BLOCKED, "")
        yield from pull(self)

    monkeypatch.setattr(CheckOverHand, "steps", over_it_once_caught)
    monkeypatch.setattr(PullAlongArm, "steps", caught_at_first)
    ended = rehearsed()
    failed = ended.index((f"{side} arm/pull over the hand", "failure"))
    told = [name for name, status in ended[failed + 1 :] if status == "success" and name.startswith(f"{side} arm/")]
    begun = told.index(f"{side} arm/again/over the hand by now")
    expected = ["over the hand already", "go where it sits", "look where it sits", "take it as it sits", "pull up"]
    assert told[begun + 1 : begun + 6] == [f"{side} arm/{name}" for name in expected]
    assert ended.count((f"{side} arm/lift", "success")) == 1


def test_an_arm_whose_sleeve_is_nowhere_is_not_lifted_time_and_again(monkeypatch):
    task, lifts = load_task("dressing"), []
    world, senses = task.scripted(1)

    def nowhere(see):
        def answer(frame, *, side, **asked):
            if side == "left":
                raise PerceptionFailure(Problem.NOTHING_SEEN, "armhole")
            return see(frame, side=side, **asked)

        return answer

    for name in ("sleeve_opening", "sleeve_strap"):
        monkeypatch.setattr(senses, name, nowhere(getattr(senses, name)))

    def told(progress):
        if progress.name.startswith("left") and progress.name.endswith("/lift") and progress.status == "success":
            lifts.append(progress.name)

    run = Run(task, world, seed=1, senses=senses, params=task.parameters("dress"), on_progress=told)
    assert run.run().outcome == "safe_stop"
    assert lifts == [*["left arm/lift"] * 3, "left 2nd/lift"], "on the floor, nothing brings it back"
