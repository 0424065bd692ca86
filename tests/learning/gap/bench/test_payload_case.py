import numpy as np
from caretree.learning.gap.bench.payload_case import APART, CARRIES, write_payload_case
from caretree.learning.gap.bench.score import judge_case
from caretree.learning.gap.measurement import load_set


def test_a_change_lies_within_its_recording_and_between_two_masses(tmp_path):
    kinds = set()
    for seed in (2, 4, 16):
        truth = write_payload_case(seed, tmp_path)
        kinds.add(truth.kind)
        ends = {e.name: e.t[-1] for e in load_set(tmp_path).episodes}
        assert bool(truth.changes) == (truth.kind == "change")
        for episode, t, before, after in truth.changes:
            assert 0.1 * ends[episode] < t < 0.9 * ends[episode]
            assert abs(before - after) >= APART * CARRIES[truth.robot]
            assert {before, after} <= {0.0, *(e["values"]["mass"] for e in truth.effects)}
    assert kinds == {"constant", "change"}


def test_every_change_has_to_be_told_and_no_other():
    payload = {"name": "payload", "target": "hand", "size": np.nan, "values": {"mass": 2.0}}
    truth = {"system": "payload", "seed": 1, "kind": "change", "intervals": [], "effects": [payload]}
    truth["changes"] = [["a", 5.0, 0.0, 2.0]]
    said = {"episode": "a", "t": 6.5, "before": 0.1, "after": 1.9}
    verdict = {"verdict": "effects", "effects": [], "where": [], "gap": {}}

    def told(*changes):
        return judge_case(truth, {**verdict, "changes": list(changes)})["changes_told"]

    assert told(said)
    assert not told()
    assert not told({**said, "t": 7.5})
    assert not told({**said, "after": 1.7})
    assert not told({**said, "episode": "b"})
    assert not told(said, {**said, "t": 9.0})


def test_of_several_payloads_the_nearest_is_meant():
    light, heavy = ({"name": "payload", "target": "hand", "size": np.nan, "values": {"mass": m}} for m in (1.0, 3.0))
    truth = {"system": "payload", "seed": 1, "kind": "change", "intervals": [], "effects": [light, heavy]}
    found = [
        {**payload, "parameters": [{"name": "mass", "value": m, "low": m - 0.1, "high": m + 0.1}]}
        for payload, m in ((light, 2.9), (heavy, 1.05))
    ]
    row = judge_case(truth, {"verdict": "effects", "effects": found, "where": [], "gap": {}})
    assert [i["truth"] for i in row["intervals"]] == [3.0, 1.0]
