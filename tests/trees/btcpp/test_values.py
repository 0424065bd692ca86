from typing import Any, Literal

import numpy as np
import pytest
from caretree.perception.estimates import GraspPoint
from caretree.sim.errors import CaretreeError
from caretree.sim.world import Side
from caretree.skills.core.ports import Input, conforms, ports_of
from caretree.skills.retreat import Retreat, RetreatTuning
from caretree.trees.btcpp.values import ValueTextError, from_text, is_pointer, same, to_text
from caretree.trees.run.catalogue import all_skills


@pytest.mark.parametrize(
    ("value", "kind", "text"),
    [
        ("left", Side, "left"),
        ("bed_right", str | np.ndarray, "bed_right"),
        (np.array((1.05, -0.1, np.pi)), str | np.ndarray, f"1.05;-0.1;{np.pi!r}"),
        (0.1 + 0.2, float, "0.30000000000000004"),
        (True, bool, "true"),
        (3, int, "3"),
        (-1.0, float | None, "-1.0"),
        (-np.inf, float, "-inf"),
        (("a", "b"), tuple[str, ...], "a;b"),
        ((1.0, 2.0), tuple[float, float], "1.0;2.0"),
        (2, Literal[1, 2], "2"),
    ],
)
def test_a_constant_comes_back_as_it_was(value, kind, text):
    assert to_text(value, kind) == text
    assert same(from_text(text, kind), value)


def test_numbers_of_a_skill_are_those_that_differ():
    usual = RetreatTuning()
    text = 'json:{"withdraw.min_rise": -1.0}'
    other = from_text(text, RetreatTuning, usual)
    assert other.withdraw.min_rise == -1.0
    assert to_text(other, RetreatTuning, usual) == text
    assert to_text(usual, RetreatTuning, usual) == "json:{}"


@pytest.mark.parametrize(
    ("value", "kind"),
    [
        ("{key}", str),
        (" padded", str),
        ("1.0", str | np.ndarray),  # would come back as numbers
        (float("nan"), float),
        (np.zeros((2, 2)), np.ndarray),
        ((), tuple[float, ...]),
        (object(), Any),
        (3, float),  # would come back as 3.0
    ],
)
def test_what_would_not_come_back_is_not_written(value, kind):
    with pytest.raises(ValueTextError, match="cannot be written in XML"):
        to_text(value, kind)


@pytest.mark.parametrize(
    ("text", "kind", "said"),
    [
        ("up", Side, "there are left, right"),
        ("lefd", Side, "did you mean left?"),
        ("yes", bool, "'yes' is no bool"),
        ("1.5", int, "no whole number"),
        ("nan", float, "'nan' is no number"),
        ("inf", int, "no whole number"),
        ("1;x", np.ndarray, "'x' is no number"),
        ("1", tuple[float, float], "1 parts, but 2 are asked for"),
        ("x", float | None, "'x' is no"),
        ("x", GraspPoint, "'x' is no GraspPoint; wire a {key} to it"),
        ("x", RetreatTuning, "does not set numbers of RetreatTuning, as json:{"),
        ("json:[1]", RetreatTuning, "does not set numbers of RetreatTuning"),
        ('json:{"withdraw.rise": 1}', RetreatTuning, "did you mean withdraw.min_rise?"),
        ('json:{"withdraw.min_rise": "x"}', RetreatTuning, "a number is asked for"),
        ("json:" + "[" * 100_000, RetreatTuning, "does not set numbers of RetreatTuning"),
    ],
)
def test_a_text_that_is_no_such_constant_is_refused(text, kind, said):
    with pytest.raises(CaretreeError) as refused:
        from_text(text, kind)
    assert said in str(refused.value)


def test_braces_name_a_key():
    assert is_pointer("{a}")
    assert not is_pointer("{}")
    assert not is_pointer("json:{}")


@pytest.mark.parametrize("kind", [*all_skills().values(), Retreat], ids=lambda kind: kind.__name__)
def test_every_default_of_every_skill_can_be_written(kind):
    for _, port in ports_of(kind):
        if isinstance(port, Input) and not port.required and port.default is not None:
            again = from_text(to_text(port.default, port.kind, port.default), port.kind, port.default)
            assert conforms(again, port.kind)
            assert same(again, port.default)
