"""Ways of seeing, as `caretree learn vision evaluate` compares them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from ...perception.classical import ClassicalSenses
from ...perception.errors import PerceptionFailure
from ...perception.image.surfaces import surfaces
from ...perception.learned.learned_sight import DEFAULT, JOINTS, LearnedSight
from ...perception.learned.sight import SeeingNetwork
from ...sim.world import Frame, RoomMap, Side

Found = tuple[np.ndarray, float]


class LearnedSeer:
    """The network.

    Args:
        network: its file, for every camera; None takes the packaged ones.
    """

    def __init__(self, network: Path | None = None) -> None:
        self._sight = LearnedSight(SeeingNetwork(network) if network else None, bed_in_map=_room().bed)

    def surfaces(self, frame: Frame) -> np.ndarray:
        """(H, W)."""
        return self._sight.sight(frame).surfaces

    def confidence(self, frame: Frame) -> np.ndarray:
        """(H, W)."""
        return self._sight.sight(frame).confidence

    def sheet(self, frame: Frame) -> np.ndarray:
        """(H, W, 3) [m]."""
        return self._sight.sight(frame).sheet

    def corner(self, frame: Frame, side: Side, hook_in_map: np.ndarray | None) -> Found | None:
        """It needs no hook."""
        try:
            found = self._sight.corner(frame, side)
        except PerceptionFailure:
            return None
        return found.position_in_map, found.confidence

    def strap(self, frame: Frame, side: Side, near_in_map: np.ndarray) -> Found | None:
        """It need not be told where."""
        try:
            found = self._sight.strap(frame, side)
        except PerceptionFailure:
            return None
        return found.position_in_map, found.confidence

    def arm(self, frame: Frame, side: Side) -> tuple[np.ndarray, np.ndarray]:
        """Every joint by itself; one that is not sure is left out."""
        seen = [self._sight.sight(frame).key_points[f"{joint}_{side}"] for joint in JOINTS]
        sure = np.array([s.position_in_map is not None and s.confidence >= DEFAULT.min_confidence for s in seen])
        return np.array([np.zeros(3) if s.position_in_map is None else s.position_in_map for s in seen]), sure

    def key_points(self, frame: Frame) -> Mapping[str, Found]:
        """All that have a place."""
        seen = self._sight.sight(frame).key_points
        return {name: (s.position_in_map, s.confidence) for name, s in seen.items() if s.position_in_map is not None}


class ClassicalSeer:
    """Colours, edges and depth; fresh for every frame, as it tracks otherwise."""

    def __init__(self) -> None:
        self._room = _room()
        self._senses = ClassicalSenses(self._room, 0)

    def surfaces(self, frame: Frame) -> np.ndarray:
        """(H, W)."""
        return surfaces(frame.rgb)

    def confidence(self, frame: Frame) -> None:
        """It has none."""

    def sheet(self, frame: Frame) -> None:
        """It knows of none."""

    def corner(self, frame: Frame, side: Side, hook_in_map: np.ndarray | None) -> Found | None:
        """Only of a gown that hangs on its hook."""
        if hook_in_map is None:
            return None
        try:
            found = self._senses.shown_corner(frame, hook_in_map=hook_in_map, side=side)
        except PerceptionFailure:
            return None
        return found.position_in_map, found.confidence

    def strap(self, frame: Frame, side: Side, near_in_map: np.ndarray) -> Found | None:
        """Near the place that it is told."""
        try:
            found = self._senses.sleeve_strap(frame, side=side, near_in_map=near_in_map)
        except PerceptionFailure:
            return None
        return found.position_in_map, found.confidence

    def arm(self, frame: Frame, side: Side) -> tuple[np.ndarray, np.ndarray] | None:
        """By a tracker that has seen nothing before."""
        try:
            found = ClassicalSenses(self._room, 0).arm(frame, side=side)
        except PerceptionFailure:
            return None
        return found.points_in_map, np.ones(4, bool)

    def key_points(self, frame: Frame) -> Mapping[str, Found]:
        """Its confidences are of other things."""
        return {}


def _room() -> RoomMap:
    """A map with the bed alone: where it stands was measured beforehand."""
    bed = np.array(((-0.5, -1.0, 0.48), (0.5, 1.0, 0.60)))
    return RoomMap(free=np.zeros((1, 1), bool), origin=np.zeros(2), resolution=1.0, bed=bed)
