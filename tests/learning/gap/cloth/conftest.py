"""A small sheet that hangs by its upper edge, as a measurement set."""

import numpy as np
import pytest
import yaml
from caretree.sim.obj_file import write_obj


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
    header = ["t", *(f"m{k}{a}" for k in range(5) for a in "xyz"), "fx", "fy", "fz"]
    for k in range(2):  # markers that never change would be refused, as would the same recording twice
        moved = table + 1e-4 * np.sin((9.0 + k) * t)[:, None] * (np.arange(table.shape[1]) == 1)
        np.savetxt(tmp_path / f"e{k}.csv", moved, delimiter=",", header=",".join(header), comments="")
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
