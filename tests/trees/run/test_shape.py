import pytest
from caretree.trees.nodes.composers import sequence
from caretree.trees.nodes.condition import Condition
from caretree.trees.run.shape import DEPTH_MAX, ShapeError, check_shape

from ..planted import run_of


def leaf(name="leaf"):
    return Condition(name, lambda context: True)


def nested(count):
    node = leaf()
    for n in range(count):
        node = sequence(f"s{n}", node)
    return node


def test_a_circle_is_found():
    one, two = sequence("one", leaf()), sequence("two", leaf())
    one.children.append(two)
    two.children.append(one)
    with pytest.raises(ShapeError, match="'one' contains itself: in 'two' too"):
        check_shape(one)
    one.children = [one]
    with pytest.raises(ShapeError, match="'one' contains itself"):
        check_shape(one)


def test_a_node_in_two_places_is_found():
    shared = leaf("shared")
    one, two = sequence("one", shared), sequence("two", leaf())
    two.children.append(shared)
    with pytest.raises(ShapeError, match="'shared' stands in two places"):
        check_shape(sequence("s", one, two))


def test_thousands_of_nodes_inside_each_other_are_too_deep():
    with pytest.raises(ShapeError, match=f"at most {DEPTH_MAX} are followed"):
        check_shape(nested(3000))
    with pytest.raises(ShapeError):
        check_shape(nested(DEPTH_MAX))


def test_what_is_allowed_runs():
    assert run_of(lambda context: nested(DEPTH_MAX - 1)).run().outcome == "success"
