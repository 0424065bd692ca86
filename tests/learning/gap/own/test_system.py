import numpy as np
import pytest
from caretree.learning.gap.errors import GapError
from caretree.learning.gap.own.system import check_system

from caretree.gap import Effect, Parameter, System

from .slider import Slider, pushes


def number(name="a", **given):
    return Parameter(name=name, unit="1", **given)


def like(**attributes):
    return type("Mine", (Slider,), attributes)()


def test_a_sound_class_passes():
    system = Slider()
    assert check_system(system) is system


@pytest.mark.parametrize(
    ("attributes", "says"),
    [
        ({"name": "two words"}, "name is 'two words'"),
        ({"name": ""}, "`name` is missing"),
        ({"channels": {}}, "`channels` is missing"),
        ({"channels": {"x": 1.0}}, "channels is"),
        ({"effects": ("drag",)}, "is no Effect"),
        ({"effects": (Effect(name="a", parameters=()),)}, "is no Effect"),
        ({"effects": (Effect(name="a", parameters=(number(lower=0.1),)),)}, "must let 0 be"),
        ({"effects": (Effect(name="a", parameters=(number(typical=0.0),)),)}, "typical of a"),
        ({"effects": (Effect(name="a", parameters=(number(), number())),)}, "already one of a"),
        ({"effects": (Effect(name="a", exports="colour", parameters=(number(),)),)}, "exports 'colour'"),
        ({"effects": tuple(Effect(name="a", parameters=(number(n),)) for n in "bc")}, "is there twice"),
        ({"start": (number("rate"),)}, "already one of viscous"),
        ({"start": number("rate")}, "start is"),
        ({"effects": Effect(name="a", parameters=(number(),))}, "it must be a tuple: (Effect(...),) with its comma"),
        ({"effects": (Effect(name="a", parameters=number()),)}, "must be a tuple: (Parameter(...),)"),
        ({"effects": (Effect(name=3, parameters=(number(),)),)}, "is no Effect"),
        ({"effects": (Effect(name="a", target=3, parameters=(number(),)),)}, "acts on 3"),
        ({"effects": (Effect(name="a", regressor="x", parameters=(number(),)),)}, "regressor of effect a is 'x'"),
        ({"effects": (Effect(name="a", parameters=(number(typical="5"),)),)}, "typical of a is '5'"),
        ({"effects": (Effect(name="a", parameters=(number(lower="0"),)),)}, "lower of a is '0'"),
        ({"effects": (Effect(name="a", parameters=("a",)),)}, "'a' is no Parameter"),
        ({"model_error": 0.1}, "model_error is 0.1"),
        ({"model_error": {"x": "0.1"}}, "must be a finite size"),
    ],
)
def test_what_cannot_work_is_refused_in_one_sentence(attributes, says):
    with pytest.raises(GapError, match=r"^Mine") as error:
        check_system(like(**attributes))
    assert says in str(error.value)
    assert "\n" not in str(error.value)


def test_experiments_vary_the_commands_alone():
    log = pushes(1)[0]
    plans = Slider().experiments(log)
    np.testing.assert_allclose(plans["repeat it with commands half as large"]["push"], 0.5 * log["push"])
    for plan in plans.values():
        np.testing.assert_array_equal(plan["x"], log["x"])
    longer = plans["repeat it with every command held twice as long"]["t"]
    assert longer[-1] - longer[0] == pytest.approx(2 * (log["t"][-1] - log["t"][0]))
    assert like(inputs={}).experiments(log) == {}


def test_a_system_cannot_be_made_without_predict():
    with pytest.raises(TypeError):
        System()
