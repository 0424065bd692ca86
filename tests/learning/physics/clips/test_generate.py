import sys
from dataclasses import replace

import pytest
from caretree.learning.physics.clips import generate
from caretree.learning.physics.clips.dataset import Dataset, DatasetSpec
from caretree.sim.errors import CaretreeError

from ....fake_ray import FakeRay

PAPER = DatasetSpec(kind="paper", classes=3, per_class=5)
pytestmark = pytest.mark.usefixtures("quick")


def test_the_same_seed_gives_the_same_bytes_however_often_it_was_interrupted(tmp_path, monkeypatch):
    generate.generate(tmp_path / "once", PAPER)
    real, made = generate.make_shard, []

    def killed(number, spec):
        if len(made) == 2:
            (tmp_path / "twice" / "shard_0002.npz.part").write_bytes(b"half")
            raise KeyboardInterrupt
        made.append(number)
        return real(number, spec)

    monkeypatch.setattr(generate, "make_shard", killed)
    with pytest.raises(KeyboardInterrupt):
        generate.generate(tmp_path / "twice", PAPER)
    with pytest.raises(CaretreeError, match="8 of 15 clips are made"):
        Dataset.load(tmp_path / "twice")
    assert len(Dataset.load(tmp_path / "twice", partial=True)) == 8
    monkeypatch.setattr(generate, "make_shard", lambda *a: made.append(a[0]) or real(*a))
    generate.generate(tmp_path / "twice", PAPER)
    assert made == [0, 1, 2, 3]
    assert Dataset.load(tmp_path / "once").hash == Dataset.load(tmp_path / "twice").hash
    assert (
        Dataset.load(generate.generate(tmp_path / "other", replace(PAPER, seed=1))).hash
        != Dataset.load(tmp_path / "once").hash
    )


def test_damage_is_seen_and_repaired(tmp_path):
    generate.generate(tmp_path, PAPER)
    before = Dataset.load(tmp_path).hash
    shard = tmp_path / "shard_0001.npz"
    shard.write_bytes(shard.read_bytes()[:1000])
    with pytest.raises(CaretreeError, match="the shard is not the one"):
        Dataset.load(tmp_path)
    generate.generate(tmp_path, PAPER)
    assert Dataset.load(tmp_path).hash == before
    shard.unlink()
    with pytest.raises(CaretreeError, match="cannot be read"):
        Dataset.load(tmp_path)


class LastFirst(FakeRay):
    """The shard that was asked for last is ready first."""

    def init(self, **asked):
        if asked.get("num_cpus") == 3:
            raise Exception("The current node timed out during startup.")
        super().init(**asked)

    def wait(self, references, num_returns):
        return references[-num_returns:], references[:-num_returns]


def test_with_ray_the_bytes_are_the_same(tmp_path, monkeypatch):
    fake = LastFirst(cores=3)
    monkeypatch.setitem(sys.modules, "ray", fake)
    generate.generate(tmp_path / "one", PAPER)
    generate.generate(tmp_path / "two", PAPER, jobs=2)
    assert fake.most_in_flight == 2
    generate.generate(tmp_path / "many", PAPER, address="ray://head:10001")
    assert fake.most_in_flight == 3  # as many as the cluster has cores
    hashes = {Dataset.load(tmp_path / name).hash for name in ("one", "two", "many")}
    assert len(hashes) == 1
    with pytest.raises(CaretreeError, match=r"no Ray cluster answers at ray://nobody: timeout$"):
        generate.generate(tmp_path / "far", PAPER, address="ray://nobody")
    with pytest.raises(CaretreeError, match="Ray does not start here: The current node timed out"):
        generate.generate(tmp_path / "far", PAPER, jobs=3)


def test_a_lost_worker_loses_its_own_shard_only(tmp_path, monkeypatch):
    fake = LastFirst(cores=2)
    fake.killed = {1}
    monkeypatch.setitem(sys.modules, "ray", fake)
    with pytest.raises(CaretreeError, match="1 shards were lost"):
        generate.generate(tmp_path, PAPER, address="ray://head:10001")
    assert sorted(path.name for path in tmp_path.glob("*.npz")) == [f"shard_000{n}.npz" for n in (0, 2, 3)]
    generate.generate(tmp_path, PAPER)
    assert len(Dataset.load(tmp_path)) == PAPER.clips


def test_without_ray_several_jobs_are_refused(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "ray", None)
    with pytest.raises(CaretreeError, match="more than one job needs Ray"):
        generate.generate(tmp_path, PAPER, jobs=2)
