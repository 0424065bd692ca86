from types import ModuleType

import pytest
from caretree.sim.errors import CaretreeError
from caretree.skills import HoldStill, Skill, Spread
from caretree.trees.btcpp.vocabulary import Vocabulary, identifier, ports_of_condition, ports_of_skill


def module(**names):
    made = ModuleType("task")
    made.__file__ = "task.py"
    vars(made).update(names)
    return made


def hand_is_empty(context, least: float):
    return True


@pytest.fixture(autouse=True)
def registry():
    before = list(Skill.registry)
    yield
    Skill.registry[:] = before


def test_a_task_brings_its_own_skills_and_conditions():
    class Wait(Skill):
        pass

    found = Vocabulary.of([module(Wait=Wait, Skill=Skill, HoldStill=HoldStill, CONDITIONS=(hand_is_empty,))])
    assert found.skills["Wait"] is Wait
    assert found.skills["LiftArm"].__name__ == "LiftArm"
    assert found.conditions == {"HandIsEmpty": hand_is_empty}
    assert {"Wait", "HandIsEmpty", "Sequence", "Stage"} <= set(found.names())


@pytest.mark.parametrize(
    ("names", "said"),
    [
        ({"CONDITIONS": [hand_is_empty]}, "CONDITIONS is a tuple of functions"),
        ({"CONDITIONS": ("hand_is_empty",)}, "CONDITIONS is a tuple of functions"),
        ({"Spread": type("Spread", (Skill,), {})}, "there is another Spread already"),
        ({"Fallback": type("Fallback", (Skill,), {})}, "two nodes are called Fallback"),
        ({"HandIsEmpty": type("HandIsEmpty", (Skill,), {}), "CONDITIONS": (hand_is_empty,)}, "called HandIsEmpty"),
    ],
)
def test_names_that_mean_two_things_are_refused(names, said):
    assert Spread.__name__ == "Spread"  # known to the vocabulary once it is imported
    with pytest.raises(CaretreeError) as refused:
        Vocabulary.of([module(**names)])
    assert said in str(refused.value)


def test_the_palette_knows_ports_units_and_defaults():
    ports = {port.name: port for port in ports_of_skill(HoldStill)}
    assert ports["seconds"].type == "float"
    assert "[s]" in ports["seconds"].doc
    assert ports["seconds"].direction == "input_port"
    assert [port.name for port in ports_of_condition(hand_is_empty)] == ["least", "reason"]
    assert identifier(hand_is_empty) == "HandIsEmpty"
