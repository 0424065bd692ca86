from dataclasses import replace

import numpy as np
import pytest
import yaml
from caretree.learning.physics.clips import dataset, generate
from caretree.learning.physics.clips.clip import SIZE
from caretree.learning.physics.clips.dataset import INDEX, SPREAD, Dataset, DatasetSpec
from caretree.learning.physics.clips.frames import look_at
from caretree.learning.physics.clips.parameters import NAMES, to_spec
from caretree.learning.physics.clips.render_clip import render_clip
from caretree.learning.physics.engine.fall import FRAMES, cut_of
from caretree.sim.errors import CaretreeError
from caretree.sim.scene.gown import GOWNS, GownSpec

PAPER = DatasetSpec(kind="paper", classes=3, per_class=5)
pytestmark = pytest.mark.usefixtures("quick")


def test_a_dataset_is_what_was_asked_for(tmp_path):
    said = []
    data = Dataset.load(generate.generate(tmp_path, PAPER, say=said.append))
    assert (len(data), data.depth.shape, data.depth.raw.dtype) == (15, (15, FRAMES, SIZE, SIZE), np.uint16)
    assert data.unit.shape == (15, len(NAMES))
    np.testing.assert_array_equal(data.class_id, np.arange(15) % 3)
    for k in range(3):
        assert sorted(data.split[data.class_id == k]) == ["test", "train", "train", "train", "val"]
    clip = render_clip(to_spec(PAPER.unit_of(7), PAPER.gown_of(7)))
    np.testing.assert_allclose(data.depth[7], clip.depth, atol=1e-4)
    assert [line for line in said if "left" in line]
    index = yaml.safe_load((tmp_path / INDEX).read_text())
    assert [shard["clips"] for shard in index["shards"]] == [4, 4, 4, 3]
    assert index["machine"]
    assert index["versions"]["numpy"] == np.__version__


def test_a_dataset_can_grow(tmp_path):
    first = Dataset.load(generate.generate(tmp_path, replace(PAPER, per_class=4)))
    more = Dataset.load(generate.generate(tmp_path, replace(PAPER, per_class=5)))
    assert (len(first), len(more)) == (12, 15)
    np.testing.assert_array_equal(first.depth.raw, more.depth.raw[:12])
    with pytest.raises(CaretreeError, match="this folder holds 3 x 5 clips of kind 'paper' with seed 0, not 3 x 4"):
        generate.generate(tmp_path, replace(PAPER, per_class=4))
    with pytest.raises(CaretreeError, match="choose another folder"):
        generate.generate(tmp_path, DatasetSpec(kind="uniform", classes=1, per_class=30))


def test_classes_are_narrow_and_far_apart():
    spec = DatasetSpec(kind="paper", classes=100, per_class=60)
    units = np.array([spec.unit_of(i) for i in range(spec.clips)]).reshape(60, 100, 6)
    assert np.all((units >= 0) & (units <= 1))
    assert units.std(axis=0).mean() == pytest.approx(SPREAD, rel=0.05)
    assert units.mean(axis=(0, 1)) == pytest.approx(np.full(6, 0.5), abs=0.1)


@pytest.mark.parametrize("kind", ["uniform", "heldout_gown", "disturbed"])
def test_other_kinds(tmp_path, kind):
    spec = DatasetSpec(kind=kind, classes=1, per_class=5)
    data = Dataset.load(generate.generate(tmp_path, spec))
    assert set(data.class_id) == {-1}
    assert set(data.split) == ({"train", "val", "test"} if kind == "uniform" else {"test"})
    clean = render_clip(to_spec(spec.unit_of(0), spec.gown_of(0))).depth
    same = np.isfinite(clean) == np.isfinite(data.depth[0])
    assert same.all() == (kind != "disturbed")


def test_what_is_no_dataset_is_refused(tmp_path):
    with pytest.raises(CaretreeError, match="this is no dataset"):
        Dataset.load(tmp_path)
    (tmp_path / INDEX).write_text("[1, 2")
    with pytest.raises(CaretreeError, match="no index of a dataset"):
        Dataset.load(tmp_path)
    (tmp_path / INDEX).write_text("format: other\n")
    with pytest.raises(CaretreeError, match="no index of a dataset"):
        Dataset.load(tmp_path)
    (tmp_path / INDEX).unlink()
    (tmp_path / "shard_0000.npz").write_bytes(b"")
    with pytest.raises(CaretreeError, match="there are shards but no"):
        generate.generate(tmp_path, PAPER)


def test_a_dataset_of_other_ranges_is_refused(tmp_path):
    generate.generate(tmp_path, PAPER)
    index = tmp_path / INDEX
    index.write_text(index.read_text().replace("- 0.045", "- 0.05"))
    with pytest.raises(CaretreeError, match="other parameter ranges"):
        Dataset.load(tmp_path)


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"kind": "blender"}, "unknown kind of dataset 'blender'"),
        ({"classes": 0}, "cannot be made"),
        ({"seed": -1}, "cannot be made"),
        ({"kind": "uniform"}, "has no classes, 3 were asked for"),
    ],
)
def test_bad_specs_are_refused(changes, sentence):
    with pytest.raises(CaretreeError, match=sentence):
        replace(PAPER, **changes)


def test_the_heldout_gown_is_another_cut_that_can_be_rendered():
    held = DatasetSpec(kind="heldout_gown", classes=1, per_class=1).gown_of(0)
    assert cut_of(held)[0].vertices.shape != cut_of(GOWNS["medium"])[0].vertices.shape
    assert isinstance(held, GownSpec)


def test_mixed_renders_the_falls_of_uniform_clean_and_three_times_rough(tmp_path):
    uniform = Dataset.load(generate.generate(tmp_path / "u", DatasetSpec(kind="uniform", classes=1, per_class=5)))
    mixed = Dataset.load(generate.generate(tmp_path / "m", DatasetSpec(kind="mixed", classes=1, per_class=20)))
    np.testing.assert_array_equal(mixed.depth.raw[::4], uniform.depth.raw)
    np.testing.assert_array_equal(mixed.unit, np.repeat(uniform.unit, 4, axis=0))
    np.testing.assert_array_equal(mixed.split, np.repeat(uniform.split, 4))  # no fall is both learned from and tested
    spec = mixed.spec
    again = render_clip(to_spec(spec.unit_of(2), spec.gown_of(2)), seed=spec.seed_of(2), disturbed=True).depth
    np.testing.assert_allclose(mixed.depth[2], again, atol=1e-4)  # the camera and the noise are the ones it names
    assert look_at(mixed.depth).rough.reshape(5, 4).tolist() == [[False, True, True, True]] * 5
    assert not spec.misplaced(0).any()
    assert np.abs(spec.misplaced(1)).max() > 0.01
    assert (spec.misplaced(1) != spec.misplaced(2)).all()


def test_each_fall_of_cuts_shows_another_cut(tmp_path):
    data = Dataset.load(generate.generate(tmp_path, DatasetSpec(kind="cuts", classes=1, per_class=8)))
    assert [data.spec.gown_of(i).length for i in data.numbers] == [8, 8, 7, 7, 8, 8, 7, 7]
    assert list(data.split) == ["train"] * 6 + ["val"] * 2
    there = np.isfinite(data.depth[:8])
    assert not (there[0] == there[1]).all()  # the second view of a fall is rough


def test_a_part_of_a_dataset_knows_which_clips_it_holds(tmp_path):
    spec = DatasetSpec(kind="uniform", classes=1, per_class=12)
    generate.generate(tmp_path, spec)
    index = dataset.read_index(tmp_path)
    dataset.write_index(tmp_path, spec, index["shards"][1:], {})
    data = Dataset.load(tmp_path, partial=True)
    assert data.numbers == list(range(4, 12))
    np.testing.assert_allclose(data.unit[0], spec.unit_of(4), atol=1e-6)
