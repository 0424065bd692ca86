"""Real measurements, where a local copy is at hand (CARETREE_DATA or ../shared/data); skipped elsewhere."""

import os
from pathlib import Path

import pytest
from caretree.learning.gap.catalogue import CATALOGUE, fetch
from caretree.learning.gap.errors import GapError
from caretree.learning.gap.measurement import load_set
from caretree.learning.gap.open_study import open_study

DATA = Path(os.environ.get("CARETREE_DATA", Path(__file__).parents[4] / "shared" / "data"))
real = pytest.mark.skipif(not (DATA / "emps").is_dir(), reason=f"no local copy of the real measurements at {DATA}")


@real
@pytest.mark.parametrize("name", sorted(CATALOGUE))
def test_every_data_set_becomes_a_measurement_set(name, tmp_path):
    said = []
    assert fetch(name, str(tmp_path), str(DATA), said.append) == 0
    for folder in said:
        assert len(load_set(folder).episodes) == (4 if name == "knit_uniaxial" else 2)


def imported(name, tmp_path, part=""):
    fetch(name, str(tmp_path), str(DATA), lambda text: None)
    return open_study(load_set(tmp_path / part))


@real
def test_emps_friction_matches_the_published_coefficients(tmp_path):
    study = imported("emps", tmp_path)
    _, effects, _, _ = study.name()
    values = {f.name: f.parameters[0].value for f in effects}
    assert values["viscous_friction"] == pytest.approx(203.5, rel=0.02)
    assert values["coulomb_friction"] == pytest.approx(20.4, rel=0.02)
    assert values["offset"] == pytest.approx(-3.16, rel=0.02)
    gap = study.show()[0]
    assert gap.after / gap.before < 0.12


@real
@pytest.mark.parametrize(
    ("ball", "drag"),
    [
        ("volleyball", True),
        ("whiffle_ball_1", True),
        ("bowling_ball", False),
        ("golf_ball", False),
        ("baseball", False),
    ],
)
def test_drag_is_found_on_light_balls_only(tmp_path, ball, drag):
    study = imported("falling_balls", tmp_path, ball)
    verdict, effects, _, _ = study.name()
    if drag:
        assert any("drag" in f.name for f in effects)
        assert study.show()[0].after < 0.15
    else:
        assert (verdict, effects) == ("adequate", ())


def test_a_changed_file_is_refused(tmp_path):
    for source in CATALOGUE["emps"].files:
        (tmp_path / "emps").mkdir(exist_ok=True)
        (tmp_path / "emps" / source.local).write_bytes(b"not it")
    with pytest.raises(GapError, match="sha256 starts with"):
        fetch("emps", str(tmp_path / "out"), str(tmp_path), lambda text: None)
