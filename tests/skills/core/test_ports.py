from typing import Any, Literal

import numpy as np
import pytest
from caretree.skills.core.ports import Board, Input, Key, Output, PortError, assignable, bind_ports, conforms


class Base:
    pass


class Derived(Base):
    pass


class Owner:
    target = Input(Base)
    force = Input(float, default=20.0)
    hint = Input(str, default=None)
    held = Output(Base)

    def __init__(self, **ports):
        self.context = type("Context", (), {"board": Board()})()
        self.bindings = bind_ports(self, ports)


@pytest.mark.parametrize(
    ("value", "kind", "fits"),
    [
        (1, float, True),
        (1.5, float, True),
        (True, float, False),
        (True, int, False),
        (1, int, True),
        ("a", str, True),
        ("left", Literal["left", "right"], True),
        ("up", Literal["left", "right"], False),
        (None, int | None, True),
        ("a", int | None, False),
        (np.zeros(3), np.ndarray, True),
        ([1], list[int], True),
        (object(), Any, True),
        (Derived(), Base, True),
        (Base(), Derived, False),
    ],
)
def test_a_value_fits_a_declared_type(value, kind, fits):
    assert conforms(value, kind) is fits


@pytest.mark.parametrize(
    ("source", "target", "fits"),
    [
        (Derived, Base, True),
        (Base, Derived, False),
        (int, float, True),
        (float, int, False),
        (int, int | None, True),
        (int | None, int, False),
        (Literal["left"], str, True),
        (str, Literal["left"], False),
        (Literal["left"], Literal["left", "right"], True),
        (Any, int, True),
        (list[int], list, True),
    ],
)
def test_a_type_flows_into_another(source, target, fits):
    assert assignable(source, target) is fits


def test_input_from_a_constant_a_default_and_a_key():
    owner = Owner(target=Key("there"))
    assert owner.force == 20.0
    assert owner.hint is None
    value = Derived()
    owner.context.board.set("there", value)
    assert owner.target is value
    assert Owner(target=value).target is value


def test_wrong_bindings_are_refused_when_built():
    with pytest.raises(PortError, match="needs target"):
        Owner()
    with pytest.raises(PortError, match="no port 'force_limit'; it has force, held, hint, target"):
        Owner(target=Base(), force_limit=3)
    with pytest.raises(PortError, match=r"Owner.force takes float, but was given str"):
        Owner(target=Base(), force="strong")
    with pytest.raises(PortError, match="is an output and takes a Key"):
        Owner(target=Base(), held=Base())
    with pytest.raises(PortError, match="is not an identifier"):
        Key("two words")


def test_reading_what_nobody_wrote_names_what_is_there():
    owner = Owner(target=Key("there"))
    owner.context.board.set("elsewhere", 1)
    with pytest.raises(PortError, match="'there' has not been written; the board holds elsewhere"):
        _ = owner.target


def test_writing_is_checked_and_resetting_forgets():
    owner = Owner(target=Base(), held=Key("held"))
    with pytest.raises(PortError, match="takes Base, but was given int"):
        owner.held = 3
    owner.held = value = Base()
    assert owner.context.board.get("held") is value
    Owner.held.reset(owner)
    assert "held" not in owner.context.board
    with pytest.raises(PortError, match="is an input"):
        owner.target = value


def test_an_unbound_output_stays_on_its_owner():
    owner = Owner(target=Base())
    with pytest.raises(PortError, match="has not been written yet"):
        _ = owner.held
    owner.held = value = Derived()
    assert owner.held is value
    assert not owner.context.board.keys()


def test_reading_checks_the_type_of_what_another_wrote():
    owner = Owner(target=Key("there"))
    owner.context.board.set("there", 3)
    with pytest.raises(PortError, match="takes Base, but was given int"):
        _ = owner.target
