import numpy as np
import pytest
from caretree.sim.effects.dressing.dressing_model import changed_scene, changed_sensors
from caretree.sim.effects.dressing.dressing_registry import DRESSING_EFFECTS
from caretree.sim.effects.effect import EffectError
from caretree.sim.effects.model_file import EffectEntry, EffectModel, load_model, save_model
from caretree.sim.scene.scene import draw_scene

ALL = [(effect, target) for effect in DRESSING_EFFECTS.values() for target in effect.targets]


def model(effect, target, factor):
    values = {p.name: factor * p.typical for p in effect.parameters}
    entry = EffectEntry(name=effect.name, target=target, parameters=values)
    return EffectModel(system="dressing", base={}, recalibration=(), effects=(entry,))


def traits(scene):
    p = scene.person
    return (
        p.arm_masses.sum(),
        p.dry_friction[0],
        p.viscous,
        p.shoulder_spring,
        p.skin_friction * scene.gown.friction,
        scene.mesh.spec.elastic,
    )


def numbers(sensors):
    return np.concatenate((sensors.bias.ravel(), [sensors.delay], sensors.camera))


@pytest.mark.parametrize(("effect", "target"), ALL)
def test_an_effect_of_size_zero_changes_nothing(effect, target):
    scene = draw_scene(100)
    assert traits(changed_scene(scene, model(effect, target, 0.0))) == pytest.approx(traits(scene))
    assert not numbers(changed_sensors(model(effect, target, 0.0))).any()


@pytest.mark.parametrize(("effect", "target"), ALL)
def test_an_effect_adds_its_number_to_one_trait_alone(effect, target):
    scene = draw_scene(100)
    given = model(effect, target, 1.0)
    more = np.subtract(traits(changed_scene(scene, given)), traits(scene))
    sensors = changed_sensors(given)
    typical = [p.typical for p in effect.parameters]
    told = numbers(sensors)
    if effect.name in ("load_cell_bias", "load_delay", "camera_offset"):
        assert not more.any()
        assert told[told != 0.0] == pytest.approx(typical)
    else:
        assert more[np.abs(more) > 1e-9] == pytest.approx(typical)
        assert not told.any()
    if effect.name == "load_cell_bias":
        assert sensors.bias[effect.targets.index(target)] == pytest.approx(typical)


@pytest.mark.parametrize(("effect", "target"), [pair for pair in ALL if pair[0].parameters[0].lower < 0])
def test_the_least_an_effect_may_be_leaves_a_scene_that_can_be_built(effect, target):
    values = {p.name: p.lower for p in effect.parameters}
    entry = EffectEntry(name=effect.name, target=target, parameters=values)
    given = EffectModel(system="dressing", base={}, recalibration=(), effects=(entry,))
    assert min(traits(changed_scene(draw_scene(100), given))[:3]) > 0


def test_a_file_with_another_target_or_value_is_refused(tmp_path):
    def written(target, mass):
        entry = {"name": "arm_weight", "target": target, "parameters": {"mass": mass}}
        save_model(tmp_path / "model.yaml", {"system": "dressing", "effects": [entry]})
        return tmp_path / "model.yaml"

    assert load_model(written("arms", 0.3)).effects[0].parameters == {"mass": 0.3}
    with pytest.raises(EffectError, match="acts on arms, not on 'legs'"):
        load_model(written("legs", 0.3))
    with pytest.raises(EffectError, match="mass = 50 is outside"):
        load_model(written("arms", 50.0))
