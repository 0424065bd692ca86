"""One small sheet in PyBullet: what is simulated, what is kept, what is refused."""

import dataclasses

import numpy as np
import pytest
import yaml
from caretree.learning.gap.cloth.candidates import Candidate
from caretree.learning.gap.cloth.fitting import ClothFit, ClothModel
from caretree.learning.gap.cloth.noise import Coherence, coherence, neighbours
from caretree.learning.gap.cloth.obj import read_obj, write_obj
from caretree.learning.gap.cloth.scene import read_scene
from caretree.learning.gap.cloth.search import ClothSearch
from caretree.learning.gap.cloth.simulate import Simulator
from caretree.learning.gap.errors import GapError
from caretree.learning.gap.measurement import load_set
from caretree.learning.gap.open_study import open_study
from caretree.sim.effects.model_file import EffectEntry


@pytest.fixture
def cloth_set(tmp_path):
    n, h = 7, 0.05
    v = np.array([(i * h, 0.0, 1.0 - j * h) for j in range(n) for i in range(n)])
    f = np.array(
        [
            t
            for j in range(n - 1)
            for i in range(n - 1)
            for a in [j * n + i]
            for t in ((a, a + n, a + 1), (a + 1, a + n, a + n + 1))
        ]
    )
    write_obj(tmp_path / "sheet.obj", v, f)
    t = np.arange(0.0, 0.5, 0.02)
    markers = [0, 3, 24, 45, 48]
    table = np.column_stack([t, *(np.full_like(t, v[m][a]) for m in markers for a in range(3)), *np.zeros((3, len(t)))])
    table[:, 1] += 1e-4 * np.sin(9.0 * t)  # markers that never change would be refused
    header = ["t", *(f"m{k}{a}" for k in range(5) for a in "xyz"), "fx", "fy", "fz"]
    for k in range(2):
        np.savetxt(tmp_path / f"e{k}.csv", table, delimiter=",", header=",".join(header), comments="")
    (tmp_path / "measurement.yaml").write_text(
        yaml.safe_dump(
            {
                "system": "cloth",
                "mesh": "sheet.obj",
                "markers": markers,
                "physics": {
                    "mass": 0.1,
                    "elastic_stiffness": 40.0,
                    "damping_stiffness": 0.01,
                    "bending_stiffness": 0.1,
                    "friction": 0.4,
                    "gravity": -9.81,
                },
                "pins": [{"vertices": [0, 1, 2, 3, 4, 5, 6]}],
                "episodes": [{"file": "e0.csv"}, {"file": "e1.csv"}],
            }
        )
    )
    return tmp_path


def test_a_run_repeats_exactly_and_is_done_once(cloth_set, tmp_path):
    scene, episodes = read_scene(load_set(cloth_set))
    sim = Simulator(scene, tmp_path / "cache")
    first = sim.run(episodes[0])
    assert np.array_equal(first, Simulator(scene).run(episodes[0]))
    again = Simulator(scene, tmp_path / "cache")
    assert np.array_equal(first, again.run(episodes[0]))
    assert (sim.runs, again.runs) == (1, 0)


def test_the_load_at_the_pin_is_the_weight_once_it_hangs(cloth_set):
    scene, episodes = read_scene(load_set(cloth_set))
    long = dataclasses.replace(episodes[0], t=np.arange(0.0, 3.0, 0.05))
    load = Simulator(scene).run(long)[-20:, -1].mean()
    assert load == pytest.approx(-0.1 * 9.81, rel=0.05)


def test_tilted_gravity_swings_the_free_edge_towards_the_tilt(cloth_set):
    scene, episodes = read_scene(load_set(cloth_set))
    sim = Simulator(scene)
    tilt = EffectEntry(name="tilted_gravity", target="cloth", parameters={"towards_x": 0.0, "towards_y": 0.2})
    change = sim.run(episodes[0], (tilt,)) - sim.run(episodes[0])
    assert change[-1, 3 * 3 + 1] > 0.005


def test_an_effect_of_no_size_changes_nothing_but_brings_its_proxy_bodies(cloth_set):
    scene, episodes = read_scene(load_set(cloth_set))
    sim = Simulator(scene)
    drag = EffectEntry(name="air_drag", target="cloth", parameters={"coefficient": 0.0})
    stiff = EffectEntry(name="strain_stiffening", target="cloth", parameters={"stiffness": 0.0, "onset": 0.1})
    late = EffectEntry(name="delay", target="cloth", parameters={"time": 0.0})
    assert np.array_equal(sim.run(episodes[0], (drag,)), sim.run(episodes[0], (stiff,)))
    assert np.array_equal(sim.run(episodes[0], (late,)), sim.run(episodes[0]))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"mesh": "gone.obj"}, "gone.obj: no such file"),
        ({"markers": [0, 99]}, "`markers` must list vertex ids from 0 to 48"),
        ({"pins": [{"vertices": [70]}]}, "ids from 0 to 48"),
        ({"physics": {"mass": -1}}, "physics.mass is -1"),
        ({"capsules": [{"a": [0, 0, 0]}]}, "every capsule needs a, b"),
        ({"capsules": [{"a": [0, 0, 0], "b": [0, 0, 1], "radius": -1}]}, "positive radius"),
        ({"capsules": 3}, "every capsule needs a, b"),
        ({"physics": "soft"}, "`physics` is 'soft'"),
        ({"physics": {"gravity": "down"}}, "physics.gravity is 'down'"),
        ({"physics": {"gravity": [0, 0]}}, "physics.gravity is"),
        ({"physics": {"time_step": 0}}, "physics.time_step is 0"),
        ({"physics": {"mass": 0.1, "elastic_stiffness": 1e12}}, "need steps of"),
        ({"physics": {"mass": 0.001}}, "must weigh at least 0.009 kg"),
        ({"pins": "left"}, "`pins` is 'left'"),
        ({"pins": [{"vertices": [0], "release_t": "soon"}]}, "release_t of a pin is 'soon'"),
        ({"pins": [{"vertices": [0], "path": 7}]}, "path of a pin is 7"),
    ],
)
def test_a_set_that_does_not_fit_is_refused(cloth_set, change, words):
    file = cloth_set / "measurement.yaml"
    file.write_text(yaml.safe_dump({**yaml.safe_load(file.read_text()), **change}))
    with pytest.raises(GapError, match=words):
        read_scene(load_set(cloth_set))


@pytest.mark.parametrize(
    ("column", "factor", "words"),
    [(0, 1000.0, "column 't' steps by 20, it must be in seconds"), (6, 1000.0, "column 'm1z', row 2 .* in metres")],
)
def test_numbers_in_a_wrong_unit_are_refused(cloth_set, column, factor, words):
    table = np.loadtxt(cloth_set / "e1.csv", delimiter=",", skiprows=1)
    header = (cloth_set / "e1.csv").read_text().splitlines()[0]
    table[:, column] *= factor
    np.savetxt(cloth_set / "e1.csv", table, delimiter=",", header=header, comments="")
    with pytest.raises(GapError, match=words):
        read_scene(load_set(cloth_set))


def test_markers_that_never_move_teach_nothing(cloth_set):
    table = np.loadtxt(cloth_set / "e1.csv", delimiter=",", skiprows=1)
    header = (cloth_set / "e1.csv").read_text().splitlines()[0]
    table[:, 1:] = table[0, 1:]
    np.savetxt(cloth_set / "e1.csv", table, delimiter=",", header=header, comments="")
    with pytest.raises(GapError, match=r"e1.csv: columns 'm0x' and on never change"):
        open_study(load_set(cloth_set))


def test_a_load_is_used_only_where_every_recording_has_one(cloth_set):
    assert read_scene(load_set(cloth_set))[1][0].load is not None
    lines = [line.rsplit(",", 3)[0] for line in (cloth_set / "e1.csv").read_text().splitlines()]
    (cloth_set / "e1.csv").write_text("\n".join(lines))
    assert [e.load for e in read_scene(load_set(cloth_set))[1]] == [None, None]


@pytest.mark.parametrize(
    ("stiffness", "newtons", "verdict"), [(20.0, 0.0, "recalibration"), (1e-6, 0.0, "unknown"), (20.0, 3.0, "unknown")]
)
def test_a_recalibration_must_suit_the_load_and_be_a_number_cloth_can_have(cloth_set, stiffness, newtons, verdict):
    study = open_study(load_set(cloth_set))
    rng = np.random.default_rng(0)
    rows = len(study.episodes[0].t)
    for e in study.episodes:
        e.load[:, 2] = -np.linspace(0.0, 5.0, rows)
    noise = np.concatenate([1e-4 * rng.normal(size=(rows, 15)), 0.01 * rng.normal(size=(rows, 3))], axis=1)
    off = np.zeros((rows, 18))
    off[:, 17] = np.linspace(0.0, 1.0, rows)
    start = ClothModel(physics={"elastic_stiffness": 40.0}, free=(("physics", "elastic_stiffness"),))

    def fit(model, load):
        return ClothFit(model=model, rss=1.0, residuals=[noise + load * off], covariance=np.eye(1))

    calm = Coherence(shared=0.0, floor=1e-4, p_value=0.5)
    study.__dict__["found"] = ClothSearch(
        chosen=(
            Candidate(name="elastic_stiffness", target="cloth", start=start, push=start, steps={}, recalibration=True),
        ),
        fit=fit(ClothModel(physics={"elastic_stiffness": stiffness}), newtons),
        plain=fit(ClothModel(), 4.0),
        before=calm,
        after=calm,
        rivals={},
        worth=100.0,
    )
    assert study.verdict == verdict


def test_a_bad_mesh_is_refused_before_pybullet_hangs_on_it(tmp_path):
    for text, words in (
        ("v 0 0 0\nf 1 2 3\n", "a face names vertex 3"),
        ("", "the mesh is empty"),
        ("v a b c\n", "row 1"),
    ):
        (tmp_path / "bad.obj").write_text(text)
        with pytest.raises(GapError, match=words):
            read_obj(tmp_path / "bad.obj")


def test_stays_are_springs_and_no_cloth(tmp_path):
    vertices = np.array([(0.0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)])
    write_obj(tmp_path / "sewn.obj", vertices, np.array([(0, 1, 2), (1, 3, 2)]), np.array([(0, 1, 3)]))
    read, faces, stays = read_obj(tmp_path / "sewn.obj")
    assert np.allclose(read, vertices)
    assert faces.tolist() == [[0, 1, 2], [1, 3, 2]]
    assert stays.tolist() == [[0, 1, 3]]


def test_neighbours_share_a_model_error_and_not_their_noise():
    rng = np.random.default_rng(0)
    points = np.array([(i * 0.1, j * 0.1, 0.0) for i in range(4) for j in range(4)])
    noise = [0.01 * rng.normal(size=(80, 48))]
    alone = coherence(noise, neighbours(points), 16)
    assert alone.p_value > 0.05
    assert alone.floor == pytest.approx(0.01, rel=0.1)
    swing = 0.02 * np.sin(np.linspace(0, 6, 80))[:, None] * np.ones(48)
    both = coherence([noise[0] + swing], neighbours(points), 16)
    assert both.p_value < 1e-6
    assert both.floor == pytest.approx(0.01, rel=0.25)
    assert both.shared == pytest.approx(0.02**2 / 2, rel=0.3)
