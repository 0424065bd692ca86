"""An arm that is lost where it is to be lifted is looked for from farther off, and only then given up."""

import pytest
from caretree.sim.faults import FaultyWorld, parse_fault
from caretree.skills.core.reasons import Reason, SkillFailure
from caretree.skills.geometry.stances import stance
from caretree.skills.lift_arm import LiftArm
from caretree.skills.look_at_person import LookAtPerson
from caretree.skills.navigate import Navigate
from caretree.trees.run.runner import Run
from caretree.trees.run.task import load_task


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
    task = load_task("dressing")
    world, senses = task.scripted(1)
    assert Run(task, world, seed=1, senses=senses, params=task.parameters("dress")).run().outcome == "success"
    names = [name for name, _ in said]
    first = names.index(f"{side} arm/look")
    expected = ["look", "far/go off", "far/look", "far/come back", "look"]
    assert names[first : first + 5] == [f"{side} arm/{name}" for name in expected]
    assert said[first + 1][1] == f"bed_{side}"
    assert said[first + 3][1] == pytest.approx(stance(side, "lift"))
    assert f"{side} arm/lift" in names[first + 5 :]


@pytest.mark.parametrize("side", ["right", "left"])
def test_an_arm_that_meets_the_hand_that_lowers_it_is_lowered_on_and_its_sleeve_pulled_up(side):
    task = load_task("dressing")
    inner, senses = task.scripted(1)
    leaf = f"{side} arm/lower it and let go"
    world = FaultyWorld(inner, [parse_fault(f"force_spike@{leaf}:step")])
    ended = []
    run = Run(
        task,
        world,
        seed=1,
        senses=senses,
        params=task.parameters("dress"),
        on_progress=lambda progress: ended.append((progress.name, progress.status)),
    )
    assert run.run().outcome == "success"
    failed = ended.index((leaf, "failure"))
    rest = [name for name, status in ended[failed + 1 :] if status == "success"]
    assert rest[:3] == [f"{side} arm/lower it on", leaf, f"{side} arm/pull up"]
