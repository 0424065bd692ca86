"""Are the arms free: clear of the robot, of boxes in the room, and of the person as it is tracked now?"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from ...sim.mechanics.capsules import RobotCapsules
from ...sim.mechanics.collision import EPSILON, CollisionChecker, Contacts
from ...sim.segments import any_nearer
from ...sim.world import Observation, Side
from ..geometry.clearance import CLEARANCE, LinkClearance
from ..geometry.person_zone import PersonZone


class ClearOfPerson(CollisionChecker):
    """A collision checker that also keeps all links off the person.

    A link that is too near where the motion begins may stay as near, but come no nearer.

    Args:
        checker: of the arms against the robot and the room.
        links: of the robot.
        zone: where the person is.
        held: hand -> the arm that it holds, which its fingers and palm may touch.
        begins: where the motion begins, with the fingers and the head as they stay.
    """

    def __init__(
        self,
        checker: CollisionChecker,
        links: RobotCapsules,
        zone: PersonZone,
        held: Mapping[Side, str],
        begins: Observation,
    ) -> None:
        self.robot = checker.robot
        self._checker, self._links, self._zone = checker, links, zone
        self._gaps = LinkClearance(links.names, links.radii).least_gaps(zone.names, held, planned=True)
        self._opening, self.head_pan = begins.gripper_opening, begins.head_pan
        room = self._room(begins.pose_base_in_map, begins.arm_positions, begins.head_pan)
        self._least = np.minimum(room, 0.0) - EPSILON
        self._least_gaps = self._gaps + np.minimum(room, CLEARANCE.planned) - EPSILON

    def free(
        self,
        pose_base_in_map: np.ndarray,
        arm_positions: np.ndarray,
        head_pan: float | None = None,
        *,
        leaving: Contacts | None = None,
    ) -> bool:
        """Whether arms (2, n) at these angles touch nothing and come near nobody, with room for a smooth motion."""
        pan = self.head_pan if head_pan is None else head_pan
        ends = self._links.ends(pose_base_in_map, arm_positions, pan, self._opening)
        return not self._near_person(ends) and self._checker.free(pose_base_in_map, arm_positions, pan, leaving=leaving)

    def free_along(
        self, pose_base_in_map: np.ndarray, postures: np.ndarray, head_pan: float | None = None
    ) -> Iterator[bool]:
        """What `free` says of each of the postures (k, 2, n) of a motion [rad], at least one, in turn."""
        pan = self.head_pan if head_pan is None else head_pan
        way = self._links.ends_along(pose_base_in_map, postures, pan, self._opening)
        for ends, free in zip(way, self._checker.free_along(pose_base_in_map, postures, pan), strict=True):
            yield free and not self._near_person(ends)

    def _near_person(self, ends: np.ndarray) -> bool:
        """Whether links, ends (r, 2, 3) [m], come too near to the person."""
        zone = self._zone
        assert len(zone.names) == self._least.shape[1], "one checker serves one plan: the person must not change"
        return any_nearer(ends, self._links.radii, zone.ends, zone.radii, self._least_gaps)

    def contacts(
        self, pose_base_in_map: np.ndarray, arm_positions: np.ndarray, head_pan: float | None = None
    ) -> Contacts:
        """What the robot itself and the room are too near to; how near the person may be is known from the start."""
        pan = self.head_pan if head_pan is None else head_pan
        return self._checker.contacts(pose_base_in_map, arm_positions, pan)

    def collisions(
        self, pose_base_in_map: np.ndarray, arm_positions: np.ndarray, head_pan: float | None = None
    ) -> list[tuple[str, str]]:
        """Names of all pairs that are too close, for a message."""
        return next(self.collisions_along(pose_base_in_map, np.asarray(arm_positions, float)[None], head_pan))

    def collisions_along(
        self, pose_base_in_map: np.ndarray, postures: np.ndarray, head_pan: float | None = None
    ) -> Iterator[list[tuple[str, str]]]:
        """What `collisions` says of each of the postures (k, 2, n) of a motion [rad], at least one, in turn."""
        pan = self.head_pan if head_pan is None else head_pan
        links, parts = self._links.names, self._zone.names
        own = self._checker.collisions_along(pose_base_in_map, postures, pan)
        for arms, hits in zip(postures, own, strict=True):
            room = self._room(pose_base_in_map, arms, pan)
            near = [(links[n], f"the person's {parts[m]}") for n, m in np.argwhere(room < self._least)]
            yield [*dict.fromkeys(near), *hits]

    def _room(self, base: np.ndarray, arms: np.ndarray, head_pan: float) -> np.ndarray:
        ends = self._links.ends(base, arms, head_pan, self._opening)
        return self._zone.gaps(ends, self._links.radii)[0] - self._gaps
