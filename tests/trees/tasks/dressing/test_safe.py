"""An arm that is seen up when the run ends is put down, from beside it where it is out of reach."""

import pytest
from caretree.skills.core.reasons import Reason, SkillFailure
from caretree.skills.geometry.stances import stance
from caretree.skills.lower_arm import LowerArm
from caretree.skills.navigate import Navigate
from caretree.skills.release_arm import ReleaseArm
from caretree.skills.retreat import Retreat
from caretree.trees.nodes.decorators import FailSafe
from caretree.trees.run.runner import Run
from caretree.trees.run.task import load_task


def ended(monkeypatch, reason):
    """Where the robot drove in the safe branch, and whether the left arm was put down in the end."""
    driven, lowered = [], []

    def lower(self):
        if self.side == "left" and not driven:
            raise SkillFailure(reason, "")
        lowered.append(self.side)
        yield

    def drive(self):
        if not self.name.startswith("safe"):
            raise SkillFailure(Reason.PATH_BLOCKED, "that is where the run ends")
        driven.append(self.goal)
        yield

    monkeypatch.setattr(LowerArm, "steps", lower)
    monkeypatch.setattr(Navigate, "steps", drive)
    task = load_task("dressing")
    world, senses = task.scripted(1)
    run = Run(task, world, seed=1, senses=senses, params=task.parameters("dress"))
    assert run.run().outcome == "safe_stop"
    assert next(node for node in run.root.iterate() if isinstance(node, FailSafe)).made_safe
    return driven, lowered


def test_the_robot_drives_to_an_arm_that_it_does_not_reach(monkeypatch):
    driven, lowered = ended(monkeypatch, Reason.UNREACHABLE)
    assert driven == [pytest.approx(stance("left", "lift"))]
    assert lowered == ["left", "right"]


@pytest.mark.parametrize("reason", [Reason.ARM_LOST, Reason.NOTHING_SEEN, Reason.SENSOR_LOST])
def test_it_does_not_drive_to_one_that_it_does_not_see(monkeypatch, reason):
    driven, lowered = ended(monkeypatch, reason)
    assert not driven
    assert lowered == ["right"]


@pytest.mark.parametrize("times", [1, 3])
def test_both_arms_are_put_down_although_the_guard_stops_the_hands_first(monkeypatch, times):
    release, retreat, stopped = ReleaseArm.steps, Retreat.steps, []

    def too_fast(steps):
        def some(self):
            if self.name.startswith("safe/") and stopped.count(self.name) < times:
                stopped.append(self.name)
                raise SkillFailure(Reason.SPEED_LIMIT, "right elbow at 0.42 m/s")
            yield from steps(self)

        return some

    monkeypatch.setattr(ReleaseArm, "steps", too_fast(release))
    monkeypatch.setattr(Retreat, "steps", too_fast(retreat))
    _, lowered = ended(monkeypatch, Reason.UNREACHABLE)
    assert "safe/let go and back off" in stopped
    assert {"safe/left hand/lower", "safe/right hand/lower"} <= set(stopped)
    assert not any(name.endswith("/open") for name in stopped), "no fingers open with an arm in the air"
    assert lowered == ["left", "right"]
