"""What the network says about one frame, and how it is read: surfaces, places on the gown's sheet, key points."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from ...sim.errors import CaretreeError
from ...sim.onnx_record import read_properties
from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame
from ..image.surfaces import GOWN_SURFACES, Surface

FORMAT = "caretree-seeing-3"
BEFORE = "caretree-seeing-2"  # was not told where over the bed a pixel is
BED_MARGIN = 0.6  # beyond the bed's outline, within which a pixel is told where over the bed it is [m]
_WEIGHTS = Path(__file__).parent / "weights"
PACKAGED = _WEIGHTS / "seeing.onnx"
PACKAGED_HAND = _WEIGHTS / "seeing_hand.onnx"  # of the hands' cameras: trained on from the other, on what these see
_OUTPUTS = ("surface", "sheet", "heat", "offset")
_SOLID = (*GOWN_SURFACES, Surface.SKIN)  # what a key point can lie on


@dataclass(frozen=True, kw_only=True)
class SightTuning(Quantities):
    """Numbers of how the network's maps are read."""

    peak_cells: int = quantity(
        1, "1", "to each side of a peak, whose mean is the key point's place", "choice: its width"
    )
    search_cells: int = quantity(2, "1", "to each side of a peak, where a depth is looked for", "choice: 8 pixels")


DEFAULT = SightTuning()


@dataclass(frozen=True, kw_only=True)
class KeyPoint:
    """A key point as it is seen.

    Attributes:
        confidence: that it is there, 0 to 1.
        position_in_map: (3,) [m]; None where nothing around it has a depth.
        pixel: (2,) u and v in the frame [px].
    """

    confidence: float
    position_in_map: np.ndarray | None
    pixel: np.ndarray


@dataclass(frozen=True, kw_only=True)
class Sight:
    """What is seen in one frame.

    Attributes:
        surfaces: (H, W) uint8 of `Surface`, at the frame's size.
        confidence: (H, W) float32 in that, 0 to 1.
        sheet: (H, W, 3) float32, where on the gown's rest shape a pixel is, if it is of the gown [m].
        key_points: by name, such as `corner_left`, `strap_right`, `hook`, `elbow_left`.
        heat: by name, (h, w) scores of a key point's being in a cell of the picture, beside 0 for its being in none.
    """

    surfaces: np.ndarray
    confidence: np.ndarray
    sheet: np.ndarray
    key_points: dict[str, KeyPoint]
    heat: dict[str, np.ndarray] = field(default_factory=dict)


class SeeingNetwork:
    """The trained network; one picture costs about 20 ms on one core.

    Args:
        path: of the ONNX file.
        tuning: numbers.

    Attributes:
        record: how it was trained: hash, seed, time, machine.

    Raises:
        CaretreeError: the file is missing, is no such network, or sees other surfaces than this version knows.
    """

    def __init__(self, path: str | Path = PACKAGED, *, tuning: SightTuning = DEFAULT) -> None:
        import cv2

        about = {name: json.loads(text) for name, text in read_properties(path).items()}
        if about.get("format") not in (FORMAT, BEFORE):
            raise CaretreeError(f"{path}: this is no seeing network in format {FORMAT}")
        if about["surfaces"] != [surface.name.lower() for surface in Surface]:
            raise CaretreeError(f"{path}: it sees {', '.join(about['surfaces'])}, which this version does not know")
        self.record: Mapping[str, Any] = about["record"]
        self._knows_bed: bool = about["format"] == FORMAT
        self._size: tuple[int, int] = (about["size"][0], about["size"][1])
        self._names: list[str] = about["key_points"]
        self._sheet_nodes = [np.asarray(axis, np.float32) for axis in about["sheet_nodes"]]
        self._calibration: dict[str, list[float]] = about.get("calibration", {})
        self._temperature = float(about.get("temperature", 1.0))
        self._net = cv2.dnn.readNetFromONNX(str(path))
        self._tuning = tuning

    def see(self, frame: Frame, bed_in_map: np.ndarray | None = None) -> Sight:
        """What one frame shows.

        Args:
            frame: of any camera.
            bed_in_map: (2, 3) its lower and upper corner, where one is known [m].
        """
        import cv2

        image = self.image_of(frame, bed_in_map)
        self._net.setInput(image[None])
        surface, sheet, heat, offset = (map_[0] for map_ in self._net.forward(_OUTPUTS))
        scores = surface / self._temperature
        chance = np.exp(scores - scores.max(axis=0))
        chance /= chance.sum(axis=0)
        labels = chance.argmax(axis=0).astype(np.uint8)
        full = frame.depth.shape[::-1]
        # borders fall between the network's pixels: what is likely is blended, and not what was decided
        surfaces, confidence = _likeliest([cv2.resize(each, full, interpolation=cv2.INTER_LINEAR) for each in chance])
        places = places_on_sheet(sheet, self._sheet_nodes)
        solid = np.isin(labels, _SOLID) & (image[3] > 0)
        return Sight(
            surfaces=surfaces,
            confidence=confidence,
            sheet=cv2.resize(np.ascontiguousarray(places), full, interpolation=cv2.INTER_LINEAR),
            key_points={
                name: self._key_point(
                    frame, heat[k], offset[k], image[3], solid, self._calibration.get(name.split("_")[0])
                )
                for k, name in enumerate(self._names)
            },
            heat=dict(zip(self._names, heat, strict=True)),
        )

    def image_of(self, frame: Frame, bed_in_map: np.ndarray | None = None) -> np.ndarray:
        """(8, h, w) float32 that the network is given, or the first five of it to one that knows no bed.

        Red, green, blue, depth [m], height over the floor [m], across and along the bed from its middle [m], and 1
        where these two are told: over the bed and a margin around it.

        Args:
            frame: of any camera.
            bed_in_map: (2, 3) its lower and upper corner, where one is known [m].
        """
        import cv2

        width, height = self._size
        fx, fy, cx, cy = frame.intrinsics
        small = cv2.resize(frame.rgb, self._size, interpolation=cv2.INTER_AREA)
        rows = ((np.arange(height) + 0.5) * frame.depth.shape[0] / height).astype(int)
        columns = ((np.arange(width) + 0.5) * frame.depth.shape[1] / width).astype(int)
        z = frame.depth[np.ix_(rows, columns)]
        x, y, level = (
            z * ((columns - cx) / fx * axis[0] + ((rows - cy) / fy * axis[1])[:, None] + axis[2]) + axis[3]
            for axis in frame.pose_camera_in_map[:3]
        )
        told = [small.transpose(2, 0, 1), z[None], np.where(z > 0, level, 0.0)[None]]
        if self._knows_bed:
            told.append(_over_bed(x, y, z > 0, bed_in_map))
        return np.concatenate(told).astype(np.float32)

    def _key_point(
        self,
        frame: Frame,
        heat: np.ndarray,
        offset: np.ndarray,
        depth: np.ndarray,
        solid: np.ndarray,
        calibration: list[float] | None,
    ) -> KeyPoint:
        """Read one key point off its maps (h, w)."""
        row, column = divmod(int(heat.argmax()), heat.shape[1])
        rows, columns = _around(row, column, heat.shape, self._tuning.peak_cells)
        near = np.ix_(rows, columns)
        chance, score = peak_of_all(heat, near)
        weight = chance[near]
        scale, shift = calibration or (1.0, 0.0)
        cell = np.array((weight.sum(axis=0) @ columns, weight.sum(axis=1) @ rows)) / weight.sum()
        step = depth.shape[0] / heat.shape[0]
        full = np.array(frame.depth.shape[::-1]) / depth.shape[::-1]
        pixel = ((cell + 0.5) * step) * full - 0.5
        rows, columns = _around(row, column, heat.shape, self._tuning.search_cells)
        at = np.ix_((rows * step + step // 2).astype(int), (columns * step + step // 2).astype(int))
        weight = solid[at] * chance[np.ix_(rows, columns)]
        place = None
        if weight.sum() > 0:
            z = float((weight * (depth[at] + offset[np.ix_(rows, columns)])).sum() / weight.sum())
            fx, fy, cx, cy = frame.intrinsics
            local = np.array(((pixel[0] - cx) / fx, (pixel[1] - cy) / fy, 1.0)) * z
            place = frame.pose_camera_in_map[:3, :3] @ local + frame.pose_camera_in_map[:3, 3]
        return KeyPoint(
            confidence=float(1.0 / (1.0 + np.exp(-(scale * score + shift)))), position_in_map=place, pixel=pixel
        )


def _likeliest(chances: Sequence[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """(H, W) uint8 which of some (H, W) maps is greatest, and that; map by map is four times as fast as `argmax`."""
    best, which = chances[0].copy(), np.zeros(chances[0].shape, np.uint8)
    for k, chance in enumerate(chances[1:], 1):
        which[chance > best] = k
        np.maximum(best, chance, out=best)
    return which, best


def _over_bed(x: np.ndarray, y: np.ndarray, there: np.ndarray, bed_in_map: np.ndarray | None) -> np.ndarray:
    """(3, h, w) across and along the bed from its middle [m], and 1 where they are told; else 0."""
    if bed_in_map is None:
        return np.zeros((3, *there.shape))
    low, high = bed_in_map[:, :2]
    across, along = x - (low[0] + high[0]) / 2, y - (low[1] + high[1]) / 2
    half = (high - low) / 2 + BED_MARGIN
    return np.stack([across, along, np.ones_like(x)]) * (there & (np.abs(across) < half[0]) & (np.abs(along) < half[1]))


def places_on_sheet(scores: np.ndarray, nodes: Sequence[np.ndarray]) -> np.ndarray:
    """(h, w, 3) places [m] from scores (S, h, w) of every axis's nodes: the mean of the best one and its neighbours.

    The mean of all nodes would be between the two where left and right are alike.
    """
    found, first = [], 0
    for axis in nodes:
        mine = scores[first : first + len(axis)]
        first += len(axis)
        best = np.clip(mine.argmax(axis=0), 1, len(axis) - 2)
        three = best + np.arange(-1, 2)[:, None, None]
        near = np.take_along_axis(mine, three, 0)
        weight = np.exp(near - near.max(axis=0))
        found.append((weight * axis[three]).sum(axis=0) / weight.sum(axis=0))
    return np.stack(found, axis=2).astype(np.float32)


def peak_of_all(heat: np.ndarray, near: tuple[np.ndarray, ...]) -> tuple[np.ndarray, float]:
    """Chances (h, w) where the cells compete with each other and with nowhere, whose score is 0; and a peak's log odds.

    Args:
        heat: (h, w) scores.
        near: the peak and the cells beside it, as `numpy.ix_` gives them.
    """
    top = max(float(heat.max()), 0.0)
    chance = np.exp(heat.astype(float) - top)
    here, all_ = float(chance[near].sum()), float(chance.sum() + np.exp(-top))
    return chance, float(np.log(here + 1e-9) - np.log(all_ - here + 1e-9))


def _around(row: int, column: int, shape: tuple[int, ...], by: int) -> tuple[np.ndarray, np.ndarray]:
    """Rows and columns up to `by` from a cell."""
    return (
        np.arange(max(row - by, 0), min(row + by + 1, shape[0])),
        np.arange(max(column - by, 0), min(column + by + 1, shape[1])),
    )


@lru_cache
def packaged_network() -> SeeingNetwork:
    """The network that the package ships, loaded once."""
    return SeeingNetwork()


@lru_cache
def packaged_hand_network() -> SeeingNetwork:
    """The one for the cameras of hands, loaded once."""
    return SeeingNetwork(PACKAGED_HAND)
