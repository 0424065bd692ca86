import json

import pytest
from caretree.trees.cli import main

EXTRA = "packages of an extra: pip install 'caretree[lerobot]'"
parquet = pytest.importorskip("pyarrow.parquet", reason=EXTRA)
for package in ("mcap", "av", "cv2"):
    pytest.importorskip(package, reason=EXTRA)


@pytest.fixture(autouse=True)
def in_an_empty_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def run(folder, *options):
    assert main(["run", "wave", "--world", "scripted", "--out", folder, *options]) == 0


def test_runs_become_one_dataset(in_an_empty_folder, capsys):
    run("a", "--log")
    run("b", "--log", "elsewhere.mcap", "--seed", "1")
    capsys.readouterr()
    assert main(["export", "lerobot", "a", "elsewhere.mcap", "--out", "deep/dataset"]) == 0
    first, second, where = capsys.readouterr().out.splitlines()
    assert first.startswith("a/log.mcap: ")
    assert first.endswith(" rows, head, success")
    assert second.endswith("outcome unknown"), "no record lies beside it"
    assert where == "deep/dataset"
    folder = in_an_empty_folder / "deep" / "dataset"
    info = json.loads((folder / "meta/info.json").read_text())
    assert (info["total_episodes"], info["fps"], info["total_tasks"]) == (2, 10, 2)
    rows = parquet.read_table(folder / "data/chunk-000/file-000.parquet").to_pylist()
    moved = [row["observation.state"] for row in rows]
    seconds = json.loads((in_an_empty_folder / "a/run.json").read_text())["sim_time_s"]
    assert len(rows) == pytest.approx(10 * seconds, abs=3)
    assert max(abs(a - b) for a, b in zip(moved[0], moved[len(moved) // 2], strict=True)) > 0.1, "an arm waves"


def test_rate_words_and_cameras_are_chosen():
    run("a", "--log")
    assert main(["export", "lerobot", "a", "--out", "d", "--fps", "4", "--task", "wave at me", "--camera", "head"]) == 0
    assert parquet.read_table("d/meta/tasks.parquet").to_pylist()[0]["task"] == "wave at me"


@pytest.mark.parametrize(
    ("command", "said"),
    [
        (("plain", "--out", "d"), "plain has no log: one is asked for, which `caretree run TASK --log` writes"),
        (("two", "--out", "d"), "two has a.mcap, b.mcap: one is asked for"),
        (("no.mcap", "--out", "d"), "no.mcap: no such file"),
        (("a", "--out", "d", "--fps", "0"), "--fps"),
        (("a", "--out", "d", "--fps", "100000"), "at most 1000 rows"),
        (("a", "--out", "d", "--camera", "left_hand"), "a/log.mcap has no pictures of 'left_hand', but of head"),
        (("a", "--out", "a"), "a is there already"),
        (("a",), "--out"),
    ],
)
def test_a_mistake_is_one_sentence_and_leaves_nothing(in_an_empty_folder, capsys, command, said):
    run("a", "--log")
    run("plain")
    (in_an_empty_folder / "two").mkdir()
    for name in "ab":
        (in_an_empty_folder / "two" / f"{name}.mcap").touch()
    capsys.readouterr()
    assert main(["export", "lerobot", *command]) == 2
    assert said in capsys.readouterr().err
    assert sorted(path.name for path in in_an_empty_folder.iterdir()) == ["a", "plain", "two"]


def test_runs_of_two_robots_are_refused(capsys):
    run("a", "--log")
    assert main(["run", "wave", "--world", "scripted", "--robot", "ur5-pair", "--out", "b", "--log"]) == 0
    assert main(["export", "lerobot", "a", "b", "--out", "d"]) == 2
    assert "b/log.mcap: it is of the robot" in capsys.readouterr().err
