"""How near does the robot come to the person?  Every link against every part of the body, both of them capsules."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ..scene.person_spec import ARM_SEGMENTS
from ..segments import segment_distances
from ..world import SIDES
from .unharmed_rows import UnharmedRows


class ArmMotion(Protocol):
    """Where the person's arms were: (T,) [s], (T, 2, 4, 3) [m], (2, 3) [m]."""

    @property
    def t(self) -> np.ndarray:
        """World clock."""
        ...

    @property
    def arms(self) -> np.ndarray:
        """Shoulder, elbow, wrist, fingertip of the left and the right arm."""
        ...

    @property
    def arm_radii(self) -> np.ndarray:
        """Of upper arm, forearm and hand."""
        ...


@dataclass(frozen=True, kw_only=True)
class Clearance:
    """Gaps between robot and person over time.

    Attributes:
        gap: (T, r, q) from the surface of each link to the skin of each part [m], negative inside; infinite for a
            finger and the arm that it holds, one frame before and after too.
        links: (r,) names of the robot's links.
        parts: (q,) names of the person's parts.
    """

    gap: np.ndarray
    links: tuple[str, ...]
    parts: tuple[str, ...]

    @property
    def head(self) -> np.ndarray:
        """(q,) bool, which parts are head or neck."""
        return np.array(["head" in part or "neck" in part for part in self.parts], dtype=bool)

    def least(self, parts: np.ndarray) -> np.ndarray:
        """(T,) gap between the robot and the nearest of `parts` (q,) bool [m]."""
        return self.gap[:, :, parts].min(axis=(1, 2), initial=np.inf)

    def nearest(self, parts: np.ndarray) -> tuple[float, int, str, str]:
        """The smallest gap to `parts` (q,) bool: gap [m], frame, link, part."""
        chosen = np.flatnonzero(parts)
        gap = self.gap[:, :, chosen]
        if not gap.size:
            return np.inf, 0, "", ""
        frame, link, part = (int(k) for k in np.unravel_index(np.argmin(gap), gap.shape))
        return float(gap[frame, link, part]), frame, self.links[link], self.parts[chosen[part]]


def clearance(truth: ArmMotion, rows: UnharmedRows) -> Clearance:
    """Every link against head, neck, trunk, legs and the arms where they are, frame by frame."""
    arms, body, robot = (array.astype(np.float64) for array in (truth.arms, rows.person_capsules, rows.robot_capsules))
    count = len(truth.t)
    # (T, 2 x 3, 2, 3): upper arm, forearm and hand of the left, then of the right arm
    limbs = np.stack([arms[:, :, :-1], arms[:, :, 1:]], axis=3).reshape(count, -1, 2, 3)
    person = np.concatenate([body[..., :6].reshape(count, -1, 2, 3), limbs], axis=1)
    radii = np.concatenate([body[..., 6], np.broadcast_to(truth.arm_radii.reshape(-1), (count, 6))], axis=1)
    links = np.ascontiguousarray(robot[..., :6]).reshape(count, -1, 2, 3)
    gap = np.stack([segment_distances(one, other)[0] for one, other in zip(links, person, strict=True)])
    gap -= robot[..., 6, None] + radii[:, None]

    parts = rows.person_capsule_names + tuple(f"{side}_{segment}" for side in SIDES for segment in ARM_SEGMENTS)
    owner = np.repeat([-1, 0, 1], [len(rows.person_capsule_names), len(ARM_SEGMENTS), len(ARM_SEGMENTS)])
    for k, link in enumerate(rows.robot_capsule_names):
        side = link.split("_")[0]
        if side in SIDES and "finger" in link:
            gap[:, k][_held(rows.holds_arm[:, SIDES.index(side)], owner)] = np.inf
    return Clearance(gap=gap, links=rows.robot_capsule_names, parts=parts)


def _held(holds: np.ndarray, owner: np.ndarray) -> np.ndarray:
    """(T, q) bool, whether a hand that holds the arms `holds` (T,) holds that part, then or in a frame beside it."""
    held = (holds[:, None] == owner) & (owner >= 0)
    beside = held.copy()
    beside[1:] |= held[:-1]
    beside[:-1] |= held[1:]
    return beside
