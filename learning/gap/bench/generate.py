"""Write the benchmark's sets and, apart from them, what they hide."""

from __future__ import annotations

import json
from pathlib import Path

from .case import Truth
from .fall_case import write_fall_case
from .joint_case import write_joint_case


def generate(system: str, seed: int, folder: Path) -> Truth:
    """Write set `seed` for a system into `folder/sets/...` and its truth into `folder/truth/...`."""
    name = f"{system}_{seed:05d}"
    where = folder / "sets" / name
    where.mkdir(parents=True, exist_ok=True)
    if system in ("arm", "axis"):
        truth = write_joint_case(system, seed, where)
    elif system == "fall":
        truth = write_fall_case(seed, where)
    else:
        from .cloth_case import write_cloth_case

        truth = write_cloth_case(seed, where)
    apart = folder / "truth"
    apart.mkdir(exist_ok=True)
    (apart / f"{name}.json").write_text(json.dumps(truth.as_dict(), indent=1))
    return truth
