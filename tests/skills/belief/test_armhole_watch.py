import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.estimates import Cover, SleeveOpening, WornSleeve
from caretree.sim.scripted.world import ScriptedWorld
from caretree.skills.belief.armhole_watch import ArmholeWatch
from caretree.skills.core.context import Context
from caretree.skills.core.skill import Skill
from caretree.skills.geometry.arm_path import ArmPath
from caretree.skills.geometry.strap_grip import StrapGrip
from caretree.skills.pull_along_arm import PullAlongArm
from caretree.skills.scripted.scripted_person import lying_posture
from caretree.trees.guard.guard import GuardedWorld

from ..fake_senses import fake_senses

PATH = ArmPath.of(lying_posture("right"))
GRIP = StrapGrip(arm="right", hand="right", across_in_hand=np.array((0.0, 1.0, 0.0)))


HIDDEN = PerceptionFailure(Problem.NOTHING_SEEN, "bindings")


class Watcher(Skill):
    commands = False


def make(points=None, share=1.0, cuff=None, sleeve=HIDDEN):
    """A watch that sees an armhole at `points` (n, 3), or none, an arm covered by `share`, a cuff by that or `cuff`."""

    if points is None:
        ring = PerceptionFailure(Problem.NOTHING_SEEN, "armhole")
    else:
        ring = SleeveOpening(
            stamp=0.0,
            confidence=0.9,
            target="sleeve_right",
            position_in_map=points[0],
            approach_in_map=np.array((0.0, 0.0, -1.0)),
            closing_in_map=np.array((0.0, 1.0, 0.0)),
            armhole_points_in_map=points,
            centre_in_map=points.mean(axis=0),
        )
    if share is None:
        cover = PerceptionFailure(Problem.NOTHING_SEEN, "hand")
    else:
        cover = Cover(stamp=0.0, confidence=0.9, share=share)
    world = ScriptedWorld()
    guard = GuardedWorld(world)
    cuff = cover if cuff is None else Cover(stamp=0.0, confidence=0.9, share=cuff)
    senses = fake_senses(held_armhole=ring, skin_cover=cover, cuff_round=cuff, sleeve_on_forearm=sleeve)
    skill = Watcher("watch", Context(world=guard, guard=guard, senses=senses))
    return ArmholeWatch(skill, GRIP.arm, GRIP.hand), world


def hoop(place, outer):
    """Half a hoop about the arm that is seen, its outer edge `outer` [m] outwards."""
    across, _, off = PATH.frame(place).T
    side = np.sign(across[0])
    return PATH.point(place) + np.linspace(outer - 0.05, outer, 30)[:, None] * side * across - 0.05 * off


@pytest.mark.parametrize(("outer", "wanted"), [(0.02, 1.0), (0.12, -1.0)])
def test_the_grip_shifts_until_the_outer_edge_is_in_its_place(outer, wanted):
    ring, world = make(hoop(3.4, outer))
    ring.centre(PATH, 3.4, PATH.point(3.4))
    side = np.sign(PATH.frame(3.4)[0, 0])
    assert ring.error == pytest.approx(0.07 - outer, abs=0.005)
    assert np.sign(side * ring.offset) == wanted
    first = ring.offset
    ring.centre(PATH, 3.4, PATH.point(3.4))
    assert ring.offset == first, "one look serves several ticks"
    for _ in range(30):
        world.clock.wait_until(world.clock.now() + 0.25)
        ring.centre(PATH, 3.4, PATH.point(3.4))
    assert abs(ring.offset) <= 0.14 + 1e-9


@pytest.mark.parametrize(("share", "said"), [(0.1, True), (0.9, False), (None, False)])
def test_a_bare_hand_and_a_cuff_on_one_side_are_misses(share, said):
    ring, _ = make(share=share)
    assert ring.hand_is_bare(PATH) is ring.arm_is_beside(PATH) is said


@pytest.mark.parametrize(
    ("cuff", "covered", "beside"), [(0.92, 0.62, False), (0.67, 0.0, True), (1.0, 0.0, False), (0.3, 1.0, True)]
)
def test_an_arm_that_is_bare_where_its_sleeve_would_be_is_beside_it_unless_the_cuff_is_all_round(cuff, covered, beside):
    ring, _ = make(share=covered, cuff=cuff)
    assert ring.arm_is_beside(PATH) is beside


def test_an_arm_is_inside_a_sleeve_that_has_come_past_the_wrist_and_covers_it():
    def beside(armhole_at, cuff_at, round_arm, covered=1.0):
        sleeve = WornSleeve(
            stamp=0.0,
            confidence=0.9,
            side="right",
            armhole_at=armhole_at,
            cuff_at=cuff_at,
            reach=0.0,
            round_arm=round_arm,
        )
        ring, _ = make(share=covered, cuff=0.35, sleeve=sleeve)
        return ring.arm_is_beside(PATH)

    assert not beside(0.69, 1.35, 0.49), "told to be beside it at 0.35 of the way round, with the hand inside (103)"
    assert beside(1.29, 1.51, 0.43), "the armhole before the hand (103)"
    assert beside(0.69, 0.75, 0.49), "in a heap"
    assert beside(0.69, 1.35, 0.2), "on one side of the arm"
    assert beside(0.69, 1.35, 0.49, covered=0.3), "the arm lies on it"


def test_the_armhole_is_followed_and_forgotten_when_hidden():
    ring, world = make(hoop(0.4, 0.05))
    ring.locate(PATH, PATH.point(0.2))
    assert ring.coordinate == pytest.approx(0.4, abs=0.15)
    hidden, world = make()
    hidden.coordinate, hidden._located = 0.4, world.clock.now()
    hidden.locate(PATH, PATH.point(0.2))
    assert hidden.coordinate == 0.4, "a moment out of sight changes nothing"
    world.clock.wait_until(world.clock.now() + 2.0)
    hidden.locate(PATH, PATH.point(0.2))
    assert hidden.coordinate is None


@pytest.mark.parametrize(
    ("ring", "grip", "there"),
    [
        (None, -0.21, False),
        (None, -0.23, True),  # the grip alone decides where nothing is seen
        (0.0, 0.3, True),
        (0.1, -0.23, True),
        (0.4, -0.23, False),
        (0.4, -0.43, True),
    ],
)
def test_the_armhole_decides_where_the_pull_ends(ring, grip, there):
    world = ScriptedWorld()
    guard = GuardedWorld(world)
    pull = PullAlongArm("pull", Context(world=guard, guard=guard), grip=GRIP, grip_goal=-0.22, armhole_goal=0.05)
    assert pull.arrived(ring, grip) is there
