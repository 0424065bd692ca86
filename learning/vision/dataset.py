"""A folder of labelled pictures at the network's resolution: shards and `dataset.json`.

With the same seed and states the same bytes; what is missing is made, what is there is kept.
"""

from __future__ import annotations

import hashlib
import io
import json
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ...sim.errors import CaretreeError
from ...sim.scene.scene import room_map
from ..shards import each_shard, replace_file, shard_name
from .pictures import PARTS, Picture, chosen_states, draw_picture
from .states import RoomState

FORMAT = "caretree-seeing-2"  # 1 did not tell where over the bed a pixel is
INDEX = "dataset.json"
SHARD = 50  # pictures
SIZE = (256, 192)  # (width, height) of what the network sees [px]
CAMERAS = {"head": "head", "hand": "left_hand"}  # both hands have the same
CELL = 4  # of the maps of places and key points [px]
SHEET_UNIT = 1e-4  # of a place on the sheet, as it is kept [m]
NO_PLACE = -32768
BED_MARGIN = 0.6  # beyond the bed's outline, within which a pixel is told where over the bed it is [m]


@dataclass(frozen=True, kw_only=True)
class DatasetSpec:
    """What a dataset holds; with the same spec and the same states, the same bytes.

    Attributes:
        part: one of `PARTS`.
        pictures: how many.
        seed: of what is drawn.
        camera: one of `CAMERAS`, which takes all of them; None draws it.
        kinds: of states that are shown; all that there are if omitted.
    """

    part: str
    pictures: int
    seed: int = 0
    camera: str | None = None
    kinds: list[str] = field(default_factory=list)  # as JSON gives it back

    def __post_init__(self) -> None:
        """Reject what cannot be made.

        Raises:
            CaretreeError: an unknown part or camera, no pictures, a negative seed.
        """
        if self.part not in PARTS:
            raise CaretreeError(f"unknown part of the pictures '{self.part}'; there are {', '.join(PARTS)}")
        if self.camera is not None and self.camera not in CAMERAS:
            raise CaretreeError(f"unknown camera '{self.camera}'; there are {', '.join(CAMERAS)}")
        if self.pictures < 1 or self.seed < 0:
            raise CaretreeError(f"{self.pictures} pictures with seed {self.seed}: counts start at 1, seeds at 0")


def seen(
    rgb: np.ndarray,
    depth: np.ndarray,
    pose_camera_in_map: np.ndarray,
    intrinsics: tuple[float, ...],
    bed_in_map: np.ndarray | None,
) -> np.ndarray:
    """What the network is given of a picture.

    Args:
        rgb: (H, W, 3) uint8.
        depth: (H, W) [m], 0 where there is none.
        pose_camera_in_map: (4, 4), optical frame.
        intrinsics: (fx, fy, cx, cy) [px].
        bed_in_map: (2, 3) its lower and upper corner [m]; None where none is known.

    Returns:
        (8, 192, 256) float32: red, green, blue (0-255), depth [m], height over the floor [m], across and along the bed
        from its middle [m], and 1 where these are told, which is over the bed and `BED_MARGIN` around it.  All but the
        colours are 0 where there is no depth.
    """
    import cv2

    width, height = SIZE
    fx, fy, cx, cy = intrinsics
    small = cv2.resize(rgb, SIZE, interpolation=cv2.INTER_AREA)
    rows = ((np.arange(height) + 0.5) * depth.shape[0] / height).astype(int)
    columns = ((np.arange(width) + 0.5) * depth.shape[1] / width).astype(int)
    z = depth[np.ix_(rows, columns)]
    x, y, level = (
        z * ((columns - cx) / fx * axis[0] + ((rows - cy) / fy * axis[1])[:, None] + axis[2]) + axis[3]
        for axis in pose_camera_in_map[:3]
    )
    over = np.zeros((3, height, width))
    if bed_in_map is not None:
        low, high = bed_in_map[:, :2]
        across, along = x - (low[0] + high[0]) / 2, y - (low[1] + high[1]) / 2
        half = (high - low) / 2 + BED_MARGIN
        told = (z > 0) & (np.abs(across) < half[0]) & (np.abs(along) < half[1])
        over = np.stack([across, along, np.ones_like(z)]) * told
    return np.concatenate([small.transpose(2, 0, 1), z[None], np.where(z > 0, level, 0.0)[None], over]).astype(
        np.float32
    )


def example(picture: Picture) -> dict[str, np.ndarray]:
    """One picture as the training keeps it: what is `seen`, `surface`, `sheet`, `points` and how they are seen."""
    frame, labels = picture.frame, picture.labels
    image = seen(frame.rgb, frame.depth, frame.pose_camera_in_map, frame.intrinsics, room_map().bed)
    width, height = SIZE
    at = [((np.arange(n) + 0.5) * frame.depth.shape[k] / n).astype(int) for k, n in enumerate((height, width))]
    places = labels.sheet[np.ix_(at[0][CELL // 2 :: CELL], at[1][CELL // 2 :: CELL])]
    kept = np.where(np.isnan(places), NO_PLACE, np.round(np.nan_to_num(places) / SHEET_UNIT))
    scale = (width / frame.depth.shape[1], height / frame.depth.shape[0], 1.0)
    return {
        "rgb": image[:3].astype(np.uint8),
        "depth": np.round(image[3] * 1e3).clip(0, 65535).astype(np.uint16),
        "level": np.round(image[4] * 1e3).clip(-32768, 32767).astype(np.int16),
        "over": np.where(image[7] > 0, np.round(image[5:7] * 1e3), NO_PLACE).astype(np.int16),
        "surface": labels.surface[np.ix_(*at)],
        "sheet": kept.astype(np.int16).transpose(2, 0, 1),
        "points": ((labels.points + (0.5, 0.5, 0.0)) * scale - (0.5, 0.5, 0.0)).astype(np.float32),
        "seen": labels.seen,
    }


def image_of(row: Mapping[str, np.ndarray]) -> np.ndarray:
    """(8, 192, 256) float32 of `seen`, from one row of what `load_dataset` gives."""
    told = row["over"][:1] != NO_PLACE
    metres = [row["depth"][None], row["level"][None], row["over"] * told]
    return np.concatenate([row["rgb"], *(each * np.float32(1e-3) for each in metres), told]).astype(np.float32)


def make_dataset(
    folder: str | Path,
    states: Sequence[RoomState],
    states_hash: str,
    spec: DatasetSpec,
    say: Callable[[str], None] = lambda text: None,
    *,
    jobs: int | None = None,
    address: str | None = None,
) -> Path:
    """Make a dataset, or what is missing of it.

    Args:
        folder: made when it is not there.
        states: of `read_states`.
        states_hash: theirs.
        spec: what the dataset shall hold.
        say: takes lines of progress.
        jobs: shards made at once; more than one needs Ray.  None: one here, on a cluster as many as it has cores.
        address: of a Ray cluster; its machines need this package, not this folder.

    Raises:
        CaretreeError: the folder holds another dataset, no state is of this part, Ray is asked for and not there, or
            shards were lost with their workers.
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    about = {"format": FORMAT, "spec": asdict(spec), "states": states_hash}
    old = read_index(folder) if (folder / INDEX).is_file() else {**about, "shards": []}
    if old["states"] != states_hash or asdict(spec) | old["spec"] | {"pictures": spec.pictures} != asdict(spec):
        raise CaretreeError(f"{folder} holds other pictures than those asked for; choose another folder")
    mine = [state for state in chosen_states(states, spec.part) if not spec.kinds or state.kind in spec.kinds]
    if not mine:
        which = ", ".join((f"the part '{spec.part}'", *spec.kinds))
        raise CaretreeError(f"no state is for {which}")
    whole = {s["file"]: s for s in old["shards"] if s["pictures"] == SHARD and (folder / s["file"]).is_file()}
    missing = [n for n in range(-(-spec.pictures // SHARD)) if shard_name(n) not in whole]
    for number, shard in each_shard(make_shard, missing, mine, spec, jobs=jobs, address=address):
        replace_file(folder / shard_name(number), shard.pop("bytes"))
        spent = shard.pop("seconds")
        whole[shard_name(number)] = shard
        shards = [whole[name] for name in sorted(whole)]
        replace_file(folder / INDEX, (json.dumps({**about, "shards": shards}, indent=1) + "\n").encode())
        made = sum(s["pictures"] for s in shards)
        say(f"{spec.part}: {made} of {spec.pictures} pictures, {spent:.1f} s for the last {shard['pictures']}")
    return folder


def make_shard(number: int, states: Sequence[RoomState], spec: DatasetSpec) -> dict[str, Any]:
    """Draw the pictures of one shard.

    Args:
        number: of the shard.
        states: those of `chosen_states`.
        spec: of the dataset.

    Returns:
        `file`, `pictures`, `sha256`, `seconds` (processor time), and `bytes` of the file.
    """
    start = time.process_time()
    ids = range(number * SHARD, min((number + 1) * SHARD, spec.pictures))
    camera = CAMERAS[spec.camera] if spec.camera else None
    rows = [example(draw_picture(states, spec.part, spec.seed, i, camera=camera)) for i in ids]
    buffer = io.BytesIO()
    arrays: dict[str, Any] = {key: np.stack([row[key] for row in rows]) for key in rows[0]}
    np.savez(buffer, **arrays)  # noise does not compress
    data = buffer.getvalue()
    return {
        "file": shard_name(number),
        "pictures": len(ids),
        "sha256": hashlib.sha256(data).hexdigest(),
        "seconds": time.process_time() - start,
        "bytes": data,
    }


def read_index(folder: str | Path) -> dict[str, Any]:
    """What a dataset's folder says about it.

    Raises:
        CaretreeError: it is none.
    """
    path = Path(folder) / INDEX
    try:
        index = json.loads(path.read_text(encoding="utf-8"))
        assert index["format"] == FORMAT
    except (OSError, ValueError, KeyError, AssertionError) as error:
        raise CaretreeError(f"{folder}: this is no dataset of pictures in format {FORMAT}") from error
    return index


def load_dataset(folder: str | Path) -> tuple[dict[str, np.ndarray], str]:
    """All arrays of a dataset, stacked, and its hash.

    Raises:
        CaretreeError: it is none, or a shard is damaged.
    """
    index, parts = read_index(folder), []
    for shard in index["shards"]:
        data = (Path(folder) / shard["file"]).read_bytes()
        if hashlib.sha256(data).hexdigest() != shard["sha256"]:
            raise CaretreeError(f"{folder}/{shard['file']}: the shard is not the one that {INDEX} names")
        with np.load(io.BytesIO(data)) as file:
            parts.append({key: file[key] for key in file.files})
    # Taken out of the parts one by one: ten thousand pictures are 6 GB, and twice that is more than most have.
    arrays = {key: np.concatenate([part.pop(key) for part in parts]) for key in list(parts[0])}
    return arrays, hashlib.sha256("".join(s["sha256"] for s in index["shards"]).encode()).hexdigest()[:16]
