import numpy as np
import pytest
import yaml
from caretree.learning.gap.joints.log import FEWEST
from caretree.learning.gap.measurement import load_set
from caretree.learning.gap.open_study import open_study

MASS, DRY = 12.0, 3.0  # [kg], [N]
MOVE, REST = 1.2, 0.8  # [s]


def moves(folder, viscous=0.0, seed=2):
    """A mass that goes from place to place; at rest its drive bears what friction happened to leave it."""
    rng = np.random.default_rng(seed)
    t = np.arange(0.0, 14.0, 0.005)
    entries = []
    for k in range(3):
        q, v, a, held = (np.zeros(len(t)) for _ in range(4))
        place, begin = 0.0, 0.5
        while begin < t[-1]:
            way = rng.uniform(0.05, 0.3) * (1 if place < 0 else -1)
            s = np.clip((t - begin) / MOVE, 0.0, 1.0)
            inside = (s > 0) & (s < 1)
            q += way * (10 * s**3 - 15 * s**4 + 6 * s**5)
            v[inside] = (way / MOVE * 30 * (s**2 - 2 * s**3 + s**4))[inside]
            a[inside] = (way / MOVE**2 * 60 * (s - 3 * s**2 + 2 * s**3))[inside]
            held[t >= begin + MOVE] = rng.uniform(-0.9, 0.9) * DRY
            place, begin = place + way, begin + MOVE + REST
        friction = np.where(np.abs(v) > 1e-9, DRY * np.sign(v) + viscous * v, held)
        force = MASS * a + friction + 0.2 * rng.normal(size=len(t))
        table = np.column_stack([t, q + 2e-6 * rng.normal(size=len(t)), force])
        np.savetxt(folder / f"r{k}.csv", table, delimiter=",", header="t,q,force", comments="")
        entries.append({"file": f"r{k}.csv", "role": "heldout" if k == 2 else "fit"})
    (folder / "measurement.yaml").write_text(yaml.safe_dump({"system": "axis", "mass": MASS, "episodes": entries}))
    return open_study(load_set(folder))


@pytest.mark.parametrize("seed", [2, 3, 4])
def test_friction_that_holds_a_joint_at_rest_is_no_contact_and_its_level_is_that_of_the_motion(tmp_path, seed):
    study = moves(tmp_path, viscous=10.0, seed=seed)
    verdict = study.conclude()
    assert verdict.verdict == "effects"
    found = {f.name: {p.name: p for p in f.parameters} for f in verdict.effects}
    assert set(found) == {"coulomb_friction", "viscous_friction"}
    for name, parameter, value in (("coulomb_friction", "level", DRY), ("viscous_friction", "coefficient", 10.0)):
        told = found[name][parameter]
        assert told.low < value < told.high
        assert told.value == pytest.approx(value, rel=0.05)
    assert any("in which nothing moves" in note for note in verdict.notes)


def test_rests_count_where_no_friction_makes_them_unsure(axis_set):
    study = open_study(load_set(axis_set(lambda q, v, a: 6.0 * v)))
    assert study.conclude().verdict == "effects"
    assert all(log.left_out is None for log in (*study.fitted, *study.heldout))


def test_enough_of_every_log_is_left(tmp_path):
    study = moves(tmp_path)
    for log in (*study.fitted, *study.heldout):
        rows = len(log.t[log.inner])
        assert FEWEST < rows < len(log.t) - 2 * log.trim
        assert len(log.residual[log.inner]) == rows
