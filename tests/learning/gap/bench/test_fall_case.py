import numpy as np
import pytest
import yaml
from caretree.learning.gap.bench.fall_case import draw_fall, drop_again, write_fall_case


def test_a_seed_always_hides_the_same(tmp_path):
    one, two = (write_fall_case(293, tmp_path).as_dict() for _ in range(2))
    assert one == two
    assert one["apart"] > 0.0


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


def test_what_is_hidden_has_the_numbers_the_registry_gives_it(tmp_path):
    truth, drawn = draw_fall(185, tmp_path)
    values = {e["name"]: e["values"] for e in truth.effects}
    assert values["wind"] == {"coefficient": drawn.values["wind"], "speed": drawn.values["updraft"]}
    assert values["linear_drag"] == {"rate": drawn.values["linear_drag"]}
