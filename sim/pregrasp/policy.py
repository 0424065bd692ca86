"""A trained pre-grasp policy in two ONNX files, run by OpenCV alone.

The first network looks at each picture, and the pictures vote on where the corner is.  The second one looks at what
lies around the fingers at each pixel near there, and tells what each primitive comes to.  A grasp and its mirror
image, with left and right exchanged, come to the same; so it is asked of both, and the mean counts.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import CaretreeError
from ..onnx_record import read_properties
from .affordance import seen, votes
from .numbers import DIRECT, PRIMITIVES
from .surroundings import CELLS, surroundings, voted_corner
from .views import Views

FORMAT = "caretree-pregrasp-policy-3"  # 2: logits, and a map of the corner.  3: a network of what fingers take
GRASPS = "grasps.onnx"  # beside the first network's file
TOGETHER = 64  # grasps that the second network is asked of at once
MIRROR = np.array((1.0, -1.0, 1.0), np.float32)  # of a place, left and right of the approach exchanged


class Policy:
    """Both networks, and what is read off them; a state of six pictures costs about 0.1 s on one core.

    Args:
        path: of the first network's file; `GRASPS` lies beside it.

    Attributes:
        record: how it was trained: hash, seed, time, machine.

    Raises:
        CaretreeError: a file is missing, or is no policy in this format.
    """

    def __init__(self, path: str | Path) -> None:
        self._path = Path(path)
        about, self._pictures = read_network(self._path)
        self.record: Mapping[str, Any] = about["record"]
        self._batch: int = about["views"]

    @cached_property
    def _grasps(self) -> tuple[dict[str, Any], Any]:
        return read_network(self._path.with_name(GRASPS))

    def maps(self, views: Views) -> np.ndarray:
        """(n, 4, H, W) logits of n pictures; the network takes a number of its own at once."""
        image = seen(views)
        left = -len(image) % self._batch
        padded = np.concatenate([image, np.zeros((left, *image.shape[1:]), np.float32)])
        parts = []
        for k in range(0, len(padded), self._batch):
            self._pictures.setInput(np.ascontiguousarray(padded[k : k + self._batch]))
            parts.append(np.array(self._pictures.forward()))
        return np.concatenate(parts)[: len(image)]

    def corner(self, views: Views) -> np.ndarray:
        """(3,) where the pictures agree that the corner is, in their frame [m]; some of them must show gown."""
        return voted_corner(votes(self.maps(views), views), views.places()[0])

    def values(self, views: Views) -> np.ndarray:
        """(n, 3, H, W) value of each action, -inf where none is thought of: off the gown, and far from the corner.

        A policy that was trained on direct grasps alone thinks of no others.
        """
        values = np.full((len(views.depth), len(PRIMITIVES), *views.depth.shape[1:]), -np.inf)
        places, spots = views.places()
        if not len(places):
            return values
        corner = self.corner(views)
        spots = spots[np.linalg.norm(places - corner, axis=1) < CELLS.reach]
        cells, corners = surroundings(views, corner, spots)
        view, row, column = spots.T
        mirrored = self._taken(np.ascontiguousarray(cells[..., ::-1]), corners * MIRROR)[:, ::-1]
        values[view, :, row, column] = (self._taken(cells, corners) + mirrored) / 2
        if self.record.get("grasp_only", False):
            values[:, [k for k in range(len(PRIMITIVES)) if k != DIRECT]] = -np.inf
        return values

    def _taken(self, cells: np.ndarray, corners: np.ndarray) -> np.ndarray:
        """(n, 3) logits of success, of what `surroundings` gives."""
        found = []
        for k in range(0, len(cells), TOGETHER):
            part = {"cells": cells[k : k + TOGETHER], "corners": corners[k : k + TOGETHER]}
            for name, given in part.items():
                whole = np.zeros((TOGETHER, *given.shape[1:]), np.float32)
                whole[: len(given)] = given
                self._grasps[1].setInput(whole, name)
            found.append(np.array(self._grasps[1].forward())[: len(part["cells"])])
        return np.concatenate(found)

    def confidence(self, value: float) -> float:
        """Chance that the action of the highest value succeeds, 0 to 1, by that value."""
        scale, shift = self._grasps[0]["calibration"]
        return float(1.0 / (1.0 + np.exp(-np.clip(scale * value + shift, -50.0, 50.0))))


def read_network(path: Path) -> tuple[dict[str, Any], Any]:
    """What a file says about itself, and its network."""
    import cv2

    try:
        about = {name: json.loads(text) for name, text in read_properties(path).items()}
        if about["format"] != FORMAT:
            raise ValueError(about["format"])
        return about, cv2.dnn.readNetFromONNX(str(path))
    except (CaretreeError, KeyError, ValueError, cv2.error) as error:
        raise CaretreeError(f"{path}: this is no pre-grasp policy in format {FORMAT}") from error
