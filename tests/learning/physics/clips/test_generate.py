import sys
from dataclasses import replace
from types import SimpleNamespace

import pytest
from caretree.learning.physics.clips import generate
from caretree.learning.physics.clips.dataset import Dataset, DatasetSpec
from caretree.sim.errors import CaretreeError

PAPER = DatasetSpec(kind="paper", classes=3, per_class=5)
pytestmark = pytest.mark.usefixtures("quick")


def test_the_same_seed_gives_the_same_bytes_however_often_it_was_interrupted(tmp_path, monkeypatch):
    generate.generate(tmp_path / "once", PAPER)
    real, made = generate.make_shard, []

    def killed(spec, number, folder=None):
        if len(made) == 2:
            (tmp_path / "twice" / "shard_0002.npz.part").write_bytes(b"half")
            raise KeyboardInterrupt
        made.append(number)
        return real(spec, number, folder)

    monkeypatch.setattr(generate, "make_shard", killed)
    with pytest.raises(KeyboardInterrupt):
        generate.generate(tmp_path / "twice", PAPER)
    with pytest.raises(CaretreeError, match="8 of 15 clips are made"):
        Dataset.load(tmp_path / "twice")
    assert len(Dataset.load(tmp_path / "twice", partial=True)) == 8
    monkeypatch.setattr(generate, "make_shard", lambda *a: made.append(a[1]) or real(*a))
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


class FakeRay:
    """As much of Ray as `generate` uses, in this process and in reverse order."""

    def __init__(self):
        self.asked, self.flying = None, 0

    def init(self, **asked):
        self.asked = asked
        if asked.get("address") == "ray://nobody":
            raise ConnectionError("ray client connection timeout\nand more")
        if asked.get("num_cpus") == 3:
            raise Exception("The current node timed out during startup.")

    def remote(self, **_):
        def wrap(function):
            def call(*arguments):
                self.flying += 1
                return lambda: function(*arguments)

            return SimpleNamespace(remote=call)

        return wrap

    def wait(self, refs, num_returns):
        assert len(refs) <= 2
        return refs[-1:], refs[:-1]

    def get(self, ref):
        return ref()

    def shutdown(self):
        self.asked = None


def test_with_ray_the_bytes_are_the_same(tmp_path, monkeypatch):
    fake = FakeRay()
    monkeypatch.setitem(sys.modules, "ray", fake)
    generate.generate(tmp_path / "one", PAPER)
    generate.generate(tmp_path / "many", PAPER, jobs=2)
    assert fake.flying == 4
    assert Dataset.load(tmp_path / "one").hash == Dataset.load(tmp_path / "many").hash
    with pytest.raises(CaretreeError, match=r"no Ray cluster answers at ray://nobody: ray client connection timeout$"):
        generate.generate(tmp_path / "far", PAPER, address="ray://nobody")
    with pytest.raises(CaretreeError, match="Ray does not start here: The current node timed out"):
        generate.generate(tmp_path / "far", PAPER, jobs=3)


def test_without_ray_several_jobs_are_refused(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "ray", None)
    with pytest.raises(CaretreeError, match="more than one job needs Ray"):
        generate.generate(tmp_path, PAPER, jobs=2)
