from types import SimpleNamespace

import numpy as np
import pytest
from caretree.learning.gap.joints.doubts import doubts

T = np.arange(0.0, 20.0, 0.02)
Q = 0.8 * np.sin(0.7 * T) + 0.3 * np.sin(1.9 * T)
WEIGHT = 8.0 * np.sin(Q) + 0.5  # [N m] of a link that turns in a slanted plane
INERTIA = -2.0 * (0.8 * 0.49 * np.sin(0.7 * T) + 0.3 * 3.61 * np.sin(1.9 * T))
MODEL = SimpleNamespace(load=lambda q, dq, ddq: 8.0 * np.sin(q) + 0.5 + ddq, joints=("swing",), prismatic=(False,))


def said(measured):
    measured = measured[:, None]
    log = SimpleNamespace(
        inner=slice(None),
        q=Q[:, None],
        dq=np.gradient(Q, T)[:, None],
        ddq=INERTIA[:, None],
        measured=measured,
        raw=measured,
        rigid=(WEIGHT + INERTIA)[:, None],
    )
    return doubts(MODEL, [log], ("tau1",))


@pytest.mark.parametrize(
    "measured",
    [
        WEIGHT + INERTIA,
        0.09 * (WEIGHT + INERTIA),  # a current, whose constant is not known
        0.5 * WEIGHT + INERTIA,  # the link is lighter than it is believed to be
        WEIGHT + INERTIA + 30.0,  # never below 0, by an offset
    ],
)
def test_loads_that_go_with_the_model_are_not_doubted(measured):
    assert said(measured) == ""


@pytest.mark.parametrize(
    ("measured", "what"),
    [
        (np.abs(WEIGHT + INERTIA), "its sign is lost"),
        (-(WEIGHT + INERTIA) + 0.5 * np.sign(np.gradient(Q)), "nearly minus"),
        (INERTIA + 0.5 * np.sign(np.gradient(Q)), "hardly have gravity"),
    ],
)
def test_loads_that_cannot_be_the_models_are_doubted_by_name(measured, what):
    assert what in said(measured)
    assert "tau1" in said(measured)


@pytest.mark.parametrize("degrees", [90, -90])
def test_a_zero_by_another_convention_is_told_with_its_joint(degrees):
    turned = 8.0 * np.sin(Q + np.radians(degrees)) + 0.5 + INERTIA
    assert f"{degrees:+d} degrees on swing" in said(turned + 0.3 * np.sign(np.gradient(Q)))


def test_a_zero_that_is_a_little_off_is_no_other_convention():
    assert said(8.0 * np.sin(Q + 0.3) + 0.5 + INERTIA) == ""
