import json
from pathlib import Path

import pytest
import yaml
from caretree.learning.gap.cli import main
from caretree.learning.gap.own.find_system import find_system
from caretree.learning.gap.own.values import values_of
from caretree.learning.gap.table import write_table
from caretree.sim.effects.model_file import load_model

from .own.slider import pushes


def test_run_writes_report_verdict_and_model(axis_set, tmp_path, capsys):
    out = tmp_path / "out"
    assert main(["run", str(axis_set(lambda q, v, a: 6.0 * v)), "--out", str(out)]) == 0
    verdict = json.loads((out / "verdict.json").read_text())
    assert verdict["verdict"] == "effects"
    assert {"where", "effects", "gap", "alpha"} <= set(verdict)
    assert {"floor", "before", "after", "unit", "channels"} <= set(verdict["gap"])
    assert {"channel", "t0", "t1", "state_region", "phase", "p_value"} <= set(verdict["where"][0])
    assert {"name", "target", "parameters", "equivalent", "experiment"} <= set(verdict["effects"][0])
    assert {"name", "unit", "value", "low", "high"} <= set(verdict["effects"][0]["parameters"][0])
    model = load_model(out / "model.yaml")
    assert [e.name for e in model.effects] == ["viscous_friction"]
    page = (out / "report.html").read_text()
    assert "viscous friction" in page
    assert "data:image/png;base64," in page
    assert "effects viscous_friction on axis" in capsys.readouterr().out


def test_the_four_steps_one_after_the_other_say_the_same(axis_set, tmp_path, capsys):
    out, folder = tmp_path / "steps", str(axis_set(lambda q, v, a: 6.0 * v))
    assert main(["find", folder, "--out", str(out)]) == 0
    assert capsys.readouterr().out.startswith("not adequate")
    for step in ("name", "add", "show"):
        assert main([step, str(out)]) == 0
    assert json.loads((out / "verdict.json").read_text())["effects"][0]["name"] == "viscous_friction"


@pytest.mark.parametrize(
    "argv",
    [
        ["run", "nowhere", "--out", "x"],
        ["name", "nowhere"],
        ["fetch", "moon", "--out", "x"],
        ["bench", "--seeds", "a"],
        ["bench", "--system", "boat"],
        ["bench", "--system", "axis", "--follow-up"],
        ["find", "nowhere"],
        ["record", "--out", "x", "--seed", "-1"],
        ["cook"],
    ],
)
def test_bad_input_is_one_sentence_and_exit_2(argv, capsys):
    assert main(argv) == 2
    text = capsys.readouterr().err
    assert text.startswith("caretree gap: ")
    assert text.count("\n") == 1


def test_a_result_folder_that_is_a_file_is_one_sentence(axis_set, tmp_path, capsys):
    (tmp_path / "out").write_text("")
    assert main(["run", str(axis_set()), "--out", str(tmp_path / "out" / "below")]) == 2
    text = capsys.readouterr().err.splitlines()[-1]
    assert text.startswith("caretree gap: ")
    assert "out" in text


@pytest.fixture
def slider_set(tmp_path):
    """A set of the small system of one's own, with friction hidden in it, and the argument that names its class."""
    listed = []
    for k, table in enumerate(pushes(hidden={"rate": 0.4})):
        write_table(tmp_path / "slides" / f"e{k}.csv", table)
        listed.append({"file": f"e{k}.csv"})
    (tmp_path / "slides" / "measurement.yaml").write_text(yaml.safe_dump({"system": "slider", "episodes": listed}))
    return str(tmp_path / "slides"), f"{Path(__file__).parent / 'own' / 'slider.py'}:Slider"


def test_a_simulator_of_ones_own_goes_through_every_step(slider_set, tmp_path, capsys):
    folder, kind = slider_set
    out = tmp_path / "own"
    assert main(["find", folder, "--system", kind, "--out", str(out)]) == 0
    assert capsys.readouterr().out.startswith("not adequate")
    for step in ("name", "add", "show"):
        assert main([step, str(out)]) == 0
    verdict = json.loads((out / "verdict.json").read_text())
    assert [f["name"] for f in verdict["effects"]] == ["viscous"]
    assert verdict["gap"]["after"] < 0.2 * verdict["gap"]["before"]
    assert "viscous" in (out / "report.html").read_text()
    system = find_system(kind)
    assert values_of(out / "model.yaml", system)["rate"] == pytest.approx(0.4, rel=0.05)
    (tmp_path / "slider.urdf").write_text("<robot name='slider'/>")
    capsys.readouterr()
    assert main(["export", str(out), "--robot", str(tmp_path / "slider.urdf"), "--to", str(tmp_path / "x.urdf")]) == 0
    assert "viscous on system: not in this format" in capsys.readouterr().err


def test_a_set_of_ones_own_system_says_how_to_name_its_class(slider_set, tmp_path, capsys):
    folder, kind = slider_set
    out = str(tmp_path / "own")
    assert main(["run", folder, "--out", out]) == 2
    assert "--system path.py:Class" in capsys.readouterr().err
    assert main(["run", folder, "--system", kind.replace(":Slider", ":Plain"), "--out", out]) == 2
    assert "system is 'slider', it must be one of arm, axis, fall, cloth, dressing, plain" in capsys.readouterr().err
    assert main(["export", out, "--to", "x.urdf"]) == 2
