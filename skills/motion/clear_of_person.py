"""Are the arms free: clear of the robot, of boxes in the room, and of the person as it is tracked now?"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ...sim.robot.capsules import RobotCapsules
from ...sim.robot.collision import CollisionChecker
from ...sim.world import Side
from ..geometry.clearance import LinkClearance
from ..geometry.person_zone import PersonZone


class ClearOfPerson(CollisionChecker):
    """A collision checker that also keeps all links off the person.

    Args:
        checker: of the arms against the robot and the room.
        links: of the robot.
        zone: where the person is.
        held: hand -> the arm that it holds, which its fingers and palm may touch.
        gripper_opening: (2,) of the hands while they move [m].
    """

    def __init__(
        self,
        checker: CollisionChecker,
        links: RobotCapsules,
        zone: PersonZone,
        held: Mapping[Side, str],
        gripper_opening: np.ndarray,
    ) -> None:
        self._opening = gripper_opening
        self._checker, self._links, self._zone, self._held = checker, links, zone, held
        self._clearance = LinkClearance(links.names, links.radii)

    def free(self, pose_base_in_map: np.ndarray, arm_positions: np.ndarray, head_pan: float = 0.0) -> bool:
        """Whether arms (2, 7) at these angles touch nothing and come too near to nobody."""
        room = self._room(pose_base_in_map, arm_positions, head_pan)
        return not (room < 0.0).any() and self._checker.free(pose_base_in_map, arm_positions, head_pan)

    def collisions(
        self, pose_base_in_map: np.ndarray, arm_positions: np.ndarray, head_pan: float = 0.0
    ) -> list[tuple[str, str]]:
        """Names of all pairs that are too close, for a message."""
        room = self._room(pose_base_in_map, arm_positions, head_pan)
        near = [
            (self._links.names[link], f"the person's {self._zone.names[part]}")
            for link, part in np.argwhere(room < 0.0)
        ]
        return [*dict.fromkeys(near), *self._checker.collisions(pose_base_in_map, arm_positions, head_pan)]

    def _room(self, base: np.ndarray, arms: np.ndarray, head_pan: float) -> np.ndarray:
        ends = self._links.ends(base, arms, head_pan, self._opening)
        return self._clearance.room(ends, self._zone, self._held, planned=True)[0]
