import numpy as np
import pytest
from caretree.learning.gap.cloth.candidates import Candidate
from caretree.learning.gap.cloth.equals import Equals
from caretree.learning.gap.cloth.fitting import ClothFit, ClothModel
from caretree.learning.gap.cloth.noise import Coherence
from caretree.learning.gap.cloth.search import ClothSearch
from caretree.learning.gap.errors import GapError
from caretree.learning.gap.measurement import load_set
from caretree.learning.gap.open_study import open_study


def test_markers_that_never_move_teach_nothing(cloth_set):
    table = np.loadtxt(cloth_set / "e1.csv", delimiter=",", skiprows=1)
    header = (cloth_set / "e1.csv").read_text().splitlines()[0]
    table[:, 1:] = table[0, 1:]
    np.savetxt(cloth_set / "e1.csv", table, delimiter=",", header=header, comments="")
    with pytest.raises(GapError, match=r"e1.csv: columns 'm0x' and on never change"):
        open_study(load_set(cloth_set))


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
        return ClothFit(model=model, rss=1.0, residuals=[noise + load * off], half=np.ones(1))

    calm = Coherence(shared=0.0, floor=1e-4, p_value=0.5)
    study.__dict__["found"] = ClothSearch(
        chosen=(
            Candidate(name="elastic_stiffness", target="cloth", start=start, push=start, steps={}, recalibration=True),
        ),
        fit=fit(ClothModel(physics={"elastic_stiffness": stiffness}), newtons),
        sure=fit(ClothModel(physics={"elastic_stiffness": stiffness}), newtons),
        plain=fit(ClothModel(), 4.0),
        before=calm,
        after=calm,
        rivals={},
        worth=100.0,
        weights=np.ones(18),
    )
    assert study.verdict == verdict


@pytest.mark.parametrize(("after", "believed"), [(0.5, True), (4.0, False)])
def test_what_makes_the_held_out_recording_worse_is_never_found(cloth_set, monkeypatch, after, believed):
    study = open_study(load_set(cloth_set))
    start = ClothModel(physics={"elastic_stiffness": 40.0}, free=(("physics", "elastic_stiffness"),))
    rows = len(study.episodes[0].t)
    off = 1e-3 * np.random.default_rng(0).normal(size=(rows, 18))
    calm = Coherence(shared=0.0, floor=1e-4, p_value=0.5)
    fit = ClothFit(model=start, rss=1.0, residuals=[0.1 * off], half=np.ones(1))
    candidate = Candidate(
        name="elastic_stiffness", target="cloth", start=start, push=start, steps={}, recalibration=True
    )
    found = ClothSearch(
        chosen=(candidate,),
        fit=fit,
        sure=fit,
        plain=ClothFit(model=ClothModel(), rss=1.0, residuals=[off], half=np.ones(0)),
        before=calm,
        after=calm,
        rivals={},
        worth=100.0,
        weights=np.ones(18),
    )
    monkeypatch.setattr(study.sim, "ahead", lambda runs: None)
    monkeypatch.setattr(
        "caretree.learning.gap.cloth.fitting.ClothFitter.residuals",
        lambda self, model: [(after if model.physics else 1.0) * off],
    )
    study.__dict__["found"] = study._believed(found)
    assert (study.verdict == "recalibration") == believed
    assert bool(study.found.chosen) == believed
    assert study.found.fit.model.physics == ({"elastic_stiffness": 40.0} if believed else {})


def test_whole_sets_that_fit_as_well_are_told(cloth_set):
    study = open_study(load_set(cloth_set))
    effects = {
        name: Candidate(name=name, target="cloth", start=ClothModel(), push=ClothModel(), steps={})
        for name in ("wind", "offset")
    }
    nothing = ClothFit(model=ClothModel(), rss=1.0, residuals=[], half=np.ones(0))
    calm = Coherence(shared=0.0, floor=1e-4, p_value=0.5)
    study.__dict__["found"] = ClothSearch(
        chosen=(effects["wind"], effects["offset"]),
        fit=nothing,
        sure=nothing,
        plain=nothing,
        before=calm,
        after=calm,
        rivals={},
        worth=100.0,
        weights=np.ones(18),
    )
    study.__dict__["verdict"], wind = "effects", (("wind", "cloth"),)
    study.__dict__["equals"] = Equals(
        instead={}, sets=(wind, (*wind, *((n, "cloth") for n in ("offset", "delay")))), spread={}
    )
    told = [{name for name, _ in r.effects} for r in study.rivals()]
    assert told == [{"wind"}, {"wind", "offset", "delay"}]
    assert all(r.experiment for r in study.rivals())
    study.__dict__["equals"] = None  # nothing is sure enough to have equals
    assert study.rivals() == ()
