"""Where the URDF of a robot lies: beside the measurement set, or in example-robot-data under one of its names."""

from __future__ import annotations

import difflib
import sys
from pathlib import Path

from ..errors import GapError

SHARED = Path("site-packages", "cmeel.prefix", "share", "example-robot-data", "robots")
NAMES_SHOWN = 5


def robots_folder() -> Path:
    """Folder of example-robot-data, one folder per family of robots in it."""
    return Path(sys.prefix, "lib", f"python{sys.version_info[0]}.{sys.version_info[1]}") / SHARED


def find_urdf(robot: str, *folders: Path) -> Path:
    """Path of a robot's URDF.

    A name in example-robot-data is that of a file, the beginning of one up to an underscore (`ur10` of
    `ur10_robot.urdf`), or that of a robot's folder with or without `_description`.  Capitals count only where the name
    has some.

    Args:
        robot: a file, or a name.
        *folders: where a file may be besides the working directory: that of the measurement set.

    Raises:
        GapError: there is none; the message lists names that resemble the one given.
    """
    for path in (Path(robot), *(folder / robot for folder in folders)):
        if path.suffix == ".urdf" and path.is_file():
            return path
    if robot.endswith(".urdf"):
        raise GapError(f"robot: no URDF file {robot} (looked in {' and '.join(map(str, folders))} too)")
    base = robots_folder()
    files = sorted((p for p in base.rglob("*.urdf") if _has_links(p)), key=lambda p: (len(p.stem), str(p)))
    names = {p: (p.stem, p.relative_to(base).parts[0].removesuffix("_description")) for p in files}
    if robot.islower():
        names = {p: (file.lower(), family.lower()) for p, (file, family) in names.items()}
    wanted = robot.removesuffix("_description")
    for fits in (
        lambda file, family: file == robot,
        lambda file, family: file.startswith(robot + "_"),
        lambda file, family: family == wanted,
        lambda file, family: file.startswith(robot),
    ):
        found = next((p for p, (file, family) in names.items() if fits(file, family)), None)
        if found is not None:
            return found
    if any(p.name.removesuffix("_description") == wanted for p in base.glob("*")):
        raise GapError(f"robot is '{robot}', example-robot-data has no URDF of it, name a URDF file")
    near = [p.stem for p in files if robot.lower()[:3] in p.stem.lower()]
    near = near or difflib.get_close_matches(robot, [p.stem for p in files], n=NAMES_SHOWN) or ["ur10", "panda"]
    raise GapError(
        f"robot is '{robot}', it must be a URDF file or a name in example-robot-data such as "
        f"{', '.join(near[:NAMES_SHOWN])}"
    )


def _has_links(file: Path) -> bool:
    """Whether a URDF holds a robot; `ur3.urdf` is what is left of a file that others include."""
    return "<link" in file.read_text(encoding="utf-8", errors="replace")
