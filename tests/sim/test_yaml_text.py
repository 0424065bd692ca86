import pytest
import yaml
from caretree.sim.yaml_text import load_yaml

BOMB = "a0: &a0 [1, 1]\n" + "\n".join(f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 9)}]" for n in range(1, 12))


def test_what_is_allowed_is_read_as_ever():
    assert load_yaml("a: [1, 2.5, true]\nb: {c: text}\n") == {"a": [1, 2.5, True], "b": {"c": "text"}}
    assert load_yaml("[1e3, -2.5E-1, .5e2, 1.0e+1, 1e, e1, 1e3m]") == [1000.0, -0.25, 50.0, 10.0, "1e", "e1", "1e3m"]
    assert load_yaml("") is None
    assert load_yaml("a: &x [1]\nb: *x") == {"a": [1], "b": [1]}


@pytest.mark.parametrize(
    ("text", "problem", "line"),
    [
        ("a: 1\nb: 2\na: 3", "'a' is given twice", 3),
        ("- a: 1\n  a: 2", "'a' is given twice", 2),
        (BOMB, "aliases stand for more values", None),
        ("&a [*a]", "contains itself", 1),
        ("[" * 100_000, "too deep", None),
        ("a: [", "expected", 1),
        ("a: 2026-99-99", "month must be in", None),
        ("a: " + "9" * 5000, "Exceeds the limit", None),
    ],
)
def test_what_settings_do_not_need_is_refused(text, problem, line):
    with pytest.raises(yaml.MarkedYAMLError) as refused:
        load_yaml(text)
    assert problem in str(refused.value.problem)
    if line is not None:
        assert refused.value.problem_mark.line + 1 == line
