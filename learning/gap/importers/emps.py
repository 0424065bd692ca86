"""The electro-mechanical positioning system: one axis, two records of 24.8 s; the second has controller pulses."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .setting import write_set

MASS = 95.1  # [kg] equivalent mass the authors publish


def write(files: dict[str, Path], out: Path) -> list[Path]:
    """One set: the plain record to fit, the one with pulses held out.  Force is gtau [N/V] times voltage."""
    from scipy.io import loadmat

    episodes = []
    for name, role in (("DATA_EMPS", "fit"), ("DATA_EMPS_PULSES", "heldout")):
        d = {
            k: np.asarray(v, dtype=float).ravel()
            for k, v in loadmat(files[f"{name}.mat"]).items()
            if not k.startswith("__")
        }
        episodes.append(
            (
                name.lower(),
                role,
                {
                    "t": d["t"],
                    "q": d["qm"],
                    "force": d["gtau"][0] * d["vir"],
                    "reference": d["qg"],
                    "voltage": d["vir"],
                },
            )
        )
    return [write_set(out, {"system": "axis", "mass": MASS}, episodes)]
