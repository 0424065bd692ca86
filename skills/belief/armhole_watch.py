"""Watch the armhole of a sleeve that is pulled: is it centred on the arm, is the hand inside, is it at the shoulder?"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, field

import numpy as np

from ...perception.errors import PerceptionFailure
from ...sim.quantity import Quantities, quantity
from ...sim.world import Side
from ..core.skill import Skill
from ..geometry.arm_path import ArmPath
from ..geometry.stances import outwards
from .over_hand import OverHandTuning, on_forearm


@dataclass(frozen=True, kw_only=True)
class ArmholeWatchTuning(Quantities):
    """Numbers of watching an armhole."""

    period: float = quantity(0.2, "s", "between two looks", "choice: one look serves three ticks")
    edge_offset: float = quantity(
        0.07,
        "m",
        "where the armhole's outer edge belongs, outwards of the arm's axis",
        "choice: the hoop is 0.17 m wide; its inner half hides, so the middle of what is seen is not its middle",
    )
    edge_percentile: int = quantity(
        97, "%", "of the armhole's points outwards that counts as its outer edge", "choice: leaves stray points out"
    )
    tolerance: float = quantity(0.02, "m", "error of the edge that lets the hand in", "choice: the hand has room")
    max_offset: float = quantity(0.14, "m", "of the grip to the side of the arm", "choice: a little less than the hoop")
    gain: float = quantity(0.5, "1", "share of the error that one look corrects", "choice: the cloth follows late")
    max_step: float = quantity(0.03, "m", "of the grip's offset after one look", "choice: the cloth does not swing")
    hand_from: float = quantity(
        2.3, "1", "arm coordinate from which the hand must be under the sleeve", "choice: a third into the hand"
    )
    hand_to: float = quantity(2.95, "1", "arm coordinate up to which it must be", "choice: just short of the fingertip")
    hand_points: int = quantity(10, "1", "points of the hand that are looked at", "choice: one every cm")
    min_covered: float = quantity(0.5, "1", "share of them that the sleeve covers", "choice: the larger part")
    cuff_coordinates: tuple[float, float, float, float] = quantity(
        (1.2, 2.0, 3.0, 4.4),
        "1",
        "arm coordinates round which the cuff is looked for, with the grip half way up the forearm",
        "choice: the cuff is then between the wrist and beyond the fingertips",
    )
    min_round: float = quantity(
        0.4,
        "1",
        "share of the way round them that the cuff shows with the hand inside",
        "measured: in recorded pulls at least this much with the hand inside, 0.25 where the sleeve had missed it",
    )
    surely_round: float = quantity(
        0.9,
        "1",
        "share of the way round them, from which the hand is inside however bare the arm looks",
        "measured: 1.0 where a sleeve was on askew, the arm bare beyond its armhole (178)",
    )
    sleeve_covers: tuple[float, float] = quantity(
        (1.9, 2.3),
        "1",
        "arm coordinates between which the sleeve is over the arm then",
        "measured: an armhole half way up the forearm was at 1.5 to 1.8, its cuff at 2.2 to 2.8 (20 pulls)",
    )
    min_sleeve: float = quantity(
        0.3,
        "1",
        "share of the arm's axis there that shows something else than skin, with the hand inside",
        "measured: 0.62 and more in 19 pulls of 20 with the hand inside, of 176 to 183 and 0, none of it in the two "
        "that had missed it, though the cuff showed 0.42 and 0.67 of the way round (178, 184)",
    )
    # Measured in seven pulls of 103, drawn again: armholes of sleeves with the hand inside at 0.56 to 1.26 of the
    # forearm, those at 0.56 and 0.69 with 0.31 and 0.49 of the way round, all covered, the latter told to be beside
    # it by the rest; of one that had missed it at 1.29.  Nine more (303 to 306) say the same: 0.58 and 0.76, 0.45
    # round, told to be beside; missed at 1.13.
    over_hand: OverHandTuning = field(default_factory=lambda: OverHandTuning(min_round=0.25, min_covered=0.8))
    memory: float = quantity(0.8, "s", "after which an armhole that is hidden may have moved on", "choice: four looks")
    max_points: int = quantity(
        25, "1", "points of the armhole whose arm coordinate is computed, about", "choice: bounds the time of computing"
    )


ARMHOLE_WATCH = ArmholeWatchTuning()


class ArmholeWatch:
    """What the head's and the pulling hand's cameras see of a held armhole.

    Args:
        skill: that pulls.
        arm: the wearer's side of the sleeve.
        hand: of the robot that holds it.
        tuning: numbers of the watch.

    Attributes:
        offset: how far to the side of the arm the grip should be, along the first axis of `ArmPath.frame` [m].
        error: how far the armhole's outer edge was from where it belongs at the last look, 0 before it was seen [m].
        coordinate: arm coordinate at which `locate` saw the armhole, the median over what shows of it; None when it is
            hidden.
    """

    def __init__(self, skill: Skill, arm: Side, hand: Side, *, tuning: ArmholeWatchTuning = ARMHOLE_WATCH) -> None:
        self._skill = skill
        self._arm: Side = arm
        self._hand: Side = hand
        self._tuning = tuning
        self.offset = self.error = 0.0
        self.coordinate: float | None = None
        self._looked = self._located = -np.inf

    def centre(self, path: ArmPath, coordinate: float, grip_in_map: np.ndarray) -> None:
        """Look, unless the last look is recent; shift `offset` by a part of the armhole's `error`.

        Args:
            path: of the arm now.
            coordinate: arm coordinate of the gripper.
            grip_in_map: (3,) fingertips that hold the strap [m].
        """
        if self._skill.now() - self._looked < self._tuning.period:
            return
        self._looked = self._skill.now()
        across = path.frame(coordinate)[:, 0]
        side = float(np.sign(across @ outwards(self._arm)))
        edges = []
        for camera in ("head", f"{self._hand}_hand"):
            try:
                armhole = self._skill.context.senses.held_armhole(
                    self._skill.world.look(camera), side=self._arm, near_in_map=grip_in_map
                )
            except PerceptionFailure:
                continue
            outwards_of_axis = (armhole.armhole_points_in_map - path.point(coordinate)) @ (side * across)
            edges.append(np.percentile(outwards_of_axis, self._tuning.edge_percentile))
        if not edges:
            return
        step, most = self._tuning.max_step, self._tuning.max_offset
        self.error = self._tuning.edge_offset - float(np.max(edges))
        # from where the grip is by now: counted on from what was asked for before, it went twice as far as it had to
        here = float((grip_in_map - path.point(coordinate)) @ across)
        self.offset = float(np.clip(here + side * np.clip(self._tuning.gain * self.error, -step, step), -most, most))

    def locate(self, path: ArmPath, grip_in_map: np.ndarray) -> None:
        """Look where along the arm the armhole is, unless the last look is recent; updates `coordinate`.

        Args:
            path: of the arm now.
            grip_in_map: (3,) fingertips that hold the strap [m].
        """
        now = self._skill.now()
        if now - self._looked < self._tuning.period:
            return
        self._looked = now
        try:
            armhole = self._skill.context.senses.held_armhole(
                self._skill.world.look("head"), side=self._arm, near_in_map=grip_in_map
            )
        except PerceptionFailure:
            if now - self._located > self._tuning.memory:
                self.coordinate = None
            return
        some = armhole.armhole_points_in_map[:: max(1, len(armhole.armhole_points_in_map) // self._tuning.max_points)]
        self.coordinate, self._located = float(np.median([path.coordinate_of(point) for point in some])), now

    def hand_is_bare(self, path: ArmPath) -> bool:
        """Whether the pulling hand's camera sees the person's hand bare; False where it cannot tell.

        Args:
            path: of the arm now; the camera looks down at its hand.
        """
        tuning = self._tuning
        hand = np.linspace(tuning.hand_from, tuning.hand_to, tuning.hand_points)
        points = np.array([path.point(float(coordinate)) for coordinate in hand])
        camera = self._skill.world.look(f"{self._hand}_hand")
        try:
            cover = self._skill.context.senses.skin_cover(camera, points_in_map=points)
        except PerceptionFailure:
            return False
        return cover.share < tuning.min_covered

    def arm_is_beside(self, path: ArmPath) -> bool:
        """Whether the head's camera sees the arm beside its sleeve; False where it cannot tell.

        The cuff shows on one side of it only, or the arm is bare where the sleeve would be; but for one whose armhole
        has come past the wrist, from which on all of the arm is covered as far as the cuff.

        Args:
            path: of the arm now.
        """
        tuning, camera, senses = self._tuning, self._skill.world.look("head"), self._skill.context.senses
        chain = np.array([path.point(coordinate) for coordinate in tuning.cuff_coordinates])
        axis = np.linspace(*tuning.sleeve_covers, tuning.hand_points)
        try:
            round_arm = senses.cuff_round(camera, points_in_map=chain).share
            points = np.array([path.point(float(coordinate)) for coordinate in axis])
            bare = senses.skin_cover(camera, points_in_map=points).share < tuning.min_sleeve
        except PerceptionFailure:
            return False
        if round_arm >= (tuning.surely_round if bare else tuning.min_round):
            return False
        with suppress(PerceptionFailure):
            sleeve = on_forearm(senses, camera, self._arm, path.points, tuning.over_hand.points)
            return not sleeve.over_hand(tuning.over_hand)
        return True
