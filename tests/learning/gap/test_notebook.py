import numpy as np
import pytest
from caretree.learning.gap.errors import GapError
from caretree.sim.effects.model_file import load_model

from caretree.gap import System, run

from .own.slider import Slider, pushes


def axis_tables(count=3, viscous=6.0):
    out = []
    for k in range(count):
        rng = np.random.default_rng([100, k])
        t = np.arange(0.0, 8.0, 0.01)
        w = 2 * np.pi * 0.15 * np.arange(1, 5)
        size, arg = rng.normal(size=4) / np.arange(1, 5) * 0.1, t[:, None] * w + rng.uniform(0, 6, 4)
        q, v, a = np.sin(arg) @ size, np.cos(arg) @ (size * w), -np.sin(arg) @ (size * w**2)
        out.append({"t": t, "q": q, "dq": v, "force": 10.0 * a + viscous * v + 0.4 * rng.normal(size=len(t))})
    return out


class Frame:
    """As much of a data frame as is asked for."""

    def __init__(self, columns):
        self.columns = np.array(list(columns), dtype=object)
        self._data = columns

    def __getitem__(self, name):
        return list(self._data[name])


def test_a_built_in_system_from_arrays_says_what_files_say(tmp_path):
    *fit, held = axis_tables()
    result = run("axis", fit=fit, heldout=[held], mass=np.float32(10.0))
    assert [f.name for f in result.verdict.effects] == ["viscous_friction"]
    assert result.verdict.effects[0].parameters[0].value == pytest.approx(6.0, rel=0.1)
    assert repr(result).startswith("effects: viscous_friction on axis; held-out gap")
    assert "viscous friction" in result._repr_html_()
    saved = result.save(tmp_path / "out")
    assert [e.name for e in load_model(saved / "model.yaml").effects] == ["viscous_friction"]
    assert (saved / "report.html").read_text() == result.html


def test_frames_and_a_class_of_ones_own():
    *fit, held = (Frame(table) for table in pushes(hidden={"rate": 0.4}))
    result = run(Slider, fit=fit, heldout=[held])
    assert [f.name for f in result.verdict.effects] == ["viscous"]
    assert result.model["system"] == "slider"
    assert result.model["simulator"].endswith("slider.py:Slider")


TABLE = pushes(1)[0]


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({"heldout": []}, "2 tables to fit and 0 held out"),
        ({"fit": [{"x": TABLE["x"]}]}, "fit_1: column 't'"),
        ({"fit": [TABLE | {"x": TABLE["x"][:-1]}]}, r"fit_1: column 'x' has shape \(199,\)"),
        ({"fit": [TABLE | {"x": np.full(200, np.nan)}]}, "fit_1: column 'x', row 0 is nan"),
        ({"fit": [TABLE | {"x": ["a"] * 200}]}, "fit_1: column 'x' does not consist of numbers"),
        ({"fit": [TABLE | {"t": TABLE["t"][::-1]}]}, "time does not increase"),
        ({"fit": [{"t": TABLE["t"], "x": TABLE["x"]}]}, "column 'push' is missing"),
        ({"mas": 1.0}, "there is no setting 'mas', did you mean mass"),
        ({"fit": TABLE}, "fit is one table, it must be a list of tables"),
        ({"fit": None}, "fit is None, it must be a list of tables"),
        ({"heldout": "abc"}, "heldout is 'abc', it must be a list of tables"),
        ({"fit": [1, 2]}, "fit_1: int is no table"),
        ({"fit": [np.zeros((20, 3))]}, "fit_1: ndarray is no table"),
        ({"fit": [TABLE | {"x": TABLE["x"] + 1j}]}, "fit_1: column 'x' does not consist of numbers"),
        ({"system": None}, "system is None, it must be a System"),
        ({"system": dict}, "is no class that derives from"),
        ({"system": System}, "System has no predict"),
        ({"fit": [TABLE | {"x": np.ma.masked_equal(TABLE["x"], TABLE["x"][3])}]}, "fit_1: column 'x', row 3 is masked"),
        ({}, "heldout_1, which is held out, is the same recording as fit_1"),
        ({"alpha": 2.0}, "alpha is 2.0, a level between 0 and 1 is needed"),
        ({"alpha": "x"}, "alpha is 'x'"),
    ],
)
def test_what_cannot_be_used_is_one_sentence(given, says):
    with pytest.raises(GapError, match=says):
        run(**({"system": Slider, "fit": [TABLE, TABLE], "heldout": [TABLE]} | given))
