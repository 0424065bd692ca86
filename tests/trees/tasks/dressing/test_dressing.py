"""What the dressing tree is made of."""

import dataclasses

import numpy as np
import pytest
from caretree.sim.faults import FaultyWorld, parse_fault
from caretree.skills import (
    CarrySleeve,
    CheckSleeve,
    GraspSleeve,
    LaySleeve,
    PresentSleeve,
    PullAlongArm,
    Retreat,
    StretchNeckline,
)
from caretree.skills.belief.lying_sleeves import lying_sleeves, remember_laid
from caretree.skills.core.reasons import Reason, SkillFailure
from caretree.skills.scripted.scripted_senses import ScriptedSenses
from caretree.trees.nodes.decorators import RecoverBy
from caretree.trees.proof.check import fresh_tree
from caretree.trees.run.runner import Run
from caretree.trees.run.task import load_task


@pytest.fixture(scope="module")
def nodes():
    return list(fresh_tree(load_task("dressing")).iterate())


def leaf(nodes, name):
    return next(node for node in nodes if node.name == name)


def test_names_are_short_enough_to_read_in_a_table(nodes):
    assert [node.name for node in nodes if len(node.name) > 40] == []


def anew(node):
    """Whether it dresses an arm again whose sleeve is not on it after all."""
    return node.name.startswith(tuple(f"{side} {when}/" for side in ("left", "right") for when in ("before", "new")))


def other_way_round(node):
    """Whether it belongs to dressing the left arm first, where the right one does not come into its sleeve."""
    branches = ("freed", "yet", "2nd")
    return node.name.startswith(tuple(f"{side} {when}/" for side in ("left", "right") for when in branches))


@pytest.mark.parametrize(("side", "lifting", "pulling"), [("right", "left", "right"), ("left", "right", "left")])
def test_one_hand_holds_the_arm_and_the_other_one_its_sleeve(nodes, side, lifting, pulling):
    lift, grasp = leaf(nodes, f"{side} arm/lift"), leaf(nodes, f"{side} arm/grasp the sleeve")
    assert (lift.side, lift.hand, grasp.side, grasp.hand) == (side, lifting, side, pulling)
    over = leaf(nodes, f"{side} arm/pull over the hand")
    assert over.bindings["hold"] == lift.bindings["hold"], "the arm that is held moves while the sleeve is pulled over"
    assert over.bindings["grip"] == grasp.bindings["grip"]


def test_a_hold_of_one_arm_is_not_taken_for_the_other_ones(nodes):
    left, right = (leaf(nodes, f"{side} arm/lift").bindings["hold"] for side in ("left", "right"))
    assert left != right


def test_nobody_holds_an_arm_whose_sleeve_is_pulled_up_or_laid_out(nodes):
    free = [
        node
        for node in nodes
        if isinstance(node, (PullAlongArm, LaySleeve))
        and node.name.endswith(("pull up", "lay it beyond the hand", "lay it back"))
    ]
    # up, up again once it slipped, laid back: both arms; laid out: both, after the person has moved and after all else;
    # the first sleeve laid back before its gown is laid anew; up again before the second, which is laid out before its
    # arm is lifted where it has to be
    assert sum(not anew(node) and not other_way_round(node) for node in free) == 13
    assert sum(anew(node) for node in free) == 10, (
        "as often, but where the first one has slipped and the second one is at hand"
    )
    assert sum(other_way_round(node) for node in free) == 12, "as often, and either one laid back before"
    assert all(node.bindings["hold"] is None for node in free)


def test_the_arms_come_back_from_above_the_person_before_the_base_drives_round_the_bed(nodes):
    carries = [node for node in nodes if isinstance(node, CarrySleeve)]
    # the left sleeve after the right arm, and where it is out of reach before its own arm is lifted; either where it
    # does not show after the person has moved and after all else; out from its own side before the left arm, and for
    # both arms after the person has moved and after all else; the right one out before its gown is laid anew
    first = [carry.own_side for carry in carries if not anew(carry) and not other_way_round(carry)]
    assert (first.count(False), first.count(True)) == (6, 6)
    for carry in carries:
        once_more = carry.parent
        steps = once_more.parent.children
        assert isinstance(steps[steps.index(once_more) + 1], Retreat)


def test_the_second_sleeve_is_drawn_less_hard_than_the_first(nodes):
    first, second = (leaf(nodes, f"{side} arm/present the sleeve") for side in ("right", "left"))
    assert isinstance(first, PresentSleeve)
    assert second.max_load < first.max_load


def test_the_arm_is_lowered_before_the_sleeve_is_pulled_up_and_lies_before_it_is_looked_at(nodes):
    for side in ("right", "left"):
        names = [node.name for node in nodes if not node.children]
        order = [f"{side} arm/{name}" for name in ("lower it and let go", "pull up", "in the end/lower", "is inside")]
        assert leaf(nodes, order[0]).lower
        assert [names.index(name) for name in order] == sorted(names.index(name) for name in order)


def test_both_arms_lie_before_a_sleeve_is_drawn_up_again(nodes):
    names = [node.name for node in nodes if not node.children]
    for side in ("left", "right"):
        assert names.index(f"{side} sleeve/first/lower") < names.index("gown/sleeves/seat")


def test_both_hands_are_seen_to_before_the_robot_backs_off_and_arms_that_are_up_come_last(nodes):
    safe = next(node for node in nodes if node.name == "make safe")
    assert [child.name for child in safe.children] == [
        "safe/left hand/let down",
        "safe/right hand/let down",
        "safe/let go and back off, again",
        "safe: left arm",
        "safe: right arm",
    ]
    assert all(branch.children[0].body.lower for branch in safe.children[:2])
    assert all(isinstance(branch.children[-1], Retreat) for branch in safe.children[3:]), "no arm is owed at any price"


@pytest.mark.parametrize(("lying", "tries"), [(set(), 6), ({"left"}, 6), ({"right"}, 1)])
def test_the_left_arm_is_dressed_first_where_the_right_sleeve_lies_or_its_arm_does_not_come_in(
    monkeypatch, lying, tries
):
    present, check = PresentSleeve.steps, CheckSleeve.steps

    def caught(self):
        if self.name.startswith("right arm/"):
            raise SkillFailure(Reason.SLEEVE_CAUGHT, "")
        yield from present(self)

    def bare(self):
        if self.name.endswith("yet/worn already"):
            raise SkillFailure(Reason.SLEEVE_MISSED, "")
        yield from check(self)

    monkeypatch.setattr(PresentSleeve, "steps", caught)
    monkeypatch.setattr(CheckSleeve, "steps", bare)
    task, done = load_task("dressing"), []

    def told(progress):
        if progress.status == "success":
            done.append(progress.name)

    world, senses = task.scripted(1)
    run = Run(task, world, seed=1, senses=senses, params=task.parameters("dress"), on_progress=told)
    lying_sleeves(run.context).update(lying)
    assert run.run().outcome == "success"
    lifts = [name for name in done if name.endswith("/lift")]
    assert lifts == [*["right arm/lift"] * tries, "left 2nd/lift", "right 2nd/lift"]
    assert ("anew/lay it on the person" in done) == ("right" not in lying), "a sleeve that stood is laid anew"
    assert done.index("its front/draw flat") > done.index("right 2nd/pull up")
    assert "front/draw flat" not in done, "from the side of the arm that came last"


def test_where_the_right_arm_comes_into_a_gown_that_was_laid_anew_the_left_one_is_next(monkeypatch):
    present = PresentSleeve.steps

    def caught(self):
        if not taken:
            raise SkillFailure(Reason.SLEEVE_CAUGHT, "")
        yield from present(self)

    monkeypatch.setattr(PresentSleeve, "steps", caught)
    task, done, taken = load_task("dressing"), [], []

    def told(progress):
        if progress.status == "success":
            done.append(progress.name)
            taken.extend([progress.name] * progress.name.endswith("take it up"))

    world, senses = task.scripted(1)
    run = Run(task, world, seed=1, senses=senses, params=task.parameters("dress"), on_progress=told)
    assert run.run().outcome == "success"
    assert taken == ["taken up/take it up"]
    assert [name for name in done if name.endswith("/lift")] == [*["right arm/lift"] * 4, "left arm/lift"]
    freed = [done.index(f"taken up/{name}") for name in ("held/lower", "lay it back", "go to the strap", "take it up")]
    assert freed == sorted(freed)


def test_after_the_person_has_moved_every_arm_is_begun_again(nodes):
    raising = [node for node in nodes if Reason.PERSON_MOVED in getattr(node, "reasons", ())]
    assert {node.name.split("/")[-1] for node in raising} >= {
        "lift",
        "grasp the sleeve",
        "present the sleeve",
        "pull up",
    }
    for side in ("left", "right"):
        again = next(node for node in nodes if isinstance(node, RecoverBy) and node.name == f"dress the {side} arm")
        first = again.recoveries[Reason.PERSON_MOVED].children[0]
        assert first.name == f"{side} arm/held/let down"
        assert first.children[0].body.lower


def test_a_sleeve_that_is_still_held_is_laid_back_unless_the_person_has_moved(nodes):
    for side in ("left", "right"):
        again = next(node for node in nodes if isinstance(node, RecoverBy) and node.name == f"dress the {side} arm")
        for reason, branch in again.recoveries.items():
            laid = [node.name for node in branch.iterate() if node.name.endswith("/lay it back")]
            assert laid == ([] if reason is Reason.PERSON_MOVED else [f"{side} arm/again/lay it back"])


@pytest.mark.parametrize(("worn", "laid"), [("left", False), ("right", False), ("right", True)])
def test_an_arm_that_is_in_its_sleeve_when_the_run_begins_is_not_lifted(monkeypatch, worn, laid):
    task, lifts = load_task("dressing"), []

    def told(progress):
        if progress.name.endswith("arm/lift") and progress.status == "success":
            lifts.append(progress.name)

    world, senses = task.scripted(1)
    see = senses.worn_sleeve

    def worn_sleeve(frame, *, side, arm_in_map):
        if side != worn:
            return see(frame, side=side, arm_in_map=arm_in_map)
        return ScriptedSenses.worn_sleeve(senses, frame, side=side, arm_in_map=arm_in_map)

    monkeypatch.setattr(senses, "worn_sleeve", worn_sleeve)
    run = Run(task, world, seed=1, senses=senses, params=task.parameters("dress"), on_progress=told)
    if laid:
        remember_laid(run.context)
    assert run.run().outcome == "success"
    other = "left" if worn == "right" else "right"
    assert lifts == (["right arm/lift", "left arm/lift"] if laid else [f"{other} arm/lift"])


@pytest.mark.parametrize("leaf", ["right arm/lift", "right arm/pull over the hand"])
def test_a_person_who_moves_is_noticed_at_once_and_looked_at_anew(leaf):
    task = load_task("dressing")
    inner, senses = task.scripted(1)
    world = FaultyWorld(inner, [parse_fault(f"person_moves@{leaf}:step")])
    failed, after = [], []

    def told(progress):
        if failed:
            after.append(progress.name)
        elif (progress.name, progress.status) == (leaf, "failure"):
            failed.append(progress)
        if failed and (progress.name, progress.status) == ("right arm/lift", "running"):
            run.request_stop()

    run = Run(task, world, seed=1, senses=senses, params=task.parameters("dress"), on_progress=told)
    run.run()
    (_, moved), *_ = world.begun
    assert Reason.PERSON_MOVED.value in failed[0].message
    assert failed[0].time - moved < 0.3
    told_first = list(dict.fromkeys(after))
    assert told_first[:2] == ["right arm/held/lower", "right arm/free hands"]
    assert "right arm/look" in told_first[: told_first.index("right arm/lift")]


class ShortNeckline:
    """A neckline that is taut at a width [m], until the right hand lets go of it."""

    def __init__(self, world, taut_at):
        self.taut_at, self.taut, self.let_go = taut_at, False, False
        self.observed, world.observe = world.observe, self.observe

    def observe(self):
        seen = self.observed()
        across = seen.pose_hand_in_map[0, :3, 3] - seen.pose_hand_in_map[1, :3, 3]
        width = np.linalg.norm(across)
        held = bool(seen.gripper_opening.max() < 0.02)
        self.let_go |= self.taut and not held
        self.taut |= held and width > self.taut_at
        if self.let_go or not held or width < self.taut_at:
            return seen
        wrench = seen.wrench_hand_in_map + 0.0
        pull = 50.0 * (width - self.taut_at) * across / width
        wrench[:, :3] += (-pull, pull)
        return dataclasses.replace(seen, wrench_hand_in_map=wrench)


def taken_down_and_laid(change=lambda world: None):
    """How each leaf ended, by name, as a gown is taken down and laid in a rehearsal whose world was changed."""
    task, ended = load_task("dressing"), {}
    world, senses = task.scripted(1)
    change(world)
    stages = {"stages": ("take_down", "lay")}
    told = {"on_progress": lambda progress: ended.update({progress.name: progress.status})}
    assert Run(task, world, seed=1, senses=senses, params=stages, **told).run().outcome == "success"
    return ended


@pytest.mark.parametrize(("taut_at", "anew"), [(0.86, False), (0.60, True)])
def test_a_neckline_that_is_too_short_is_taken_anew_by_the_right_hand(taut_at, anew):
    ended = taken_down_and_laid(lambda world: ShortNeckline(world, taut_at))
    assert ended["gown/stretch the neckline"] == ("failure" if anew else "success")
    assert ("right end/let go" in ended) == anew
    assert ended["gown/lay it on the person"] == "success"


def test_where_what_the_left_hand_holds_is_no_end_both_are_taken_anew_from_the_right_one(monkeypatch):
    stretch, stretched = StretchNeckline.steps, []

    def short_until_the_left_hand_has_let_go(self):
        stretched.append(self.name)
        if self.name != "gown/stretch from the right hand":
            raise SkillFailure(Reason.GRASP_MISSED, "")
        yield from stretch(self)

    monkeypatch.setattr(StretchNeckline, "steps", short_until_the_left_hand_has_let_go)
    ended = taken_down_and_laid()
    assert [name.removeprefix("gown/stretch ") for name in stretched] == [
        "the neckline",
        "by the new right end",
        "from the left hand",
        "from the right hand",
    ]
    assert ended["gown/from the right hand/let go"] == "success"
    assert ended["gown/lay it on the person"] == "success"


def test_a_strap_that_is_out_of_reach_is_carried_out_before_its_gown_is_taken_up(monkeypatch):
    present, grasp, done = PresentSleeve.steps, GraspSleeve.steps, []

    def caught(self):
        if "taken up/take it up" not in done:
            raise SkillFailure(Reason.SLEEVE_CAUGHT, "")
        yield from present(self)

    def out_of_reach(self):
        if self.name == "taken up/take it by its strap":
            raise SkillFailure(Reason.UNREACHABLE, "")
        yield from grasp(self)

    monkeypatch.setattr(PresentSleeve, "steps", caught)
    monkeypatch.setattr(GraspSleeve, "steps", out_of_reach)
    task = load_task("dressing")
    world, senses = task.scripted(1)
    told = {"on_progress": lambda progress: done.append(progress.name) if progress.status == "success" else None}
    assert Run(task, world, seed=1, senses=senses, params=task.parameters("dress"), **told).run().outcome == "success"
    steps = ["carry it out", "nearer/go to the strap", "nearer/take it by its strap", "take it up"]
    assert [done.index(f"taken up/{step}") for step in steps] == sorted(
        done.index(f"taken up/{step}") for step in steps
    )
