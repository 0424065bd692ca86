"""A sleeve that has to wait is laid beyond the hand it belongs to, its back panel outwards, and let go of."""

import numpy as np
import pytest
from caretree.perception.estimates import Cover
from caretree.sim.world import SIDES
from caretree.skills.core.reasons import Reason
from caretree.skills.geometry.hold import Hold
from caretree.skills.lay_sleeve import LaySleeve

from .bench import ARM, CLOTH, PATH, LeafBench, above_arm, beside_bed, on_arm, pulls

MATTRESS = 0.60  # [m] above the floor, its middle at x = y = 0, its head towards -y, the right arm towards +x
FINGERTIP = PATH.points[3]


def bench(*, hold=None, each_tick=lambda bench: None, stand=None, beyond=0.2):
    """The right hand has the sleeve above the wrist of the person, whose right arm lies; far off, it is ready."""
    hands, held = {"right": above_arm(2.0, 0.15)} if stand is None else {}, {"right": CLOTH}
    if hold is not None:
        hands[hold.hand], held[hold.hand] = on_arm(hold.coordinate), ARM
    return LeafBench(
        lambda context: LaySleeve("lay", context, side="right", hand="right", hold=hold),
        beside_bed(
            stand=stand,
            hands=hands,
            held=held,
            load={"right": (0.0, 0.0, -1.4)},
            overhang=Cover(stamp=0.0, confidence=0.9, share=beyond),
        ),
        each_tick=each_tick,
    )


def let_go(run):
    """Position (3,) of the hand as its fingers begin to part [m]."""
    opens = int(np.argmax(run.openings("right") > 0.01))
    assert opens > 0, "the hand does not open"
    return run.way("right")[opens]


def test_it_is_laid_beyond_the_hand_and_outwards_of_it_on_the_bed():
    run = bench()
    assert run.ended() is None
    strap = let_go(run)
    assert strap == pytest.approx((0.26, 0.20, MATTRESS + 0.06), abs=0.02)
    assert strap[1] > FINGERTIP[1] + 0.10, "beyond the fingertips"
    assert run.openings("right")[-1] > 0.08
    assert run.seen[-1].pose_base_in_map == pytest.approx(run.start.pose_base_in_map, abs=0.01)


def test_it_comes_down_from_outwards_and_from_the_feet():
    run = bench()
    assert run.ended() is None
    strap, way = let_go(run), run.way("right")
    lowered = way[way[:, 2].argmax() : int(np.argmax(run.openings("right") > 0.01))]
    assert lowered[0] - strap == pytest.approx((0.16, 0.12, 0.30), abs=0.04)
    drop = (lowered - strap) / (0.16, 0.12, 0.30)
    assert np.abs(drop - drop[:, 2:]).max() < 0.25, "down, in and headward at the same time"


def test_a_sleeve_that_pulls_is_let_go_of_where_it_is():
    def taut(bench):
        far = bench.world.observe().pose_hand_in_map[1, 2, 3] < 0.85
        pulls(bench.world, "right", (-5.0 if far else 0.0, 0.0, -1.4))

    run = bench(each_tick=taut)
    assert run.ended() is None
    assert let_go(run)[2] == pytest.approx(0.83, abs=0.03)  # [m], 17 cm above where it would lie


def test_one_that_pulls_hard_before_it_is_moved_is_not_let_go_of_in_the_air():
    def slackens(bench):
        pulls(
            bench.world, "right", (0.0, -5.0 if bench.world.observe().pose_hand_in_map[1, 1, 3] < 0.10 else 0.0, -1.4)
        )

    run = bench(each_tick=slackens)
    assert run.ended() is None
    assert let_go(run) == pytest.approx((0.26, 0.20, MATTRESS + 0.06), abs=0.02)


def test_it_keeps_hold_of_the_arm_and_ends_when_that_slips():
    run = bench(hold=Hold("left", 1.0))
    assert run.ended() is None
    assert run.way("left")[-1] == pytest.approx(run.start.pose_hand_in_map[SIDES.index("left"), :3, 3], abs=0.02)

    def slips(bench):
        if len(bench.seen) == 15:
            bench.world.between_fingers["left"] = 0.0

    lost = bench(hold=Hold("left", 1.0), each_tick=slips)
    assert lost.ended() == Reason.ARM_SLIPPED
    assert lost.openings("right").max() < 0.01, "it still holds the sleeve"


def test_a_place_out_of_reach_is_told():
    run = bench(stand=(1.05, -1.30, np.pi))
    assert run.ended() == Reason.UNREACHABLE
    assert run.openings("right").max() < 0.01


@pytest.mark.parametrize(("beyond", "x"), [(0.4, 0.26), (0.7, 0.10)])
def test_a_gown_that_lies_beyond_the_edge_of_the_bed_is_drawn_back_over_the_person(beyond, x):
    run = bench(beyond=beyond)
    assert run.ended() is None
    strap = let_go(run)
    assert strap[0] == pytest.approx(x, abs=0.02)
    assert strap[2] > MATTRESS + (0.2 if x < 0.2 else 0.0), "clear of the thighs"
