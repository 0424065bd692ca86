import pytest
import yaml
from caretree.sim.effects.effect import EffectError
from caretree.sim.effects.model_file import EffectEntry, load_model, save_model

GOOD = {
    "system": "axis",
    "mass": 3.0,
    "recalibration": [],
    "effects": [{"name": "viscous_friction", "target": "axis", "parameters": {"coefficient": 2.0}}],
}


def test_a_model_file_comes_back_as_written(tmp_path):
    save_model(tmp_path / "model.yaml", GOOD)
    model = load_model(tmp_path / "model.yaml")
    assert model.system == "axis"
    assert model.base == {"mass": 3.0}
    assert model.effects[0].parameters == {"coefficient": 2.0}


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"system": "boat"}, "system is 'boat'"),
        ({"effects": [{"name": "magic", "parameters": {}}]}, "effect 'magic' does not exist for system axis"),
        ({"effects": [{"name": "offset", "parameters": {"value": "much"}}]}, "parameters must be numbers"),
        ({"effects": [{"name": "offset", "parameters": {}}]}, "it takes"),
        ({"effects": [{"name": "air_drag", "parameters": {"coefficient": 1.0}}]}, "does not exist for system axis"),
        ({"effects": 5}, "`effects` must be a list, it is 5"),
        ({"recalibration": "mass"}, "`recalibration` must be a list, it is 'mass'"),
        ({"effects": ["offset"]}, "needs name, target and parameters"),
    ],
)
def test_a_file_that_does_not_fit_is_refused_in_one_sentence(tmp_path, change, words):
    save_model(tmp_path / "model.yaml", {**GOOD, **change})
    with pytest.raises(EffectError, match=words) as caught:
        load_model(tmp_path / "model.yaml")
    assert "\n" not in str(caught.value)
    assert "model.yaml" in str(caught.value)


def test_a_model_for_another_system_is_refused(tmp_path):
    save_model(tmp_path / "model.yaml", GOOD)
    with pytest.raises(EffectError, match="for system 'axis', it cannot be loaded into 'cloth'"):
        load_model(tmp_path / "model.yaml").require("cloth")


def test_other_yaml_is_refused(tmp_path):
    (tmp_path / "model.yaml").write_text(yaml.safe_dump({"a": 1}))
    with pytest.raises(EffectError, match="format"):
        load_model(tmp_path / "model.yaml")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("masss: 2.0\n", "there is no key 'masss', did you mean mass"),
        ("effects: [{name: offset, target: axis, parameters: {value: 1.0}, targett: x}]\n", "did you mean target"),
        ("mass: 1\nmass: 2\n", "'mass' is given twice"),
        (f"effects: [{{name: offset, target: axis, parameters: {{value: {10**400}}}}}]\n", "must be numbers"),
    ],
)
def test_a_key_that_says_nothing_is_refused_with_the_nearest_that_does(tmp_path, text, words):
    file = tmp_path / "model.yaml"
    file.write_text("format: caretree-model-1\nsystem: axis\n" + text)
    with pytest.raises(EffectError, match=words):
        load_model(file)


def test_a_model_of_a_users_simulator_is_checked_by_its_class_and_not_by_the_registry(tmp_path):
    file = tmp_path / "model.yaml"
    effect = {"name": "haze", "target": "sky", "parameters": {"depth": 2}}
    save_model(file, {"system": "weather", "simulator": "weather.py:Weather", "effects": [effect]})
    model = load_model(file)
    assert model.base["simulator"] == "weather.py:Weather"
    assert model.effects == (EffectEntry(name="haze", target="sky", parameters={"depth": 2.0}),)
    lost = effect | {"parameters": {"depth": float("nan")}}
    for content, says in (
        ({"system": "weather", "effects": [effect]}, "must be one of arm"),
        ({"system": "arm", "simulator": "weather.py:Weather", "effects": [effect]}, "'haze' does not exist"),
        (
            {"system": "weather", "simulator": "w.py:W", "effects": [lost]},
            "nan",
        ),
    ):
        save_model(file, content)
        with pytest.raises(EffectError, match=says):
            load_model(file)
