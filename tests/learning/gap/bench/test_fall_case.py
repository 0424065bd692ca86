import json
from concurrent.futures import Future

import numpy as np
import pytest
import yaml
from caretree.learning.gap.bench import run
from caretree.learning.gap.bench.ablations import compare
from caretree.learning.gap.bench.fall_case import draw_fall, drop_again, write_fall_case
from caretree.learning.gap.bench.fall_observer import observe


def test_a_seed_always_hides_the_same(tmp_path):
    one, two = (write_fall_case(293, tmp_path).as_dict() for _ in range(2))
    assert one == two
    assert one["apart"] > 0.0


class Here:
    """The process that knows what is hidden, without a process."""

    def submit(self, do, *given):
        done = Future()
        done.set_result(do(*given))
        return done


def test_a_drag_with_the_cube_passes_for_wind_until_the_drops_asked_for_are_made(tmp_path, monkeypatch):
    monkeypatch.setattr(run, "_apart", Here)
    first, second = (json.loads(f.read_text()) for f in run.solve("fall", 412, tmp_path, again=True))
    assert first["hidden"] == [["cubic_drag", "body"]]
    assert first["verdict"] == "effects"
    assert second["verdict"] == "unknown"
    assert run.solve("fall", 412, tmp_path, again=True)[1].read_text() == json.dumps(second)


def test_drops_asked_for_are_added_to_the_same_recordings(tmp_path):
    first, again = tmp_path / "first", tmp_path / "again"
    first.mkdir()
    again.mkdir()
    _, drawn = draw_fall(290, first)
    drop_again(290, [{"height_m": 30.0, "mass_factor": 3.0, "drops": 3}], again)
    before, after = (yaml.safe_load((f / "measurement.yaml").read_text()) for f in (first, again))
    count = len(before["episodes"])
    assert after["episodes"][:count] == before["episodes"]
    assert all((first / e["file"]).read_text() == (again / e["file"]).read_text() for e in before["episodes"])
    assert [e["role"] for e in after["episodes"][count:]] == ["fit", "fit", "heldout"]
    assert [e["mass"] for e in after["episodes"][count:]] == pytest.approx([3.0 * after["mass"]] * 3)
    released = np.loadtxt(again / after["episodes"][-1]["file"], delimiter=",", skiprows=1)[0, 1]
    assert released / (1.0 + drawn.values["gain_error"]) == pytest.approx(29.25, abs=1.0)


def test_an_observer_who_knows_the_noise_names_what_is_far_from_every_rival(tmp_path):
    truth, drawn = draw_fall(290, tmp_path)  # a late release and a wrong scale, 22 standard deviations from any rival
    assert truth.kind == "two"
    seen = observe(truth.kind, drawn)
    assert seen.right
    assert set(seen.named) == {"delay", "gain_error"}
    assert seen.chance > 0.99


def test_simpler_ways_see_one_large_effect_and_nothing_in_noise(tmp_path):
    rng = np.random.default_rng(0)
    for seed, rate in ((1, 0.3), (3, 0.0)):
        name = f"fall_{seed:05d}"
        folder = tmp_path / "sets" / name
        folder.mkdir(parents=True)
        t = np.arange(0.0, 2.0, 1.0 / 60.0)
        way = -9.81 * (t - (1.0 - np.exp(-rate * t)) / rate) / rate if rate else -0.5 * 9.81 * t**2
        listed = []
        for k in range(3):
            h = 30.0 + way + 0.01 * rng.normal(size=len(t))
            np.savetxt(folder / f"d{k}.csv", np.stack([t, h], axis=1), delimiter=",", header="t,h", comments="")
            listed.append({"file": f"d{k}.csv", "role": "heldout" if k == 2 else "fit"})
        (folder / "measurement.yaml").write_text(json.dumps({"system": "fall", "episodes": listed}))
        effects = [{"name": "linear_drag", "target": "body", "size": 9.0}] if rate else []
        truth = {"kind": "single" if rate else "none", "effects": effects}
        (tmp_path / "truth").mkdir(exist_ok=True)
        (tmp_path / "truth" / f"{name}.json").write_text(json.dumps(truth))
    lines = compare([("fall", 1), ("fall", 3)], tmp_path, lambda line: None)
    assert any("all terms: false alarm" in line and "0/   1" in line for line in lines)
    assert len(lines) == 6
