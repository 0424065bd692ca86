import json

import pytest
from caretree.learning.gap.cli import main
from caretree.sim.effects.model_file import load_model


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
