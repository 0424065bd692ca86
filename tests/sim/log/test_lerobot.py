import json

import numpy as np
import pytest
from caretree.sim.errors import RecordError
from caretree.sim.log.episode import Episode, Feature
from caretree.sim.log.lerobot import LeRobotDataset
from caretree.sim.log.robot_log import Picture
from caretree.sim.record.video import read_pictures

parquet = pytest.importorskip("pyarrow.parquet", reason="pyarrow is an extra: pip install 'caretree[lerobot]'")
RED, GREEN = (np.full((16, 24, 3), colour, np.uint8) for colour in ((200, 0, 0), (0, 200, 0)))


def picture(image, time=0.0):
    return Picture(time=time, data=image.tobytes(), shape=image.shape[:2])


def episode(values, pictures=None, robot="two arms", names=("a.pos", "b.pos")):
    values = np.array(values, np.float32)
    return Episode(robot=robot, features={"action": Feature(names=names, values=values)}, pictures=pictures or {})


@pytest.fixture
def path(tmp_path):
    return tmp_path / "dataset"


def rows(path, name="data/chunk-000/file-000.parquet"):
    return parquet.read_table(path / name).to_pylist()


def test_rows_are_numbered_through_all_episodes(path):
    dataset = LeRobotDataset(path, 5)
    dataset.add(episode([(0, 1), (2, 3), (4, 5)]), "wave")
    dataset.add(episode([(6, 7)]), "point")
    dataset.finish()
    assert [row["action"] for row in rows(path)] == [[0, 1], [2, 3], [4, 5]]
    assert [row["timestamp"] for row in rows(path)] == pytest.approx([0.0, 0.2, 0.4])
    (last,) = rows(path, "data/chunk-000/file-001.parquet")
    assert (last["index"], last["episode_index"], last["frame_index"], last["task_index"]) == (3, 1, 0, 1)
    first, second = rows(path, "meta/episodes/chunk-000/file-000.parquet")
    assert (first["dataset_from_index"], first["dataset_to_index"], first["tasks"]) == (0, 3, ["wave"])
    assert (second["dataset_from_index"], second["dataset_to_index"], second["data/file_index"]) == (3, 4, 1)
    assert first["stats/action/max"] == [4.0, 5.0]


def test_what_the_dataset_is_stands_in_its_info(path):
    dataset = LeRobotDataset(path, 5)
    dataset.add(episode([(0, 1), (2, 3)], {"head": [picture(RED)] * 2}), "wave")
    dataset.finish()
    info = json.loads((path / "meta/info.json").read_text())
    assert (info["codebase_version"], info["fps"], info["total_frames"]) == ("v3.0", 5, 2)
    assert info["features"]["action"] == {"dtype": "float32", "shape": [2], "names": ["a.pos", "b.pos"]}
    assert info["features"]["observation.images.head"]["shape"] == [16, 24, 3]
    columns = set(rows(path)[0])
    told = {name for name, feature in info["features"].items() if feature["dtype"] != "video"}
    assert told == columns
    statistics = json.loads((path / "meta/stats.json").read_text())
    assert statistics["action"]["mean"] == [1.0, 2.0]
    assert statistics["observation.images.head"]["mean"][0][0][0] == pytest.approx(200 / 255)
    assert set(statistics) == set(info["features"])


def test_a_film_shows_each_rows_picture_and_black_before_the_first(path):
    shown = [None, picture(RED), picture(RED), picture(GREEN)]
    dataset = LeRobotDataset(path, 10)
    dataset.add(episode([(0, 0)] * 4, {"head": shown}), "wave")
    dataset.finish()
    film = path / "videos/observation.images.head/chunk-000/file-000.mp4"
    seen = [image.mean(axis=(0, 1)) for image in read_pictures(film, [0.0, 0.1, 0.2, 0.3])]
    for found, asked in zip(seen, ((0, 0, 0), (200, 0, 0), (200, 0, 0), (0, 200, 0)), strict=True):
        assert found == pytest.approx(asked, abs=12)


def test_tasks_are_the_index_that_pandas_reads(path):
    dataset = LeRobotDataset(path, 5)
    dataset.add(episode([(0, 1)]), "wave")
    dataset.finish()
    table = parquet.read_table(path / "meta/tasks.parquet")
    assert table.to_pylist() == [{"task_index": 0, "task": "wave"}]
    assert table.schema.pandas_metadata["index_columns"] == ["task"]


@pytest.mark.parametrize(
    ("other", "said"),
    [
        (episode([(0, 1)], robot="one arm"), "of the robot one arm, but the first one is of two arms"),
        (episode([(0, 1)], names=("a.pos", "c.pos")), "other joints"),
        (episode([(0, 1)], {"left_hand": [picture(RED)]}), "pictures of left_hand, but the first one of head"),
        (episode([(0, 1)], {"head": [picture(RED[:8])]}), "pictures of head are 24 x 8, but the first ones 24 x 16"),
    ],
)
def test_episodes_that_do_not_fit_together_are_refused(path, other, said):
    dataset = LeRobotDataset(path, 5)
    dataset.add(episode([(0, 1)], {"head": [picture(RED)]}), "wave")
    with pytest.raises(RecordError, match=said):
        dataset.add(other, "wave")


def test_what_is_not_finished_is_not_there(path):
    dataset = LeRobotDataset(path, 5)
    dataset.add(episode([(0, 1)]), "wave")
    assert not path.exists()
    dataset.discard()
    assert list(path.parent.iterdir()) == []
    with pytest.raises(RecordError, match="one episode at least"):
        LeRobotDataset(path, 5).finish()


def test_another_dataset_stays_as_it_is(path):
    path.mkdir()
    with pytest.raises(RecordError, match="is there already: give another folder with --out"):
        LeRobotDataset(path, 5)


def test_a_full_disk_is_one_sentence(path, monkeypatch):
    dataset = LeRobotDataset(path, 5)

    def full(*_, **__):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("caretree.sim.log.lerobot.parquet.write_table", full)
    with pytest.raises(RecordError, match="the disk is full"):
        dataset.add(episode([(0, 1)]), "wave")
