"""Which eyes a run has."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.perception.classical import ClassicalSenses
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.image.surfaces import GOWN_SURFACES, Surface, surfaces
from caretree.perception.learned.learned_sight import LearnedSight
from caretree.perception.learned.sight import KeyPoint, Sight
from caretree.sim.errors import CaretreeError
from caretree.sim.world import Frame, RoomMap
from caretree.trees.cli import main
from caretree.trees.run import perceptions
from caretree.trees.run.perceptions import PERCEPTIONS, chosen_by_policy, grasp_with, see_with, seen_by_network
from caretree.trees.run.runner import Run
from caretree.trees.run.task import load_task


@pytest.fixture
def context():
    task = load_task("dressing")
    world, senses = task.scripted(0)
    return Run(task, world, seed=0, senses=senses).context


def test_the_rules_look_at_the_picture_itself(context):
    senses = context.senses
    see_with(context, "classical")
    assert context.senses is senses


def test_the_network_is_put_before_the_rules(context, monkeypatch):
    wrapped = []
    monkeypatch.setattr(perceptions, "seen_by_network", lambda senses, sight: wrapped.append(senses) or senses)
    see_with(context, "learned")
    assert wrapped == [context.senses]


def test_what_there_is_not_is_said(context):
    with pytest.raises(CaretreeError, match=r"no perception 'keen'.*classical, learned"):
        see_with(context, "keen")


def test_scripted_senses_have_no_pictures_for_a_network(capsys, tmp_path):
    assert "learned" in PERCEPTIONS
    command = ["run", "dressing", "--world", "scripted", "--perception", "learned", "--out", str(tmp_path / "run")]
    assert main(command) == 2
    assert "scripted senses see none" in capsys.readouterr().err


def frame():
    """A black picture, 1 m away."""
    return Frame(
        camera="head",
        stamp=0.0,
        rgb=np.zeros((16, 16, 3), np.uint8),
        depth=np.ones((16, 16), np.float32),
        intrinsics=(100.0, 100.0, 8.0, 8.0),
        pose_camera_in_map=np.eye(4),
    )


def test_senses_are_asked_of_the_repainted_picture_which_is_seen_once():
    bed = np.array(((-0.5, -1.0, 0.0), (0.5, 1.0, 0.6)))
    room = RoomMap(free=np.ones((2, 2), bool), origin=np.zeros(2), resolution=1.0, bed=bed)
    black, senses = frame(), ClassicalSenses(room, 0)
    hand = np.array([(0.0, y, 1.0) for y in (0.0, 0.01, 0.02, 0.03)])
    network = Network(np.full((16, 16), Surface.SKIN, np.uint8))
    through = seen_by_network(senses, LearnedSight(network, bed_in_map=bed))
    assert senses.skin_cover(black, points_in_map=hand).share == 1.0
    assert through.skin_cover(black, points_in_map=hand).share == 0.0
    assert through.skin_cover(black, points_in_map=hand).share == 0.0
    assert [(seen is black, told is bed) for seen, told in network.asked] == [(True, True)]


def test_a_gown_s_hook_is_found_whatever_its_colour_and_its_side_by_its_area():
    bed = np.array(((-0.5, -1.0, 0.0), (0.5, 1.0, 0.6)))
    room = RoomMap(free=np.ones((2, 2), bool), origin=np.zeros(2), resolution=1.0, bed=bed)
    black, senses = frame(), ClassicalSenses(room, 0)
    seen = np.full((16, 16), Surface.INSIDE, np.uint8)
    seen[:, :6] = Surface.COLLAR
    through = seen_by_network(senses, LearnedSight(Network(seen)))
    with pytest.raises(PerceptionFailure):
        senses.hook(black)
    assert through.hook(black).target == "near_hang"
    assert not through.hung_side(black).outside
    assert not through.gown_side(black).outside
    hook = np.zeros(3)
    with pytest.raises(PerceptionFailure, match="corner"):
        through.shown_corner(black, hook_in_map=hook)
    with pytest.raises(PerceptionFailure, match="left corner"):
        through.hung_corner(black, side="left", hook_in_map=hook)


def test_of_a_gown_with_tapes_the_rules_tell_sides_and_corners(monkeypatch):
    class Rules(ClassicalSenses):
        def hung_side(self, frame):
            return "by its colours"

    monkeypatch.setattr(perceptions, "tapes_show", lambda frame: True)
    bed = np.array(((-0.5, -1.0, 0.0), (0.5, 1.0, 0.6)))
    room = RoomMap(free=np.ones((2, 2), bool), origin=np.zeros(2), resolution=1.0, bed=bed)
    through = seen_by_network(Rules(room, 0), LearnedSight(Network(np.full((16, 16), Surface.INSIDE, np.uint8))))
    assert through.hung_side(frame()) == "by its colours"
    with pytest.raises(PerceptionFailure, match="gown"):
        through.hook(frame())


def test_the_strap_of_a_gown_without_tapes_is_told_by_the_network(monkeypatch):
    class Rules(ClassicalSenses):
        def sleeve_strap(self, frame, *, side, near_in_map):
            return "by its borders"

    bed = np.array(((-0.5, -1.0, 0.0), (0.5, 1.0, 0.6)))
    room = RoomMap(free=np.ones((2, 2), bool), origin=np.zeros(2), resolution=1.0, bed=bed)
    through = seen_by_network(Rules(room, 0), LearnedSight(Network(np.full((16, 16), Surface.OUTSIDE, np.uint8))))
    near = np.array((0.0, 0.0, 1.0))
    assert through.sleeve_strap(frame(), side="left", near_in_map=near).target == "sleeve_left"
    assert through.sleeve_opening(frame(), side="left", near_in_map=near).target == "sleeve_left"
    monkeypatch.setattr(perceptions, "tapes_show", lambda frame: True)
    assert through.sleeve_strap(frame(), side="left", near_in_map=near) == "by its borders"


def test_of_a_gown_without_tapes_all_but_the_person_is_asked_of_it_in_their_colours():
    """A person is asked for with no gown about, too: what the network takes for one is left as it is."""

    class Painted(ClassicalSenses):
        def held_armhole(self, frame, *, side, near_in_map):
            return surfaces(frame.rgb)

        def head(self, frame):
            return surfaces(frame.rgb)

    bed = np.array(((-0.5, -1.0, 0.0), (0.5, 1.0, 0.6)))
    room = RoomMap(free=np.ones((2, 2), bool), origin=np.zeros(2), resolution=1.0, bed=bed)
    seen = np.full((16, 16), Surface.ARMHOLE, np.uint8)
    seen[:, :6] = Surface.SKIN
    through = seen_by_network(Painted(room, 0), LearnedSight(Network(seen)))
    assert (through.held_armhole(frame(), side="left", near_in_map=np.zeros(3)) == seen).all()
    head = through.head(frame())
    assert (head[:, :6] == Surface.SKIN).all()
    assert not np.isin(head, GOWN_SURFACES).any()


def test_pictures_before_and_beside_are_repainted_too_and_only_what_is_surely_skin_tells_of_a_move():
    class Rules(ClassicalSenses):
        def arm_shift(self, frame, *, before, arm_in_map, grips_in_map=None):
            return [surfaces(each.rgb) for each in (frame, before)]

        def collar_middle(self, frame, *, near_in_map, beside=()):
            return [surfaces(each.rgb) for each in (frame, *beside)]

    bed = np.array(((-0.5, -1.0, 0.0), (0.5, 1.0, 0.6)))
    room = RoomMap(free=np.ones((2, 2), bool), origin=np.zeros(2), resolution=1.0, bed=bed)
    network = Network(np.full((16, 16), Surface.SKIN, np.uint8))
    network.confidence[:8] = 0.8
    through = seen_by_network(Rules(room, 0), LearnedSight(network))
    for seen in through.arm_shift(frame(), before=frame(), arm_in_map=np.zeros((4, 3))):
        assert (seen[8:] == Surface.SKIN).all()
        assert not (seen[:8] == Surface.SKIN).any()
    for seen in through.collar_middle(frame(), near_in_map=np.zeros(3), beside=[frame(), frame()]):
        assert (seen == Surface.SKIN).all()


def test_a_place_near_the_hook_is_told_by_colours_and_where_there_are_none_by_the_network():
    class Towel(ClassicalSenses):
        def hang_point(self, frame):
            if not frame.rgb.any():
                raise PerceptionFailure(Problem.NOTHING_SEEN, "gown")
            return surfaces(frame.rgb)[0, 0]

    bed = np.array(((-0.5, -1.0, 0.0), (0.5, 1.0, 0.6)))
    room = RoomMap(free=np.ones((2, 2), bool), origin=np.zeros(2), resolution=1.0, bed=bed)
    through = seen_by_network(Towel(room, 0), LearnedSight(Network(np.full((16, 16), Surface.INSIDE, np.uint8))))
    assert through.hang_point(frame()) == Surface.INSIDE
    assert through.hang_point(replace(frame(), rgb=np.full((16, 16, 3), 255, np.uint8))) != Surface.INSIDE


class Network:
    """Sees the same surfaces everywhere, and no key point."""

    def __init__(self, surfaces):
        self.surfaces = surfaces
        self.confidence = np.ones((16, 16), np.float32)
        self.asked = []

    def see(self, frame, bed_in_map):
        self.asked.append((frame, bed_in_map))
        nothing = KeyPoint(confidence=0.0, position_in_map=None, pixel=np.zeros(2))
        points = dict.fromkeys(("corner_left", "corner_right"), nothing)
        return Sight(
            surfaces=self.surfaces,
            confidence=self.confidence,
            sheet=np.ones((16, 16, 3), np.float32),
            key_points=points,
            heat={"strap_left": np.zeros((8, 8))},  # as likely in each of 64 cells as nowhere
        )


def test_the_policy_chooses_the_pre_grasp_and_nothing_else():
    bed = np.array(((-0.5, -1.0, 0.0), (0.5, 1.0, 0.6)))
    room = RoomMap(free=np.ones((2, 2), bool), origin=np.zeros(2), resolution=1.0, bed=bed)
    black, senses = frame(), ClassicalSenses(room, 0)
    hand = np.eye(4)
    hand[:3, 3] = (0.0, 0.0, 1.0)  # the picture shows a wall 1 m away, which the network takes for the gown
    policy = FirstPixel()
    through = chosen_by_policy(senses, policy, lambda seen: np.full((16, 16), Surface.OUTSIDE, np.uint8))
    assert through.skin_cover(black, points_in_map=np.zeros((4, 3)) + (0.0, 0.0, 1.0)).share == 1.0
    assert policy.asked == 0
    chosen = through.pre_grasp((black,), poses_hand_in_map=(hand,), distance=(0.0, 2.0))
    assert (policy.asked, chosen.primitive, chosen.confidence) == (1, "direct", 0.25)


class FirstPixel:
    """A policy that likes all direct grasps alike."""

    def __init__(self):
        self.asked = 0

    def values(self, views):
        self.asked += 1
        values = np.full((len(views.depth), 3, *views.depth.shape[1:]), -np.inf)
        values[:, 1][views.depth > 0] = 0.0
        return values

    def confidence(self, value):
        return 0.25


def test_the_policy_is_put_before_the_senses_when_it_is_asked_for(context, monkeypatch):
    wrapped = []
    monkeypatch.setattr(perceptions, "packaged_policy", lambda: "the policy")
    monkeypatch.setattr(perceptions, "chosen_by_policy", lambda *given: wrapped.append(given) or given[0])
    senses = context.senses
    grasp_with(context, "classical")
    assert wrapped == []
    grasp_with(context, "learned")
    assert wrapped == [(senses, "the policy")]
    with pytest.raises(CaretreeError, match=r"no pregrasp 'keen'.*classical, learned"):
        grasp_with(context, "keen")


def test_scripted_senses_have_no_pictures_for_a_policy(capsys, tmp_path):
    command = ["run", "dressing", "--world", "scripted", "--pregrasp", "learned", "--out", str(tmp_path / "run")]
    assert main(command) == 2
    assert "--pregrasp learned looks at pictures" in capsys.readouterr().err
