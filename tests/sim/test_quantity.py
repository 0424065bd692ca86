import importlib
import pkgutil
from dataclasses import FrozenInstanceError, dataclass, is_dataclass

import caretree.perception
import caretree.skills
import caretree.trees
import pytest
from caretree.sim.quantity import Quantities, QuantityError, changed, quantity, rows

for package in (caretree.skills, caretree.perception, caretree.trees):
    for info in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
        if not info.name.endswith("__main__"):
            importlib.import_module(info.name)


@dataclass(frozen=True, kw_only=True)
class Inner(Quantities):
    ends: tuple[float, float] = quantity((0.1, 0.2), "m", "where it begins and ends", "choice: for a test")


@dataclass(frozen=True, kw_only=True)
class Outer(Quantities):
    speed: float = quantity(0.5, "m/s", "of the hand", "choice: for a test")
    tries: int = quantity(3, "1", "before it gives up", "choice: for a test")
    pause: float = quantity(2.0, "s", "between two of them", "choice: for a test")
    inner: Inner = Inner()


def test_rows_flatten_what_is_nested():
    assert [(row.name, row.value, row.unit) for row in rows(Outer())] == [
        ("speed", 0.5, "m/s"),
        ("tries", 3, "1"),
        ("pause", 2.0, "s"),
        ("inner.ends", (0.1, 0.2), "m"),
    ]


def test_a_changed_copy_leaves_the_first_as_it_was():
    first = Outer()
    second = changed(first, {"speed": 1, "tries": 4.0, "inner.ends": [0.3, 0.4]})
    assert (second.speed, second.tries, second.inner.ends) == (1.0, 4, (0.3, 0.4))
    assert first == Outer()
    with pytest.raises(FrozenInstanceError):
        second.speed = 2.0


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"sped": 1.0}, "did you mean speed"),
        ({"speed": "fast"}, "a number"),
        ({"speed": float("nan")}, "a number"),
        ({"tries": 1.5}, "whole number"),
        ({"pause": 0.0}, "pause is 0.0, but a span of time"),
        ({"pause": -3}, "a span of time"),
        ({"pause": float("inf")}, "a span of time"),
        ({"inner.ends": [1.0]}, "2 numbers"),
    ],
)
def test_what_does_not_fit_is_refused_in_one_sentence(values, words):
    with pytest.raises(QuantityError, match=words):
        changed(Outer(), values)


def test_texts_must_not_be_empty():
    with pytest.raises(QuantityError, match="unit"):
        quantity(1.0, " ", "of it", "choice: none")


def every(kind=Quantities):
    return [found for sub in kind.__subclasses__() for found in (sub, *every(sub))]


@pytest.mark.parametrize("kind", [k for k in every() if k.__module__.startswith("caretree.")], ids=lambda k: k.__name__)
def test_every_table_of_the_package_is_frozen_and_says_all(kind):
    assert is_dataclass(kind)
    assert kind.__dataclass_params__.frozen
    assert kind.__doc__
    assert all(row.source.split(":")[0] for row in rows(kind()))
