"""The stage `take_down`, rehearsed with a gown whose neckline's ends cannot be taken on the hook."""

import pytest
from caretree.skills.core.reasons import Reason, SkillFailure
from caretree.skills.flip_side_check import FlipSideCheck
from caretree.skills.navigate import Navigate
from caretree.skills.pre_grasp_manipulate import PreGraspManipulate
from caretree.skills.raise_corner import RaiseCorner
from caretree.skills.take_corner import TakeCorner
from caretree.skills.unhook import Unhook
from caretree.trees.run.runner import Run
from caretree.trees.run.task import load_task

FIRST = ["one hand/take a corner"]
AGAIN = ["again/take a corner", "again other/take a corner"]
THIRD = ["anew/take a corner", "anew other/take a corner"]


@pytest.mark.parametrize(
    ("hidden", "took", "ends"),
    [
        ((), [*FIRST, "one hand other/take a corner"], "success"),
        (("one hand other/",), [*FIRST, *AGAIN], "success"),
        (("one hand other/take a corner",), [*FIRST, "one hand other/take the best there is"], "success"),
        (("one hand other/", "again other/"), [*FIRST, AGAIN[0], *THIRD], "success"),
        (("one hand/",), THIRD, "success"),
        (("one hand/", "again/", "anew/", "once more/"), [], "safe_stop"),
    ],
)
def test_a_gown_of_which_the_second_corner_does_not_show_is_begun_anew_from_the_hand_that_has_it(
    monkeypatch, hidden, took, ends
):
    take = PreGraspManipulate.steps

    def unseen(self):
        raise SkillFailure(Reason.NOTHING_SEEN, "")
        yield

    def hides(self):
        yield from unseen(self) if self.name.startswith(hidden) else take(self)

    def lifted(self):
        self.load = 4.0  # [N]; what hangs on one hand is no whole gown on the scripted world
        yield

    monkeypatch.setattr(TakeCorner, "steps", unseen)
    monkeypatch.setattr(Unhook, "steps", lifted)
    monkeypatch.setattr(PreGraspManipulate, "steps", hides)
    task, taken = load_task("dressing"), []

    def told(progress):
        if progress.status == "success" and "/take " in progress.name:
            taken.append(progress.name)

    world, senses = task.scripted(1)
    run = Run(task, world, seed=1, senses=senses, params={"stages": ("take_down",)}, on_progress=told)
    assert run.run().outcome == ends
    assert [name for name in taken if not name.endswith("near the hook")] == took


def test_a_corner_is_weighed_once_before_it_is_drawn_farther_round(monkeypatch):
    weighed = {}

    def draws(self):
        weighed[self.name] = self.max_load
        self.held_length = 0.4  # [m]
        yield

    def takes(self):
        if self.name.endswith(("other corner", "from beside")):
            raise SkillFailure(Reason.NOTHING_SEEN, "")
        self.length = 0.4  # [m]
        yield

    monkeypatch.setattr(RaiseCorner, "steps", draws)
    monkeypatch.setattr(TakeCorner, "steps", takes)
    task = load_task("dressing")
    world, senses = task.scripted(1)
    Run(task, world, seed=1, senses=senses, params={"stages": ("take_down",)}).run()
    assert weighed["rail/draw it aside"] < 3.0  # [N]: a gown weighs 4 to 4.8 N
    assert weighed["rail/draw it farther round"] == float("inf")


def test_a_robot_that_the_guard_stops_on_its_way_round_the_rail_goes_on(monkeypatch):
    drive, look, told = Navigate.steps, FlipSideCheck.steps, []

    def stopped_once(self):
        told.append(self.name)
        if self.name == "rail/other side/go behind it" and told.count(self.name) == 1:
            raise SkillFailure(Reason.SPEED_LIMIT, "left wrist 2 at 0.24 m/s")
        yield from drive(self)

    def wrong_once(self):
        told.append(self.name)
        if self.name == "rail/outside still to the front" and told.count(self.name) == 1:
            raise SkillFailure(Reason.WRONG_SIDE, "the inside faces the robot")
        yield from look(self)

    monkeypatch.setattr(Navigate, "steps", stopped_once)
    monkeypatch.setattr(FlipSideCheck, "steps", wrong_once)
    task = load_task("dressing")
    world, senses = task.scripted(1)
    Run(task, world, seed=1, senses=senses, params={"stages": ("take_down",)}).run()
    assert told.count("rail/other side/go behind it") == 2
    assert told.count("rail/outside still to the front") == 2, "and looks for the corners from there"


@pytest.mark.parametrize(("outside", "stands"), [(True, "before"), (False, "behind")])
def test_a_gown_is_taken_with_one_hand_from_square_before_or_behind_the_rail(monkeypatch, outside, stands):
    look, drive, told = FlipSideCheck.steps, Navigate.steps, []

    def unseen(self):
        raise SkillFailure(Reason.NOTHING_SEEN, "")
        yield

    def sees(self):
        if not outside and self.name == "rail/outside to the front":
            raise SkillFailure(Reason.WRONG_SIDE, "")
        yield from look(self)

    def tells(self):
        told.append(self.name)
        yield from drive(self)

    for skill, steps in ((TakeCorner, unseen), (FlipSideCheck, sees), (Navigate, tells)):
        monkeypatch.setattr(skill, "steps", steps)
    task = load_task("dressing")
    world, senses = task.scripted(1)
    Run(task, world, seed=1, senses=senses, params={"stages": ("take_down",)}).run()
    assert [name for name in told if name.startswith("one hand/")] == [f"one hand/stand {stands} it"]
