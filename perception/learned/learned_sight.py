"""Estimates from what the network sees, in the types of the other senses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame, Side
from ..errors import PerceptionFailure, Problem
from ..estimates import CORNER_OF, SLEEVE_OF, ArmPosture, GownSide, GraspPoint, GraspTarget
from ..image.cloud import unit
from ..image.surfaces import Surface
from .sight import KeyPoint, SeeingNetwork, Sight, packaged_hand_network, packaged_network

JOINTS = ("shoulder", "elbow", "wrist", "fingertip")


@dataclass(frozen=True, kw_only=True)
class LearnedTuning(Quantities):
    """Numbers of the estimates."""

    min_confidence: float = quantity(0.5, "1", "in a key point that counts as seen", "choice: more likely than not")
    min_fabric_pixels: int = quantity(50, "1", "of fabric from which the side is told", "choice: less is an edge")
    joint_deviation: float = quantity(0.05, "m", "of a joint that is certain", "design requirement: 5 cm covered")


DEFAULT = LearnedTuning()


class LearnedSight:
    """Estimates of single frames.

    Args:
        network: that sees; if omitted the packaged ones, one for the head's camera and one for the hands'.
        bed_in_map: (2, 3) its lower and upper corner, where one is known [m].
        tuning: numbers.
    """

    def __init__(
        self,
        network: SeeingNetwork | None = None,
        *,
        bed_in_map: np.ndarray | None = None,
        tuning: LearnedTuning = DEFAULT,
    ) -> None:
        self._network = network
        self._bed = bed_in_map
        self._tuning = tuning
        self._last: tuple[Frame, Sight] | None = None

    def sight(self, frame: Frame) -> Sight:
        """All that is seen; asked twice for one frame, the network runs once."""
        if self._last is None or self._last[0] is not frame:
            network = self._network or (packaged_network() if frame.camera == "head" else packaged_hand_network())
            self._last = (frame, network.see(frame, self._bed))
        return self._last[1]

    def gown_side(self, frame: Frame) -> GownSide:
        """By the area of either side of the fabric.

        Raises:
            PerceptionFailure: no fabric is seen.
        """
        surfaces = self.sight(frame).surfaces
        outside, inside = int((surfaces == Surface.OUTSIDE).sum()), int((surfaces == Surface.INSIDE).sum())
        if outside + inside < self._tuning.min_fabric_pixels:
            raise PerceptionFailure(Problem.NOTHING_SEEN, "fabric of the gown")
        share = abs(outside - inside) / (outside + inside)
        return GownSide(stamp=frame.stamp, confidence=share, outside=outside > inside)

    def hook(self, frame: Frame) -> GraspPoint:
        """Where the gown hangs.

        Raises:
            PerceptionFailure: it is not seen.
        """
        return self._grasp(frame, "hook", "near_hang")

    def corner(self, frame: Frame, side: Side) -> GraspPoint:
        """One end of the neckline.

        Raises:
            PerceptionFailure: it is not seen.
        """
        return self._grasp(frame, f"corner_{side}", CORNER_OF[side])

    def strap(self, frame: Frame, side: Side) -> GraspPoint:
        """The middle of the strap above an armhole.

        Raises:
            PerceptionFailure: it is not seen.
        """
        return self._grasp(frame, f"strap_{side}", SLEEVE_OF[side])

    def arm(self, frame: Frame, side: Side) -> ArmPosture:
        """One arm, bare or covered.

        Raises:
            PerceptionFailure: a joint is not in the picture.
        """
        seen = self.sight(frame).key_points
        joints = [self._sure(seen[f"{joint}_{side}"], f"{side} {joint}") for joint in JOINTS]
        confidence = np.array([joint.confidence for joint in joints])
        return ArmPosture(
            stamp=frame.stamp,
            confidence=float(confidence.min()),
            side=side,
            points_in_map=np.array([joint.position_in_map for joint in joints]),
            deviation=self._tuning.joint_deviation / np.maximum(confidence, self._tuning.min_confidence),
        )

    def _sure(self, seen: KeyPoint, what: str) -> KeyPoint:
        if seen.confidence < self._tuning.min_confidence:
            raise PerceptionFailure(Problem.NOTHING_SEEN, what)
        if seen.position_in_map is None:
            raise PerceptionFailure(Problem.NO_DEPTH, what)
        return seen

    def _grasp(self, frame: Frame, name: str, target: GraspTarget) -> GraspPoint:
        seen = self._sure(self.sight(frame).key_points[name], name.replace("_", " "))
        assert seen.position_in_map is not None
        approach = unit((seen.position_in_map - frame.pose_camera_in_map[:3, 3]) * (1.0, 1.0, 0.0))
        return GraspPoint(
            stamp=frame.stamp,
            confidence=seen.confidence,
            target=target,
            position_in_map=seen.position_in_map,
            approach_in_map=approach,
            closing_in_map=np.array((-approach[1], approach[0], 0.0)),
        )
