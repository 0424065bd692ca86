import pytest
from caretree.sim.errors import CaretreeError
from caretree.trees.run.stages import span_of

NAMES = ("fetch", "pour", "clean_up")


@pytest.mark.parametrize(
    ("text", "span"),
    [
        ("fetch", ("fetch",)),
        ("clean_up", ("clean_up",)),
        ("fetch-pour", ("fetch", "pour")),
        ("fetch-clean_up", NAMES),
        ("pour-pour", ("pour",)),
    ],
)
def test_a_stage_or_a_span_is_chosen(text, span):
    assert span_of(NAMES, text) == span


@pytest.mark.parametrize("text", ["", "-", "drink", "pour-fetch", "fetch-", "-pour", "fetch-pour-clean_up", "Pour"])
def test_what_is_no_stage_is_told_with_those_there_are(text):
    with pytest.raises(CaretreeError) as caught:
        span_of(NAMES, text)
    assert str(caught.value) == f"no stage {text!r}; there are fetch, pour, clean_up, and spans such as fetch-pour"


def test_of_a_single_stage_there_is_no_span():
    with pytest.raises(CaretreeError, match=r"no stage 'b'; there are a$"):
        span_of(["a"], "b")
