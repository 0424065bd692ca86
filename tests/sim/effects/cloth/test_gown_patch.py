import numpy as np
import pytest
from caretree.sim.effects.cloth.gown_patch import gown_effects, loaded, recalibrated
from caretree.sim.effects.cloth.gown_patch import gown_patch as patch_of
from caretree.sim.effects.model_file import save_model
from caretree.sim.errors import CaretreeError
from caretree.sim.scene.gown import GOWNS, build_gown

DRAG = {"name": "air_drag", "target": "cloth", "parameters": {"coefficient": 1.0}}


def written(tmp_path, **changes):
    save_model(tmp_path / "model.yaml", {"system": "cloth", "recalibration": [], "effects": [DRAG], **changes})
    return tmp_path / "model.yaml"


def test_a_recalibrated_gown_has_the_files_numbers(tmp_path):
    mesh = build_gown(next(iter(GOWNS.values())))
    model = gown_effects(
        written(
            tmp_path,
            recalibration=[{"name": "elastic_stiffness", "target": "cloth", "parameters": {"elastic_stiffness": 33.0}}],
        )
    )
    assert recalibrated(mesh, model).spec.elastic == 33.0


def test_the_soft_body_is_lighter_by_its_proxy_bodies(tmp_path):
    mesh = build_gown(next(iter(GOWNS.values())))
    patch = patch_of(gown_effects(written(tmp_path)), mesh, mesh.vertices, 9.81, {0}, np.zeros((0, 7)), 1e4)
    assert len(patch.vertices) >= 12
    assert loaded(mesh, patch).spec.mass < mesh.spec.mass


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"system": "axis", "effects": []}, "for system 'axis'"),
        (
            {"effects": [{"name": "armature", "target": "cloth", "parameters": {"inertia": 1.0}}]},
            "does not exist for system cloth",
        ),
        (
            {"recalibration": [{"name": "colour", "target": "cloth", "parameters": {"colour": 1.0}}]},
            "does not fit a gown",
        ),
    ],
)
def test_a_file_that_does_not_fit_a_gown_is_refused_in_one_sentence(tmp_path, changes, words):
    with pytest.raises(CaretreeError, match=words) as caught:
        gown_effects(written(tmp_path, **changes))
    assert "\n" not in str(caught.value)
