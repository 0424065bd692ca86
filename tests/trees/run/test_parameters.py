from typing import Annotated, Literal

import pytest
from caretree.trees.run.parameters import Parameter, ParameterError, all_values, parameters_of


def build(
    context,
    stages=(),
    seconds: Annotated[float, Parameter("how long", unit="s", low=5.0, high=60.0)] = 10.0,
    arm: Annotated[Literal["left", "right"], Parameter("whose")] = "right",
    times: Annotated[int, Parameter("how often", low=1)] = 2,
    gently: Annotated[bool, Parameter("slower")] = False,
):
    """Only what is declared is a parameter."""


def test_what_is_declared_has_defaults_and_takes_values():
    declared = parameters_of(build)
    assert all_values(declared, {"seconds": 8, "arm": "left"}, "t") == {
        "seconds": 8.0,
        "arm": "left",
        "times": 2,
        "gently": False,
    }
    assert declared["seconds"].line() == "seconds = 10.0  (a number from 5 to 60 s): how long"


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"second": 8}, "no parameter 'second'; it has seconds, arm, times, gently; seconds is meant"),
        ({"stages": ()}, "no parameter 'stages'"),
        ({"seconds": 4.9}, "seconds is 4.9, but a number from 5 to 60 s is asked for"),
        ({"seconds": float("nan")}, "seconds is nan"),
        ({"seconds": "long"}, "seconds is 'long'"),
        ({"seconds": True}, "seconds is True"),
        ({"arm": "up"}, "arm is 'up', but left or right is asked for"),
        ({"times": 1.5}, "times is 1.5, but a whole number from 1 is asked for"),
        ({"gently": 1}, "gently is 1, but true or false is asked for"),
        ({"lift_arm": 3}, "it is a skill, whose numbers are set as lift_arm.NUMBER=VALUE"),
    ],
)
def test_a_wrong_value_is_refused_in_one_sentence(given, words):
    with pytest.raises(ParameterError, match=words):
        all_values(parameters_of(build), given, "t")


def none_given(context, n: Annotated[int, Parameter("x")]):
    """A parameter without a default."""


def of_no_kind(context, n: Annotated[list, Parameter("x")] = ()):
    """A parameter of a type that nothing sets."""


def out_of_bounds(context, n: Annotated[float, Parameter("x", high=1.0)] = 2.0):
    """A default that a run could not set."""


@pytest.mark.parametrize(
    ("function", "words"),
    [(none_given, "no default"), (of_no_kind, "or a Literal"), (out_of_bounds, "n is 2.0, but a number to 1")],
)
def test_a_wrong_declaration_is_refused(function, words):
    with pytest.raises(ParameterError, match=words):
        parameters_of(function)
