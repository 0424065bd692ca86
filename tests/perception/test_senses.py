"""Senses are whole or they are not made."""

import pytest
from caretree.perception.senses import Senses
from caretree.sim.errors import CaretreeError


def test_senses_that_lack_a_method_are_refused_by_its_name():
    methods = {name: lambda self, *_, **__: None for name in Senses.__abstractmethods__ - {"head", "arm"}}
    with pytest.raises(CaretreeError, match=r"^the senses Half lack arm, head$"):
        type(Senses)("Half", (Senses,), methods)()
