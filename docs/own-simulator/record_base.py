"""Stand-in for one's own recordings: a base that skids in bends and whose left wheel has worn down, as a set.

python docs/own-simulator/record_base.py runs/base
"""

import importlib.util
import sys
from pathlib import Path

import numpy as np

HIDDEN = {"skid": 0.05, "d_left": -0.001}
NOISE = (0.002, 0.002, 0.004)  # [m, m, rad] of the camera


def main(folder: Path) -> None:
    spec = importlib.util.spec_from_file_location("base", Path(__file__).with_name("base.py"))
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    system, episodes = module.Base(), []
    none = {p.name: 0.0 for p in (*(p for e in system.effects for p in e.parameters), *system.start)}
    folder.mkdir(parents=True, exist_ok=True)
    for k in range(4):
        rng, t = np.random.default_rng([100, k]), np.arange(0.0, 12.0, 0.05)
        phase = rng.uniform(0.0, 6.0, 4)
        log = {
            "t": t,
            "left": 4.0 + 2.0 * np.sin(0.7 * t + phase[0]) + 1.5 * np.sin(1.9 * t + phase[1]),
            "right": 4.0 + 2.0 * np.sin(0.6 * t + phase[2]) + 1.5 * np.sin(1.7 * t + phase[3]),
            **{name: np.zeros(len(t)) for name in system.channels},
        }
        pose = system.predict(log, none | HIDDEN)
        log |= {
            name: x + s * rng.normal(size=len(t)) for name, x, s in zip(system.channels, pose.T, NOISE, strict=True)
        }
        np.savetxt(
            folder / f"drive_{k}.csv", np.stack(list(log.values()), 1), delimiter=",", header=",".join(log), comments=""
        )
        episodes.append(f"  - {{file: drive_{k}.csv, role: {'heldout' if k == 3 else 'fit'}}}")
    (folder / "measurement.yaml").write_text("\n".join(["system: base", "episodes:", *episodes, ""]))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
