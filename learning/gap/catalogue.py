"""Published real measurements: where they come from, and how each becomes a measurement set.

None of the data is in this repository.  `fetch` takes it from a local folder (`--data` or CARETREE_DATA) or downloads
it with pooch and checks its sha256.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from .errors import GapError


@dataclass(frozen=True, kw_only=True)
class Source:
    """One file of a data set.

    Attributes:
        local: path inside a local copy's folder.
        url: where it is published, at a fixed commit.
        sha256: first 16 digits of its checksum.
    """

    local: str
    url: str
    sha256: str


@dataclass(frozen=True, kw_only=True)
class DataSet:
    """One data set: what it is, under which licence, and its files."""

    name: str
    what: str
    licence: str
    files: tuple[Source, ...]


def _github(repository: str, commit: str, pairs: list[tuple[str, str, str]]) -> tuple[Source, ...]:
    root = f"https://raw.githubusercontent.com/{repository}/{commit}/"
    return tuple(Source(local=local, url=root + path.replace(" ", "%20"), sha256=sha) for local, path, sha in pairs)


_UNISA = ("unisa-acg/inverse-dynamics-solver", "41e196de5ca340f2b48e443484a7c74a77533da4")
_DFKI = ("dfki-ric-underactuated-lab/double_pendulum", "1e8544e67f3da72a51ee52fbbb278e131ce2a43f")
_KNIT = ("sabetta/stitch-by-stitch", "0ed27f35dcf5c3bda874f214bbcab0455055edf0")
_SAGE = ("isaac-sim2real/sage", "4ffd2627df9d23e279b35712a67e629ce0c0dfa7")
_SYSID = "data/experiment_records/design_C.1/sys_id/20230629/"

CATALOGUE: dict[str, DataSet] = {
    d.name: d
    for d in (
        DataSet(
            name="emps",
            what="electro-mechanical axis, 1 kHz, two records",
            licence="MIT; cite Janot, Gautier, Brunot 2019",
            files=_github(
                "wmkouw/NSI-EMPS",
                "d1137b8cc8a5ec3d75fe69c5d531075f7f6f616a",
                [
                    ("DATA_EMPS.mat", "data/DATA_EMPS.mat", "6cf6814ae1461879"),
                    ("DATA_EMPS_PULSES.mat", "data/DATA_EMPS_PULSES.mat", "0eab75bb1f6b1622"),
                ],
            ),
        ),
        DataSet(
            name="unisa_ur10",
            what="UR10 joint state, 125 Hz, one run",
            licence="BSD-3-Clause",
            files=_github(
                *_UNISA,
                [
                    (
                        "ur10_exciting_trajectory.db3",
                        "ur10_inverse_dynamics_solver/bagfiles/ur10_exciting_trajectory.db3",
                        "14244fc39e9b4204",
                    )
                ],
            ),
        ),
        DataSet(
            name="unisa_panda",
            what="Panda joint state, 30 Hz, one run",
            licence="BSD-3-Clause",
            files=_github(
                *_UNISA,
                [
                    (
                        "panda_exciting_trajectory.db3",
                        "franka_inria_inverse_dynamics_solver/bagfiles/panda_exciting_trajectory.db3",
                        "6794c9dc89628d77",
                    )
                ],
            ),
        ),
        DataSet(
            name="falling_balls",
            what="11 balls dropped twice from a bridge, 15 Hz",
            licence="MIT",
            files=_github(
                "briandesilva/discovery-of-physics-from-data",
                "b79c34317f049c9b47aaf2cc4c54c5ec7219f3d7",
                [
                    ("Ball_drops_data.xls", "data/Ball_drops_data.xls", "942b2d68abfff382"),
                    ("balls.txt", "data/balls.txt", "7cc282a6559ef636"),
                ],
            ),
        ),
        DataSet(
            name="knit_uniaxial",
            what="knitted fabrics pulled to 30 N, four fabrics with four pulls each",
            licence="MIT",
            files=_github(
                *_KNIT,
                [
                    (f"outputData_{fabric}.h5", f"data/uniaxial_experiments/experimentData/outputData_{fabric}.h5", sha)
                    for fabric, sha in (
                        ("Acrylic Yarn Garter Y", "51c6a640820bb494"),
                        ("Acrylic Yarn Stockinette Y", "f414a7cf96dd9654"),
                        ("Pearlized Cotton Rib Y", "a9e7d0c9540c624a"),
                        ("Pearlized Cotton Stockinette Y", "9779b094cc1c6384"),
                    )
                ],
            ),
        ),
        DataSet(
            name="dfki_double_pendulum",
            what="two-joint pendulum, 500 Hz, two runs",
            licence="BSD-3-Clause",
            files=_github(
                *_DFKI,
                [
                    (
                        "design_C.1/sys_id_20230629-143339.csv",
                        _SYSID + "20230629-143339/trajectory.csv",
                        "94f17287b53187df",
                    ),
                    (
                        "design_C.1/sys_id_20230629-143601.csv",
                        _SYSID + "20230629-143601/trajectory.csv",
                        "e028c1d7a6a45cfe",
                    ),
                    (
                        "design_C.1/model_1.0_pendubot.urdf",
                        "data/urdfs/design_C.1/model_1.0/pendubot.urdf",
                        "fc82a76ea04be985",
                    ),
                ],
            ),
        ),
        DataSet(
            name="so101_sage",
            what="SO-101 arm, 50 Hz, commanded and measured",
            licence="Apache-2.0",
            files=_github(
                *_SAGE,
                [
                    (
                        "static_holding/state_motor.csv",
                        "output/real/so101/custom/static_holding/state_motor.csv",
                        "85e7f6bbdb0f17a9",
                    )
                ],
            ),
        ),
    )
}


def located(dataset: DataSet, data: str | None) -> dict[str, Path]:
    """Local path of every file, downloaded if no local copy is given.

    Raises:
        GapError: a file is missing or is not the published one.
    """
    root = data or os.environ.get("CARETREE_DATA")
    out = {}
    for source in dataset.files:
        if root:
            path = Path(root) / dataset.name / source.local
            if not path.is_file():
                raise GapError(
                    f"{path}: no such file, --data must name a folder that holds {dataset.name}/{source.local}"
                )
        else:
            import pooch

            try:
                path = Path(
                    pooch.retrieve(
                        source.url,
                        known_hash=None,
                        path=pooch.os_cache("caretree") / dataset.name,
                        fname=Path(source.local).name,
                    )
                )
            except Exception as error:  # requests raises many kinds
                raise GapError(
                    f"{source.url}: could not be downloaded ({type(error).__name__}); give a local copy with --data"
                ) from None
        digest = hashlib.sha256(path.read_bytes()).hexdigest()
        if not digest.startswith(source.sha256):
            raise GapError(f"{path}: sha256 starts with {digest[:16]}, the published file's with {source.sha256}")
        out[source.local] = path
    return out


def fetch(name: str, out: str | None, data: str | None, say: Callable[[str], None]) -> int:
    """Write a data set as one or several measurement sets into `out`; `list` names them all.

    Raises:
        GapError: no such data set, or its files cannot be had.
    """
    if name == "list":
        for d in CATALOGUE.values():
            say(f"{d.name}: {d.what} ({d.licence})")
        return 0
    if name not in CATALOGUE:
        raise GapError(f"data set '{name}' is not in the catalogue, it has {', '.join(CATALOGUE)}")
    if out is None:
        raise GapError("--out is missing, it names the folder for the measurement set")
    from .importers import IMPORTERS

    for folder in IMPORTERS[name](located(CATALOGUE[name], data), Path(out)):
        say(str(folder))
    return 0
