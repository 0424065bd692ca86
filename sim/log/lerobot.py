"""Episodes as a LeRobot dataset, version 3.0: parquet for numbers, H.264 for pictures, JSON for what they are.

The layout is the one that LeRobot's own writer makes (huggingface/lerobot 0.4, `LeRobotDataset`): one file of numbers
and one film of each camera for every episode.
"""

from __future__ import annotations

import contextlib
import json
import shutil
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import RecordError
from ..extras import later
from ..record.spool import disk_error
from ..record.video import VideoWriter
from .episode import Episode
from .robot_log import Picture

arrow: Any = later("pyarrow")
parquet: Any = later("pyarrow.parquet")

VERSION = "v3.0"
IN_A_CHUNK = 1000  # files of one folder, as LeRobot has it
NUMBERS = "data/chunk-{chunk_index:03d}/file-{file_index:03d}.parquet"
FILMS = "videos/{video_key}/chunk-{chunk_index:03d}/file-{file_index:03d}.mp4"
EPISODES = "meta/episodes/chunk-000/file-000.parquet"
QUANTILES = {"q01": 0.01, "q10": 0.1, "q50": 0.5, "q90": 0.9, "q99": 0.99}
KEYFRAME_EVERY = 2  # pictures: rows are asked for at random
SAMPLES, STRIDE = 100, 8  # pictures of an episode, and pixels of a picture, that statistics are made of
INDEXES = ("timestamp", "frame_index", "episode_index", "index", "task_index")


class LeRobotDataset:
    """A dataset that is being written; it is in its folder when `finish` has returned, and nowhere before.

    Args:
        path: of the folder, which must not be there yet.
        rate: rows a second of every episode [Hz].

    Raises:
        MissingExtra: pyarrow is not installed.
        RecordError: the folder is there already, or cannot be written.
    """

    def __init__(self, path: Path, rate: int) -> None:
        self._path, self._rate = path, rate
        self._part = path.with_name(path.name + ".part")
        if path.exists():
            raise RecordError(f"{path} is there already: give another folder with --out")
        self._first: Episode | None = None
        self._sizes: dict[str, tuple[int, int]] = {}
        self._rows: list[dict[str, np.ndarray]] = []
        self._told: list[dict[str, Any]] = []
        self._seen: dict[str, list[np.ndarray]] = {}
        self._tasks: dict[str, int] = {}
        try:
            shutil.rmtree(self._part, ignore_errors=True)  # of one that was killed
            self._part.mkdir(parents=True)
        except OSError as error:
            raise disk_error(error, f"writing {path}") from error

    def add(self, episode: Episode, task: str) -> None:
        """Append one episode.

        Args:
            episode: with the features and cameras of all the others.
            task: what it does, in words.

        Raises:
            RecordError: it is of another robot, has other cameras, or the disk is full.
        """
        self._check(episode)
        number, start = len(self._told), sum(len(each["index"]) for each in self._rows)
        count = len(episode)
        index = {"chunk_index": number // IN_A_CHUNK, "file_index": number % IN_A_CHUNK}
        rows = {
            **{name: feature.values for name, feature in episode.features.items()},
            "timestamp": (np.arange(count) / self._rate).astype(np.float32),
            "frame_index": np.arange(count),
            "episode_index": np.full(count, number),
            "index": np.arange(start, start + count),
            "task_index": np.full(count, self._tasks.setdefault(task, len(self._tasks))),
        }
        told: dict[str, Any] = {"episode_index": number, "tasks": [task], "length": count}
        told |= {"dataset_from_index": start, "dataset_to_index": start + count}
        told |= {"meta/episodes/chunk_index": 0, "meta/episodes/file_index": 0}
        told |= {f"data/{name}": value for name, value in index.items()}
        try:
            self._write(NUMBERS.format(**index), arrow.table({name: _column(values) for name, values in rows.items()}))
            statistics = {name: _statistics(values) for name, values in rows.items()}
            for camera, pictures in episode.pictures.items():
                key = _key(camera)
                seen = self._film(self._part / FILMS.format(video_key=key, **index), camera, pictures)
                self._seen.setdefault(key, []).append(seen)
                statistics[key] = _of_pictures(seen)
                told |= {f"videos/{key}/{name}": value for name, value in index.items()}
                told |= {f"videos/{key}/from_timestamp": 0.0, f"videos/{key}/to_timestamp": count / self._rate}
        except OSError as error:
            raise disk_error(error, f"writing {self._path}") from error
        for name, those in statistics.items():
            told |= {f"stats/{name}/{kind}": value for kind, value in those.items()}
        self._rows.append(rows)
        self._told.append(told)

    def finish(self) -> None:
        """Write what the dataset is, and put it into its folder.

        Raises:
            RecordError: it has no episode, or the disk is full.
        """
        if self._first is None:
            raise RecordError("a dataset has one episode at least")
        whole = {name: np.concatenate([rows[name] for rows in self._rows]) for name in self._rows[0]}
        statistics = {name: _statistics(values) for name, values in whole.items()}
        statistics |= {key: _of_pictures(np.concatenate(seen)) for key, seen in self._seen.items()}
        try:
            self._write(EPISODES, arrow.Table.from_pylist(self._told))
            self._write("meta/tasks.parquet", _indexed(self._tasks))
            for name, content in (("stats", statistics), ("info", self._info(self._first, len(whole["index"])))):
                text = json.dumps(content, indent=4, ensure_ascii=False)
                (self._part / "meta" / f"{name}.json").write_text(text, encoding="utf-8")
            self._part.rename(self._path)
        except OSError as error:
            raise disk_error(error, f"writing {self._path}") from error

    def discard(self) -> None:
        """Leave nothing of a dataset that was not finished; of a finished one it takes nothing."""
        shutil.rmtree(self._part, ignore_errors=True)

    def _check(self, episode: Episode) -> None:
        first = self._first = self._first or episode
        names, asked = ({n: f.names for n, f in each.features.items()} for each in (episode, first))
        if episode.robot != first.robot:
            raise RecordError(f"it is of the robot {episode.robot}, but the first one is of {first.robot}")
        if names != asked:
            raise RecordError(f"the robot {episode.robot} has other joints there than in the first one")
        if set(episode.pictures) != set(first.pictures):
            raise RecordError(
                f"it has pictures of {', '.join(episode.pictures) or 'no camera'}, but the first one of "
                f"{', '.join(first.pictures) or 'none'}: name those that all have with --camera"
            )

    def _write(self, name: str, table: Any) -> None:
        path = self._part / name
        path.parent.mkdir(parents=True, exist_ok=True)
        parquet.write_table(table, path, compression="snappy")

    def _film(self, path: Path, camera: str, pictures: Sequence[Picture | None]) -> np.ndarray:
        """Write a film; black before the first picture.

        Returns:
            (n, 3) uint8 pixels, of which statistics are made.
        """
        size = next(picture for picture in pictures if picture is not None).rgb().shape[:2]
        asked = self._sizes.setdefault(camera, size)
        if size != asked:
            raise RecordError(
                f"pictures of {camera} are {size[1]} x {size[0]}, but the first ones {asked[1]} x {asked[0]}"
            )
        path.parent.mkdir(parents=True, exist_ok=True)
        shown, image = None, np.zeros((*size, 3), np.uint8)
        kept = []
        film = VideoWriter(path, width=size[1], height=size[0], quality=18, keyframe_every=KEYFRAME_EVERY)
        with contextlib.closing(film):
            for k, picture in enumerate(pictures):
                if picture is not None and picture is not shown:
                    shown, image = picture, picture.rgb()
                film.add(k / self._rate, image)
                if k % max(1, len(pictures) // SAMPLES) == 0:
                    kept.append(image[::STRIDE, ::STRIDE].reshape(-1, 3))
        return np.concatenate(kept)

    def _info(self, first: Episode, rows: int) -> dict[str, Any]:
        features: dict[str, Any] = {
            name: {"dtype": "float32", "shape": [len(feature.names)], "names": list(feature.names)}
            for name, feature in first.features.items()
        }
        for camera, (height, width) in self._sizes.items():
            about = {"height": height, "width": width, "codec": "h264", "pix_fmt": "yuv420p", "is_depth_map": False}
            about |= {"fps": self._rate, "channels": 3}
            features[_key(camera)] = {
                "dtype": "video",
                "shape": [height, width, 3],
                "names": ["height", "width", "channels"],
                "info": {**{f"video.{name}": value for name, value in about.items()}, "has_audio": False},
            }
        for name in INDEXES:
            kind = "float32" if name == "timestamp" else "int64"
            features[name] = {"dtype": kind, "shape": [1], "names": None}
        return {
            "codebase_version": VERSION,
            "robot_type": first.robot,
            "total_episodes": len(self._told),
            "total_frames": rows,
            "total_tasks": len(self._tasks),
            "chunks_size": IN_A_CHUNK,
            "data_files_size_in_mb": 100,
            "video_files_size_in_mb": 200,
            "fps": self._rate,
            "splits": {"train": f"0:{len(self._told)}"},
            "data_path": NUMBERS,
            "video_path": FILMS if self._sizes else None,
            "features": features,
        }


def _key(camera: str) -> str:
    return f"observation.images.{camera}"


def _column(values: np.ndarray) -> Any:
    if values.ndim == 1:
        return arrow.array(values)
    return arrow.FixedSizeListArray.from_arrays(arrow.array(values.ravel()), values.shape[1])


def _statistics(values: np.ndarray) -> dict[str, list[Any]]:
    """Of every column of (N, n) or (N,)."""
    columns = values.reshape(len(values), -1).astype(float)
    found = {"min": columns.min(axis=0), "max": columns.max(axis=0)}
    found |= {"mean": columns.mean(axis=0), "std": columns.std(axis=0)}
    found |= dict(zip(QUANTILES, np.quantile(columns, list(QUANTILES.values()), axis=0), strict=True))
    return {**{name: value.tolist() for name, value in found.items()}, "count": [len(columns)]}


def _of_pictures(pixels: np.ndarray) -> dict[str, list[Any]]:
    """Of pixels (n, 3) between 0 and 1, for each colour: (3, 1, 1)."""
    found = _statistics(pixels / 255.0)
    return {name: value if name == "count" else [[[each]] for each in value] for name, value in found.items()}


def _indexed(tasks: dict[str, int]) -> Any:
    """Tasks as a table that pandas reads with the tasks as its index; its own writer is not needed for that."""
    table = arrow.table({"task_index": list(tasks.values()), "task": list(tasks)})
    kinds = (("task_index", "int64"), ("task", "object"))
    about = {
        "index_columns": ["task"],
        "column_indexes": [],
        "columns": [
            {"name": name, "field_name": name, "pandas_type": kind, "numpy_type": kind, "metadata": None}
            for name, kind in kinds
        ],
        "pandas_version": "2.0.0",
    }
    return table.replace_schema_metadata({"pandas": json.dumps(about)})
