import json

import numpy as np
from caretree.learning.gap.bench.ablations import compare


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
