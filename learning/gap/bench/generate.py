"""Write the benchmark's sets and, apart from them, what they hide; perform the experiments a verdict asks for."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from .case import Truth
from .fall_case import drop_again, write_fall_case
from .joint_case import write_joint_case
from .payload_case import write_payload_case
from .placement_case import write_placement_case


def generate(system: str, seed: int, folder: Path) -> Truth:
    """Write set `seed` for a system into `folder/sets/...` and its truth into `folder/truth/...`."""
    name = f"{system}_{seed:05d}"
    where = folder / "sets" / name
    where.mkdir(parents=True, exist_ok=True)
    if system in ("arm", "axis"):
        truth = write_joint_case(system, seed, where)
    elif system == "fall":
        truth = write_fall_case(seed, where)
    elif system == "payload":
        truth = write_payload_case(seed, where)
    elif system == "placement":
        truth = write_placement_case(seed, where)
    else:
        from .cloth_case import write_cloth_case

        truth = write_cloth_case(seed, where)
    apart = folder / "truth"
    apart.mkdir(exist_ok=True)
    (apart / f"{name}.json").write_text(json.dumps(truth.as_dict(), indent=1))
    return truth


def perform(seed: int, asked: Sequence[dict[str, Any]], folder: Path) -> None:
    """Write the drops of `seed` with those a verdict asked for into `folder/sets/..._again`."""
    where = folder / "sets" / f"fall_{seed:05d}_again"
    where.mkdir(parents=True, exist_ok=True)
    drop_again(seed, asked, where)
