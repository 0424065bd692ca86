"""Watching the armhole of a sleeve on its way: is it centred on the arm, is the hand inside, is it at the shoulder?"""

from __future__ import annotations

import numpy as np

from ...perception.errors import PerceptionFailure
from ...sim.world import Side
from ..core.skill import Skill
from ..geometry.arm_path import ArmPath
from ..geometry.stances import outwards

PERIOD = 0.2  # between two looks [s]
# Where the armhole's outer edge belongs, outwards of the arm's axis [m].  The hoop is 0.17 m wide, and its inner
# half hides behind the outer one, so that the middle of what is seen is not the middle.
EDGE = 0.07
CENTRED = 0.02  # how far off that lets the hand in [m]
_FARTHEST = 0.14  # that the grip goes to the side for it [m]
_STEP = 0.03  # by which the grip goes to the side after one look, at most [m]
_HAND = np.linspace(2.3, 2.95, 10)  # places along the arm that must be under the sleeve
_COVERED = 0.5  # share of them
# With the grip half way up the forearm the cuff is somewhere between the wrist and beyond the fingertips.  In recorded
# pulls it showed at least so far round these places with the hand inside, 0.25 where the sleeve had missed it.
_CHAIN, ROUND = (1.2, 2.0, 3.0, 4.4), 0.4
_STALE = 0.8  # an armhole that was not seen for so long may have moved on [s]
_SOME = 25  # of the armhole's points are asked for their place


class RingWatch:
    """What the head's and the pulling hand's cameras see of a held armhole.

    Attributes:
        aside: how far to the side of the arm the grip should be, along the first axis of `ArmPath.frame` [m].
        off: how far the armhole was from its place at the last look, 0 before it was seen [m].
        place: where along the arm `follow` saw the armhole, the median over what shows of it; None when it is hidden.
    """

    def __init__(self, skill: Skill, arm: Side, hand: Side) -> None:
        self._skill = skill
        self._arm: Side = arm
        self._hand: Side = hand
        self.aside = self.off = 0.0
        self.place: float | None = None
        self._looked = self._placed = -np.inf

    def look(self, path: ArmPath, place: float, grip_in_map: np.ndarray) -> None:
        """Look, at most every `PERIOD`; shifts `aside` by part of what the armhole is off.

        Args:
            path: of the arm now.
            place: of the gripper along it.
            grip_in_map: (3,) fingertips that hold the strap [m].
        """
        if self._skill.now() - self._looked < PERIOD:
            return
        self._looked = self._skill.now()
        across = path.frame(place)[:, 0]
        side = float(np.sign(across @ outwards(self._arm)))
        edges = []
        for camera in ("head", f"{self._hand}_hand"):
            try:
                ring = self._skill.context.senses.held_armhole(
                    self._skill.world.look(camera), side=self._arm, near_in_map=grip_in_map
                )
            except PerceptionFailure:
                continue
            edges.append(np.percentile((ring.ring_points_in_map - path.point(place)) @ (side * across), 97))
        if not edges:
            return
        self.off = EDGE - float(np.max(edges))
        self.aside = float(np.clip(self.aside + side * np.clip(0.5 * self.off, -_STEP, _STEP), -_FARTHEST, _FARTHEST))

    def follow(self, path: ArmPath, grip_in_map: np.ndarray) -> None:
        """Look where along the arm the armhole is, at most every `PERIOD`; updates `place`."""
        now = self._skill.now()
        if now - self._looked < PERIOD:
            return
        self._looked = now
        try:
            ring = self._skill.context.senses.held_armhole(
                self._skill.world.look("head"), side=self._arm, near_in_map=grip_in_map
            )
        except PerceptionFailure:
            if now - self._placed > _STALE:
                self.place = None
            return
        some = ring.ring_points_in_map[:: max(1, len(ring.ring_points_in_map) // _SOME)]
        self.place, self._placed = float(np.median([path.place_of(point) for point in some])), now

    def missed(self, path: ArmPath) -> bool:
        """Whether the pulling hand's camera, which looks down at the person's hand, sees it bare."""
        points = np.array([path.point(float(place)) for place in _HAND])
        camera = self._skill.world.look(f"{self._hand}_hand")
        try:
            cover = self._skill.context.senses.hand_cover(camera, points_in_map=points)
        except PerceptionFailure:
            return False
        return cover.share < _COVERED

    def beside(self, path: ArmPath) -> bool:
        """Whether the head's camera sees the cuff on one side of the arm only; False where it cannot tell."""
        chain = np.array([path.point(place) for place in _CHAIN])
        try:
            cover = self._skill.context.senses.cuff_round(self._skill.world.look("head"), points_in_map=chain)
        except PerceptionFailure:
            return False
        return cover.share < ROUND
