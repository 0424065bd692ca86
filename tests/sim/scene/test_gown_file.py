from dataclasses import replace

import pytest
from caretree.sim.effects.cloth.gown_patch import with_air
from caretree.sim.errors import CaretreeError
from caretree.sim.scene.gown import GOWNS
from caretree.sim.scene.gown_file import GownFile, read_gown, write_gown
from caretree.sim.scene.scene import draw_scene, named_gown
from caretree.trees.cli import main

VALUES = {"mass": 0.43, "elastic": 41.0, "bending": 0.12, "damping": 0.004, "friction": 0.4, "air_drag": 0.25}
HEAD = "format: caretree-gown-1\nbase: light\nparameters:\n"


def test_what_is_written_is_read(tmp_path):
    gown = GownFile(base="light", values=VALUES, intervals={"mass": (0.41, 0.46)})
    path = write_gown(tmp_path / "gown.yaml", gown)
    assert read_gown(path) == gown
    assert gown.spec == replace(GOWNS["light"], name="light (identified)", **VALUES)
    assert [p.name for p in tmp_path.iterdir()] == ["gown.yaml"]


def test_a_scene_takes_a_gown_file(tmp_path):
    path = write_gown(tmp_path / "gown.yaml", GownFile(base="large", values={"mass": 0.6}, intervals={}))
    scene = draw_scene(0, gown=str(path))
    assert (scene.gown.mass, scene.gown.length) == (0.6, GOWNS["large"].length)
    assert scene.mesh.spec == scene.gown
    assert named_gown("large") == GOWNS["large"]


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        ("[1", "this is not YAML"),
        ("- 1\n", "it must begin with `format: caretree-gown-1`"),
        ("format: caretree-gown-2\n", "it must begin with `format: caretree-gown-1`"),
        ("format: caretree-gown-1\nbase: light\n", "needs `base`, the name of a gown, and `parameters`"),
        (HEAD.replace("light", "silk") + "  mass: 0.4\n", "unknown base gown 'silk'; there are medium, large, light"),
        (HEAD + "  colour: 3\n", "unknown parameter 'colour' of a gown; there are mass,"),
        (HEAD + "  mas: {value: 0.4, unit: kg}\n", "unknown parameter 'mas' of a gown; there are .*; mass is meant?"),
        (HEAD + "  mass: heavy\n", "of 'mass' must be numbers"),
        (HEAD + "  mass: true\n", "of 'mass' must be numbers"),
        (HEAD + "  mass: 0\n", "mass is 0 kg, a finite number above 0"),
        (HEAD + "  mass: .inf\n", "mass is inf kg"),
        (HEAD + "  damping: -0.1\n", "damping is -0.1 N s/m, a finite number at least 0"),
        (HEAD + "  mass: {low: 0.3, high: 0.4}\n", "parameter 'mass' needs `value`"),
        (HEAD + "  mass: {value: 0.4, low: 0.3}\n", "one end of its interval only"),
        (
            HEAD + "  mass: {value: 0.5, low: 0.3, high: 0.4}\n",
            "the interval 0.3 to 0.4 of mass does not hold its value",
        ),
        (HEAD + "  mass: {value: 500, unit: g}\n", "'mass' is given in g, it must be in kg"),
        (HEAD + "  mass: 0.4\nowner: me\n", "unknown key 'owner'"),
    ],
)
def test_a_bad_file_is_refused_in_one_sentence_that_names_it(tmp_path, content, sentence):
    path = tmp_path / "gown.yaml"
    path.write_text(content)
    with pytest.raises(CaretreeError, match=sentence) as caught:
        draw_scene(0, gown=str(path))
    assert str(caught.value).startswith(str(path))
    assert "\n" not in str(caught.value)


def test_a_missing_file_is_told():
    with pytest.raises(CaretreeError, match=r"nowhere\.yaml: there is no such gown file"):
        draw_scene(0, gown="nowhere.yaml")
    with pytest.raises(CaretreeError, match="unknown gown 'nowhere'; there are medium, large, light"):
        draw_scene(0, gown="nowhere")


def test_a_gown_too_stiff_for_the_room_is_refused_in_one_sentence(tmp_path, capfd):
    stiff = GownFile(base="light", values={"mass": 0.1, "elastic": 200.0}, intervals={})
    path = write_gown(tmp_path / "gown.yaml", stiff)
    assert main(["run", "dressing", "--gown", str(path), "--out", str(tmp_path / "run")]) == 2
    said = capfd.readouterr().err.splitlines()
    assert any(line.startswith("caretree: cloth 'light (identified)': elastic x dt^2") for line in said)
    assert not (tmp_path / "run").exists()


def test_air_comes_in_through_the_effects_unless_the_model_has_its_own():
    air = with_air(None, 0.3)
    assert [(e.name, e.parameters) for e in air.effects] == [("air_drag", {"coefficient": 0.3})]
    assert with_air(air, 0.7) is air
