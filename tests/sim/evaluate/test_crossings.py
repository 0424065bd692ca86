"""An arm through a sleeve's openings, and in which sense."""

import numpy as np
import pytest
from caretree.sim.evaluate.crossings import arm_line, crossing, sleeve

ARM = np.array(((0.0, 0, 0), (0.3, 0, 0), (0.55, 0, 0), (0.75, 0, 0)))[None]  # shoulder to fingertip along x [m]
ANGLES = np.linspace(0.0, 2 * np.pi, 12, endpoint=False)


def ring(x, *, aside=0.0, turned=False):
    """A round opening (1, 12, 3) about the arm's line, its normal from body to hand [m]."""
    points = np.stack((np.full(12, x), 0.1 * np.cos(ANGLES) + aside, 0.1 * np.sin(ANGLES)), axis=1)
    return (points[::-1] if turned else points)[None]


def test_through_from_body_to_hand():
    found = crossing(ring(0.15), arm_line(ARM))
    assert found.net.tolist() == [1]
    assert found.at == pytest.approx([1.5])  # half way from the shoulder to the elbow
    assert found.upper_arm == pytest.approx([0.5])


def test_through_the_wrong_way_counts_against_it():
    assert crossing(ring(0.15, turned=True), arm_line(ARM)).net.tolist() == [-1]


@pytest.mark.parametrize(
    "opening", [ring(0.15, aside=0.3), ring(1.5), ring(0.15)[:, :2]], ids=["beside", "far", "none"]
)
def test_not_through(opening):
    found = crossing(opening, arm_line(ARM))
    assert found.net.tolist() == [0]
    assert np.isnan(found.at).all()
    assert found.upper_arm.tolist() == [0.0]


def test_the_line_reaches_into_the_shoulder_and_past_the_fingertip():
    line = arm_line(ARM)[0]
    assert line[[0, -1], 0] == pytest.approx((-0.10, 0.80))  # [m]
    assert crossing(ring(-0.05), arm_line(ARM)).net.tolist() == [1]


@pytest.mark.parametrize(
    ("armhole", "cuff", "on"),
    [
        (ring(0.05), ring(0.6), True),
        (ring(0.6), ring(0.05), False),
        (ring(0.05), ring(0.6, aside=0.3), False),
        (ring(0.05, turned=True), ring(0.6, turned=True), False),
    ],
    ids=["on", "cuff first", "through the armhole only", "from hand to body"],
)
def test_a_sleeve_is_on_when_the_arm_goes_through_armhole_then_cuff(armhole, cuff, on):
    assert sleeve(armhole, cuff, ARM).on.tolist() == [on]
