"""What the cameras saw, and what perception made of it: kept for the moments at which something failed."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ...perception.estimates import ArmPosture, Estimate
from ...perception.senses import Senses
from ...sim.record.record import LOOKS_FOLDER
from ...sim.record.spool import disk_error
from ...sim.world import Frame

INDEX = "looks.jsonl"
LOOKS_MAX = 60  # of one run: a picture has 30 kB
POINTS_MAX = 60  # drawn of one estimate
QUALITY = 88  # of the JPEG


@dataclass(frozen=True)
class Finding:
    """One answer of perception.

    Attributes:
        asked: name of the method of `Senses`.
        words: what it answered, or why it did not.
        found: whether it answered.
        marks: name of a part -> (n, 2) where that is in the picture [px].
    """

    asked: str
    words: str
    found: bool
    marks: Mapping[str, np.ndarray] = field(default_factory=dict)


@dataclass(frozen=True)
class Look:
    """One picture and what was found in it.

    Attributes:
        t: world clock [s].
        camera: that took it.
        rgb: (H, W, 3) uint8.
        findings: in the order in which they were asked for.
        node: path of the node that failed after it; empty while nothing has.
    """

    t: float
    camera: str
    rgb: np.ndarray
    findings: tuple[Finding, ...] = ()
    node: str = ""


class Witness:
    """Remembers the last picture of each camera that something was asked of, with the answers.

    Args:
        on_arm: told of every arm that was seen.

    Attributes:
        looks: by camera.
    """

    def __init__(self, on_arm: Callable[[ArmPosture], None] = lambda arm: None) -> None:
        self.looks: dict[str, Look] = {}
        self._on_arm = on_arm
        self._newest: Look | None = None

    def watch(self, senses: Senses) -> Senses:
        """Senses that answer as `senses` do, in front of this witness."""
        return _watched(senses, self.note)

    def note(self, asked: str, frame: Frame, answer: object) -> None:
        """Remember an answer, an `Estimate` or the error that came instead."""
        if isinstance(answer, ArmPosture):
            self._on_arm(answer)
        before = self.looks.get(frame.camera)
        known = before.findings if before is not None and before.t == frame.stamp else ()
        finding = finding_of(asked, frame, answer)
        told = any((each.asked, each.words) == (finding.asked, finding.words) for each in known)
        self._newest = Look(frame.stamp, frame.camera, frame.rgb, known if told else (*known, finding))
        self.looks[frame.camera] = self._newest

    def since(self, time: float) -> Look | None:
        """The last look, unless it is older than `time` [s]."""
        return self._newest if self._newest is not None and self._newest.t >= time - 1e-9 else None


def finding_of(asked: str, frame: Frame, answer: object) -> Finding:
    """An answer in words and marks; all its points in the map are marked where they are in the picture."""
    if isinstance(answer, BaseException):
        return Finding(asked, str(answer) or type(answer).__name__, False)
    words, marks = [], {}
    if is_dataclass(answer):
        for each in fields(answer):
            value = getattr(answer, each.name)
            if each.name.endswith(
                ("points_in_map", "position_in_map", "centre_in_map", "corner_in_map", "crown_in_map")
            ):
                marks[each.name.removesuffix("_in_map")] = pixels_of(
                    frame, np.reshape(value, (-1, 3))[:: _every(value)]
                )
            elif isinstance(value, (bool, int, str)):
                words.append(f"{each.name} {value}")
            elif isinstance(value, float) and each.name != "stamp":
                words.append(f"{each.name} {value:.2f}")
    return Finding(asked, ", ".join(words), isinstance(answer, Estimate), marks)


def _every(points: np.ndarray) -> int:
    return max(1, np.size(points) // 3 // POINTS_MAX)


def pixels_of(frame: Frame, points_in_map: np.ndarray) -> np.ndarray:
    """(m, 2) where those of `points_in_map` (n, 3) that lie before the camera are in its picture [px]."""
    pose = frame.pose_camera_in_map
    local = (points_in_map - pose[:3, 3]) @ pose[:3, :3]
    local = local[local[:, 2] > 0.01]
    fx, fy, cx, cy = frame.intrinsics
    return np.column_stack([fx * local[:, 0] / local[:, 2] + cx, fy * local[:, 1] / local[:, 2] + cy])


def _watched(senses: Senses, tell: Callable[[str, Frame, object], None]) -> Senses:
    """An object of a class of its own: every method of `Senses` passes the question on and tells the answer."""

    def passed_on(name: str) -> Callable[..., object]:
        def ask(self: object, frame: Any, *args: Any, **options: Any) -> object:
            newest = frame[-1] if isinstance(frame, Sequence) and frame else frame
            try:
                answer = getattr(senses, name)(frame, *args, **options)
            except Exception as error:
                _told(tell, name, newest, error)
                raise
            _told(tell, name, newest, answer)
            return answer

        return ask

    methods: dict[str, Any] = {name: passed_on(name) for name in Senses.__abstractmethods__}
    methods["__getattr__"] = lambda self, name: getattr(senses, name)  # what they offer beyond the contract
    return type("WatchedSenses", (Senses,), methods)()


def _told(tell: Callable[[str, Frame, object], None], name: str, frame: object, answer: object) -> None:
    """Nobody who looks on may keep a skill from its answer."""
    if isinstance(frame, Frame):
        try:
            tell(name, frame, answer)
        except Exception:  # the picture is then missing from the report
            return


class LookLog:
    """Writes, for each skill that fails, what it saw last.

    Args:
        directory: of the record.
        witness: of the run.
    """

    def __init__(self, directory: Path, witness: Witness) -> None:
        self._directory, self._witness = directory, witness
        self._began: dict[str, float] = {}
        self._count = 0

    def event(self, event: Mapping[str, Any]) -> None:
        """Hear of one event of the trace.

        Raises:
            RecordError: the picture cannot be written.
        """
        node, status = event.get("node"), event.get("status")
        if event.get("kind") != "node" or not isinstance(node, str):
            return
        if status == "RUNNING":
            self._began.setdefault(node, float(event["t"]))
            return
        began = self._began.pop(node, float(event["t"]))
        if status == "FAILURE" and event.get("reason") and self._count < LOOKS_MAX:
            look = self._witness.since(began)
            if look is not None:
                self._write(look, node, float(event["t"]))

    def _write(self, look: Look, node: str, t: float) -> None:
        try:
            import cv2
        except ModuleNotFoundError:  # then no page is drawn either, which these pictures are for
            return

        folder, self._count = self._directory / LOOKS_FOLDER, self._count + 1
        line = {
            "t": t,
            "seen": look.t,
            "node": node,
            "camera": look.camera,
            "file": f"{LOOKS_FOLDER}/{self._count:03d}.jpg",
            "findings": [
                {
                    "asked": each.asked,
                    "words": each.words,
                    "found": each.found,
                    "marks": {name: np.round(points, 1).tolist() for name, points in each.marks.items()},
                }
                for each in look.findings
            ],
        }
        _, jpeg = cv2.imencode(".jpg", look.rgb[:, :, ::-1], [cv2.IMWRITE_JPEG_QUALITY, QUALITY])
        try:
            folder.mkdir(exist_ok=True)
            (self._directory / line["file"]).write_bytes(jpeg.tobytes())
            with (folder / INDEX).open("a", encoding="utf-8", errors="backslashreplace") as index:
                index.write(json.dumps(line) + "\n")
        except OSError as error:
            raise disk_error(error, f"writing {folder}") from error


def read_looks(directory: Path) -> list[Look]:
    """What was kept of a run, in order; damaged entries are left out."""
    import cv2

    looks = []
    try:
        lines = (directory / LOOKS_FOLDER / INDEX).read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError):
        return []
    for line in lines:
        try:
            entry = json.loads(line)
            picture = cv2.imdecode(
                np.frombuffer((directory / LOOKS_FOLDER / Path(entry["file"]).name).read_bytes(), np.uint8), 1
            )
            findings = tuple(
                Finding(
                    str(each["asked"]),
                    str(each["words"]),
                    bool(each["found"]),
                    {str(name): np.reshape(np.array(points, float), (-1, 2)) for name, points in each["marks"].items()},
                )
                for each in entry["findings"]
            )
            if picture is None:
                continue
            look = Look(float(entry["t"]), str(entry["camera"]), picture[:, :, ::-1], findings, str(entry["node"]))
        except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError, cv2.error):
            continue
        looks.append(look)
    return looks


def drawn(look: Look, scale: int = 2) -> np.ndarray:
    """The picture (scale * H, scale * W, 3) uint8 with what was found marked and named."""
    import cv2

    size = (scale * look.rgb.shape[1], scale * look.rgb.shape[0])
    picture = np.ascontiguousarray(cv2.resize(np.ascontiguousarray(look.rgb), size, interpolation=cv2.INTER_LINEAR))
    for k, each in enumerate(look.findings):
        colour = COLOURS[k % len(COLOURS)]
        for name, points in each.marks.items():
            places = [
                (int(scale * x), int(scale * y))
                for x, y in points
                if np.isfinite((x, y)).all() and abs(x) + abs(y) < 1e5
            ]
            if name == "points" and len(places) > 1:
                cv2.polylines(picture, [np.array(places, np.int32)], False, colour, 2, cv2.LINE_AA)
            for place in places:
                cv2.circle(
                    picture, place, 3 if len(places) > 1 else 7, colour, -1 if len(places) > 1 else 2, cv2.LINE_AA
                )
            if places:
                at = (places[0][0] + 9, places[0][1] - 7)
                words = f"{each.asked.replace('_', ' ')}: {name.replace('_', ' ')}"
                for ink, width in (((20, 20, 20), 3), (colour, 1)):
                    cv2.putText(picture, words, at, cv2.FONT_HERSHEY_SIMPLEX, 0.5, ink, width, cv2.LINE_AA)
    return picture


COLOURS = ((255, 214, 10), (64, 224, 255), (255, 120, 220), (140, 255, 120))
