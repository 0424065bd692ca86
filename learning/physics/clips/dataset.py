"""A folder of clips with the parameters they were made from: shards and `dataset.yaml`."""

from __future__ import annotations

import hashlib
import io
import os
import zipfile
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from ....sim.errors import CaretreeError
from ....sim.scene.gown import GOWNS, GownSpec
from ..engine.fall import FRAMES
from .camera import misplacement
from .clip import SIZE, unpacked
from .gown_cuts import HELDOUT_GOWN, random_cut
from .parameters import HIGH, LOW, NAMES

FORMAT = "caretree-garment-clips-1"
INDEX = "dataset.yaml"
SHARD = 100  # clips in a shard
SPREAD = 0.005  # standard deviation of a class of the paper's dataset, on the [0, 1] scale
SPLITS = ("train", "train", "train", "val", "test")  # of every five clips: 60, 20 and 20 per cent of each class


@dataclass(frozen=True, kw_only=True)
class DatasetSpec:
    """What a dataset holds; with the same spec, the same bytes.

    Attributes:
        kind: one of `KINDS`.
        classes: how many classes, for `paper`; else 1.
        per_class: clips in each class.
        seed: of the parameters and the noise.
    """

    kind: str
    classes: int
    per_class: int
    seed: int = 0

    def __post_init__(self) -> None:
        """Reject what cannot be made.

        Raises:
            CaretreeError: unknown kind, no clips, a negative seed.
        """
        if self.kind not in KINDS:
            raise CaretreeError(f"unknown kind of dataset '{self.kind}'; there are {', '.join(KINDS)}")
        if min(self.classes, self.per_class) < 1 or self.seed < 0:
            raise CaretreeError(
                f"{self.classes} classes of {self.per_class} clips with seed {self.seed} cannot be "
                "made: counts start at 1, seeds at 0"
            )
        if self.kind != "paper" and self.classes != 1:
            raise CaretreeError(f"a dataset of kind '{self.kind}' has no classes, {self.classes} were asked for")

    @property
    def clips(self) -> int:
        """How many clips in all."""
        return self.classes * self.per_class

    @property
    def views(self) -> int:
        """Clips of the same fall, one after the other."""
        return KINDS[self.kind].views

    def gown_of(self, index: int) -> GownSpec:
        """The cut that clip `index` shows."""
        if self.kind == "heldout_gown":
            return HELDOUT_GOWN
        if self.kind == "cuts":
            return random_cut(self.seed, index // self.views)
        return GOWNS["medium"]

    def class_of(self, index: int) -> int:
        """Class of clip `index`; -1 where there are no classes.

        Clips go round all classes, so that any first part of a dataset is balanced, and a dataset can be made larger
        without making it anew.
        """
        return index % self.classes if self.kind == "paper" else -1

    def split_of(self, index: int) -> str:
        """`train`, `val` or `test`; all clips of a fall are in the same part."""
        fixed = KINDS[self.kind].split
        return fixed or SPLITS[index // self.views // self.classes % len(SPLITS)]

    def disturbed(self, index: int) -> bool:
        """Whether clip `index` has noise, holes and a misplaced camera; the first view of a fall never has."""
        return self.kind == "disturbed" or index % self.views > 0

    def seed_of(self, index: int) -> int:
        """Seed of the noise of clip `index`."""
        return self.seed * 1_000_003 + index

    def misplaced(self, index: int) -> np.ndarray:
        """(6,) how far the camera of clip `index` is from where the clip says it is."""
        if not self.disturbed(index):
            return np.zeros(6)
        return misplacement(np.random.default_rng([self.seed_of(index), 5]))

    def unit_of(self, index: int) -> np.ndarray:
        """(6,) the parameters of clip `index` on the [0, 1] scale."""
        number = KINDS[self.kind].number
        if self.kind != "paper":
            return np.random.default_rng([self.seed, number, index // self.views]).random(len(NAMES))
        centre = np.random.default_rng([self.seed, number, self.class_of(index)]).random(len(NAMES))
        own = np.random.default_rng([self.seed, number, self.class_of(index), index // self.classes])
        return np.clip(centre + own.normal(0.0, SPREAD, len(NAMES)), 0.0, 1.0)


@dataclass(frozen=True)
class Kind:
    """What distinguishes a kind of dataset.

    Attributes:
        number: of the random numbers of its parameters.
        what: in words.
        views: clips of each fall: the first as it is, the others disturbed.
        split: part that all clips are in; None: 60, 20 and 20 per cent.
    """

    number: int
    what: str
    views: int = 1
    split: str | None = None


KINDS = {
    "paper": Kind(0, "classes"),
    "uniform": Kind(1, "the whole range"),
    "heldout_gown": Kind(2, "uniform, one cut that nothing is trained on", split="test"),
    "disturbed": Kind(3, "uniform, noise, holes and a misplaced camera", split="test"),
    "mixed": Kind(1, "the falls of `uniform`, each rendered as it is and three times disturbed", views=4),
    "cuts": Kind(6, "uniform, each fall of another random cut, rendered as it is and disturbed", views=2),
}


class DepthArray:
    """(N, 15, 64, 64) depths kept as uint16; what is taken out is float32 [m] with NaN where there is no gown."""

    def __init__(self, raw: np.ndarray) -> None:
        self.raw = raw
        self.shape = raw.shape

    def __len__(self) -> int:
        return len(self.raw)

    def __getitem__(self, key: Any) -> np.ndarray:
        return unpacked(self.raw[key])


@dataclass(frozen=True, kw_only=True)
class Dataset:
    """A whole dataset in memory.

    Attributes:
        depth: (N, 15, 64, 64), see `DepthArray`; `depth[i]` is one clip, `depth.raw` the stored uint16.
        unit: (N, 6) float32, the parameters on the [0, 1] scale, in the order of `parameters.NAMES`.
        class_id: (N,) int, -1 where there are no classes.
        split: (N,) `train`, `val` or `test`.
        hash: of all shards; names the data in a training record.
        spec: what was asked for.
        index: the content of `dataset.yaml`.
    """

    depth: DepthArray
    unit: np.ndarray
    class_id: np.ndarray
    split: np.ndarray
    hash: str
    spec: DatasetSpec
    index: dict[str, Any]

    def __len__(self) -> int:
        return len(self.unit)

    @property
    def numbers(self) -> list[int]:
        """Number of each clip in the whole dataset, of which some shards may not be made yet."""
        return numbers_of(self.index)

    @staticmethod
    def load(folder: str | Path, *, partial: bool = False) -> Dataset:
        """Read a dataset.

        Args:
            folder: with `dataset.yaml` and its shards.
            partial: take what is there of a dataset that is not finished.

        Raises:
            CaretreeError: it is missing, unfinished, damaged, or made for other parameter ranges.
        """
        folder = Path(folder)
        index = read_index(folder)
        spec = DatasetSpec(**index["spec"])
        shards = index["shards"]
        done = sum(shard["clips"] for shard in shards)
        if done < spec.clips and not partial:
            raise CaretreeError(
                f"{folder}: {done} of {spec.clips} clips are made; `caretree learn physics data` with "
                "the same arguments makes the others"
            )
        if not done:
            raise CaretreeError(f"{folder}: no shard is finished")
        raw = np.empty((done, FRAMES, SIZE, SIZE), np.uint16)
        parts: dict[str, list[np.ndarray]] = {"unit": [], "class_id": [], "split": []}
        at = 0
        for shard in shards:
            arrays = read_shard(folder / shard["file"], shard["sha256"])
            raw[at : at + shard["clips"]] = arrays["depth"]
            at += shard["clips"]
            for name, part in parts.items():
                part.append(arrays[name])
        return Dataset(
            depth=DepthArray(raw),
            unit=np.concatenate(parts["unit"]),
            spec=spec,
            index=index,
            class_id=np.concatenate(parts["class_id"]),
            split=np.concatenate(parts["split"]),
            hash=hashlib.sha256("".join(shard["sha256"] for shard in shards).encode()).hexdigest()[:16],
        )


def numbers_of(index: dict[str, Any]) -> list[int]:
    """Numbers of the clips whose shards an index lists."""
    return [int(shard["file"][6:10]) * SHARD + k for shard in index["shards"] for k in range(shard["clips"])]


def ranges() -> dict[str, list[float]]:
    """Parameter -> [value at 0, value at 1], as written into the index."""
    return {name: [float(low), float(high)] for name, low, high in zip(NAMES, LOW, HIGH, strict=True)}


def read_index(folder: Path) -> dict[str, Any]:
    """The content of `dataset.yaml`.

    Raises:
        CaretreeError: it is missing, damaged, or for other parameter ranges.
    """
    path = folder / INDEX
    if not path.is_file():
        raise CaretreeError(f"{folder}: this is no dataset, it has no {INDEX}")
    try:
        index = yaml.safe_load(path.read_text(encoding="utf-8"))
        right = (
            index["format"] == FORMAT
            and isinstance(index["shards"], list)
            and set(index["spec"]) == set(DatasetSpec.__dataclass_fields__)
        )
    except (yaml.YAMLError, UnicodeDecodeError, TypeError, KeyError) as error:
        raise CaretreeError(f"{path}: this is no index of a dataset in format {FORMAT}") from error
    if not right:
        raise CaretreeError(f"{path}: this is no index of a dataset in format {FORMAT}")
    if index["ranges"] != ranges():
        raise CaretreeError(f"{path}: the dataset was made for other parameter ranges than this version's")
    return index


def write_index(folder: Path, spec: DatasetSpec, shards: list[dict[str, Any]], facts: dict[str, Any]) -> None:
    """Write `dataset.yaml`, completely or not at all."""
    index = {
        "format": FORMAT,
        "spec": asdict(spec),
        "clips": sum(s["clips"] for s in shards),
        "ranges": ranges(),
        **facts,
        "shards": shards,
    }
    part = folder / (INDEX + ".part")
    part.write_text(yaml.safe_dump(index, sort_keys=False), encoding="utf-8")
    os.replace(part, folder / INDEX)


def read_shard(path: Path, sha256: str | None = None) -> dict[str, np.ndarray]:
    """The arrays of one shard: depth, unit, class_id, split.

    Raises:
        CaretreeError: it is missing, damaged, or not the file the index names.
    """
    try:
        data = path.read_bytes()
        if sha256 is not None and hashlib.sha256(data).hexdigest() != sha256:
            raise CaretreeError(f"{path}: the shard is not the one that {INDEX} names")
        with np.load(io.BytesIO(data), allow_pickle=False) as file:
            return {name: file[name] for name in ("depth", "unit", "class_id", "split")}
    except (OSError, ValueError, EOFError, KeyError, zipfile.BadZipFile) as error:
        raise CaretreeError(f"{path}: the shard cannot be read") from error
