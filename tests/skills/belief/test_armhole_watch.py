import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.estimates import Cover, SleeveOpening
from caretree.sim.scripted.world import ScriptedWorld
from caretree.skills.belief.armhole_watch import EDGE, RingWatch
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


class Watcher(Skill):
    commands = False


def make(points=None, share=1.0):
    """A watch that sees an armhole at `points` (n, 3), or none, a hand covered by `share`, a cuff as far round it."""

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
            ring_points_in_map=points,
            centre_in_map=points.mean(axis=0),
        )
    if share is None:
        cover = PerceptionFailure(Problem.NOTHING_SEEN, "hand")
    else:
        cover = Cover(stamp=0.0, confidence=0.9, share=share)
    world = ScriptedWorld()
    guard = GuardedWorld(world)
    senses = fake_senses(held_armhole=ring, hand_cover=cover, cuff_round=cover)
    skill = Watcher("watch", Context(world=guard, guard=guard, senses=senses))
    return RingWatch(skill, GRIP.arm, GRIP.hand), world


def hoop(place, outer):
    """Half a hoop about the arm that is seen, its outer edge `outer` [m] outwards."""
    across, _, off = PATH.frame(place).T
    side = np.sign(across[0])
    return PATH.point(place) + np.linspace(outer - 0.05, outer, 30)[:, None] * side * across - 0.05 * off


@pytest.mark.parametrize(("outer", "wanted"), [(EDGE - 0.05, 1.0), (EDGE + 0.05, -1.0)])
def test_the_grip_shifts_until_the_outer_edge_is_in_its_place(outer, wanted):
    ring, world = make(hoop(3.4, outer))
    ring.look(PATH, 3.4, PATH.point(3.4))
    side = np.sign(PATH.frame(3.4)[0, 0])
    assert ring.off == pytest.approx(EDGE - outer, abs=0.005)
    assert np.sign(side * ring.aside) == wanted
    first = ring.aside
    ring.look(PATH, 3.4, PATH.point(3.4))
    assert ring.aside == first, "one look serves several ticks"
    for _ in range(30):
        world.clock.wait_until(world.clock.now() + 0.25)
        ring.look(PATH, 3.4, PATH.point(3.4))
    assert abs(ring.aside) <= 0.14 + 1e-9


@pytest.mark.parametrize(("share", "said"), [(0.1, True), (0.9, False), (None, False)])
def test_a_bare_hand_and_a_cuff_on_one_side_are_misses(share, said):
    ring, _ = make(share=share)
    assert ring.missed(PATH) is ring.beside(PATH) is said


def test_the_armhole_is_followed_and_forgotten_when_hidden():
    ring, world = make(hoop(0.4, 0.05))
    ring.follow(PATH, PATH.point(0.2))
    assert ring.place == pytest.approx(0.4, abs=0.15)
    hidden, world = make()
    hidden.place, hidden._placed = 0.4, world.clock.now()
    hidden.follow(PATH, PATH.point(0.2))
    assert hidden.place == 0.4, "a moment out of sight changes nothing"
    world.clock.wait_until(world.clock.now() + 2.0)
    hidden.follow(PATH, PATH.point(0.2))
    assert hidden.place is None


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
    pull = PullAlongArm("pull", Context(world=guard, guard=guard), grip=GRIP, upto=-0.22, seat=0.05)
    assert pull._there(ring, grip) is there
