import numpy as np
from caretree.learning.gap.joints.remains.events import Burst, stands_out
from caretree.learning.gap.measurement import load_set
from caretree.learning.gap.open_study import open_study

from ..solved import solved


def test_contact_is_placed_in_time(axis_set):
    wall = 0.05
    study, _, effects, _, _ = solved(axis_set(lambda q, v, a: 80.0 * np.maximum(q - wall, 0.0)))
    assert [f.name for f in effects] == ["contact"]
    both = either = 0
    for episode in study.measured.episodes:
        real = episode.columns["q"] > wall
        found = np.zeros(len(real), dtype=bool)
        for w in study.find()[2]:
            if w.effect == "contact" and w.episode == episode.name:
                found |= (episode.t >= w.t0) & (episode.t <= w.t1)
        both, either = both + (real & found).sum(), either + (real | found).sum()
    assert both / either > 0.7


def test_a_contact_at_a_time_is_named_and_placed(axis_set):
    folder = axis_set(noise=0.1)
    truth = {}
    for k in range(3):
        file = folder / f"e{k}.csv"
        data = np.loadtxt(file, delimiter=",", skiprows=1)
        start = 2.0 + 1.1 * k
        inside = (data[:, 0] > start) & (data[:, 0] < start + 0.6)
        data[:, 3] += np.where(inside, 2.0 * np.sin(np.pi * (data[:, 0] - start) / 0.6), 0.0)
        truth[f"e{k}"] = (start, start + 0.6)
        np.savetxt(file, data, delimiter=",", header="t,q,dq,force", comments="")
    study, verdict, effects, _, _ = solved(folder)
    assert verdict == "effects"
    assert [(f.name, f.target) for f in effects] == [("contact", "axis")]
    places = [w for w in study.find()[2] if w.effect == "contact"]
    assert {w.episode for w in places} == set(truth)
    for w in places:
        a, b = truth[w.episode]
        assert (min(w.t1, b) - max(w.t0, a)) / (max(w.t1, b) - min(w.t0, a)) > 0.7


def test_a_burst_has_to_stand_out_behind_the_shared_filter_too(axis_set):
    log = open_study(load_set(axis_set())).fitted[0]
    t, rng = log.t[log.inner], np.random.default_rng(0)
    quiet = rng.normal(size=(len(t), 1))
    burst = Burst(episode=log.name, channel=0, t0=3.0, t1=3.5, load=1.0, strength=20.0)
    assert not stands_out(burst, [log], [quiet])
    assert stands_out(burst, [log], [quiet + 5.0 * ((t > 3.0) & (t < 3.5))[:, None]])
