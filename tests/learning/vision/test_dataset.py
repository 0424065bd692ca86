"""A dataset: resumable, the same bytes again, and what the network is given at run time is what it was trained on."""

import json
import sys

import numpy as np
import pytest
from caretree.learning.vision.dataset import (
    BED_MARGIN,
    INDEX,
    DatasetSpec,
    example,
    image_of,
    load_dataset,
    make_dataset,
    read_index,
    seen,
)
from caretree.learning.vision.pictures import draw_picture
from caretree.sim.errors import CaretreeError
from caretree.sim.scene.scene import room_map

from ...fake_ray import FakeRay
from .still_room import still_state


@pytest.fixture(autouse=True)
def small_shards(monkeypatch):
    monkeypatch.setattr("caretree.learning.vision.dataset.SHARD", 2)


@pytest.fixture
def states():
    return [still_state("hung"), still_state("laid")]


def test_an_interrupted_dataset_goes_on_and_has_the_same_bytes(tmp_path, states):
    make_dataset(tmp_path / "a", states, "s", DatasetSpec(part="train", pictures=4, seed=3))
    make_dataset(tmp_path / "b", states, "s", DatasetSpec(part="train", pictures=2, seed=3))
    first = (tmp_path / "b/shard_0000.npz").stat().st_mtime_ns
    make_dataset(tmp_path / "b", states, "s", DatasetSpec(part="train", pictures=4, seed=3))
    assert (tmp_path / "b/shard_0000.npz").stat().st_mtime_ns == first
    assert json.loads((tmp_path / "a" / INDEX).read_text()) == json.loads((tmp_path / "b" / INDEX).read_text())
    data, digest = load_dataset(tmp_path / "a")
    assert data["rgb"].shape == (4, 3, 192, 256)
    assert digest == load_dataset(tmp_path / "b")[1]


def test_on_a_cluster_the_bytes_are_the_same(tmp_path, states, monkeypatch):
    fake = FakeRay(cores=2)
    fake.killed = {0}
    monkeypatch.setitem(sys.modules, "ray", fake)
    spec = DatasetSpec(part="train", pictures=5, seed=3)
    make_dataset(tmp_path / "here", states, "s", spec)
    with pytest.raises(CaretreeError, match="1 shards were lost"):
        make_dataset(tmp_path / "there", states, "s", spec, address="ray://head:10001")
    assert fake.most_in_flight == 2
    assert [s["file"] for s in read_index(tmp_path / "there")["shards"]] == ["shard_0001.npz", "shard_0002.npz"]
    make_dataset(tmp_path / "there", states, "s", spec, jobs=1)
    assert (tmp_path / "there" / INDEX).read_bytes() == (tmp_path / "here" / INDEX).read_bytes()


def test_another_dataset_is_refused(tmp_path, states):
    make_dataset(tmp_path, states, "s", DatasetSpec(part="train", pictures=2, seed=3))
    with pytest.raises(CaretreeError, match="holds other pictures"):
        make_dataset(tmp_path, states, "s", DatasetSpec(part="train", pictures=2, seed=4))


def test_a_damaged_shard_is_refused(tmp_path, states):
    make_dataset(tmp_path, states, "s", DatasetSpec(part="train", pictures=2, seed=3))
    shard = tmp_path / "shard_0000.npz"
    shard.write_bytes(shard.read_bytes()[:-9] + b"tampered!")
    with pytest.raises(CaretreeError, match="not the one"):
        load_dataset(tmp_path)


def test_one_camera_and_some_kinds_of_states(tmp_path, states, monkeypatch):
    asked = []

    def drawn(states, part, seed, number, *, camera):
        asked.append((camera, {state.kind for state in states}))
        return draw_picture(states, part, seed, number, camera=camera)

    monkeypatch.setattr("caretree.learning.vision.dataset.draw_picture", drawn)
    spec = {"part": "train", "pictures": 1, "seed": 3}
    make_dataset(tmp_path, states, "s", DatasetSpec(**spec, camera="hand", kinds=["laid"]))
    assert asked == [("left_hand", {"laid"})]
    make_dataset(tmp_path, states, "s", DatasetSpec(**spec, camera="hand", kinds=["laid"]))
    with pytest.raises(CaretreeError, match="holds other pictures"):
        make_dataset(tmp_path, states, "s", DatasetSpec(**spec))
    with pytest.raises(CaretreeError, match="'train', worn"):
        make_dataset(tmp_path / "none", states, "s", DatasetSpec(**spec, kinds=["worn"]))


@pytest.mark.parametrize(
    "wrong",
    [
        {"part": "all", "pictures": 1},
        {"part": "train", "pictures": 0},
        {"part": "train", "pictures": 1, "camera": "left"},
    ],
)
def test_what_cannot_be_made_is_refused(wrong):
    with pytest.raises(CaretreeError):
        DatasetSpec(**wrong)


def test_height_over_the_floor_is_that_of_the_map(states):
    picture = draw_picture(states, "train", 3, 0, kind="laid", camera="head")
    frame = picture.frame
    image = seen(frame.rgb, frame.depth, frame.pose_camera_in_map, frame.intrinsics, None)
    floor = (image[3] > 0) & (np.abs(image[4]) < 0.03)
    assert floor.mean() > 0.05
    assert image[4][image[3] > 0].min() > -0.2


def test_where_over_the_bed_a_pixel_is_is_told_over_it_alone(states):
    picture = draw_picture(states, "train", 3, 0, kind="laid", camera="head")
    frame, bed = picture.frame, room_map().bed
    image = seen(frame.rgb, frame.depth, frame.pose_camera_in_map, frame.intrinsics, bed)
    told = image[7] > 0
    assert 0.1 < told.mean() < 1.0
    assert not image[5:7, ~told].any()
    assert np.abs(image[5]).max() < bed[1, 0] + BED_MARGIN
    kept = image_of(example(picture))
    assert np.allclose(kept[3:], image[3:], atol=1e-3)
    none = seen(frame.rgb, frame.depth, frame.pose_camera_in_map, frame.intrinsics, None)
    assert not none[5:].any()


def test_points_move_with_the_picture_s_size(states):
    picture = draw_picture(states, "train", 3, 0, kind="hung", camera="head")
    kept = example(picture)
    assert np.allclose((kept["points"][:, 0] + 0.5) / 256, (picture.labels.points[:, 0] + 0.5) / 400)
    assert kept["sheet"].shape == (3, 48, 64)
    assert kept["surface"].shape == (192, 256)
