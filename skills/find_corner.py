"""Stage A: look for the corner of the hung gown's neckline that shows, from in front of the hook or from beside it."""

from __future__ import annotations

from collections.abc import Generator, Iterator
from dataclasses import dataclass, field

import numpy as np

from ..perception.errors import PerceptionFailure
from ..perception.estimates import CORNER_OF, GraspPoint
from ..sim.world import Frame, Side
from .control.base import drive_to
from .core.ports import Output
from .core.reasons import Reason
from .core.skill import Skill

STAND = 1.0  # before the hook, where both hands turn freely and the camera sees the whole gown [m]
ROUND = tuple(np.deg2rad((0.0, -30.0, 30.0)))  # about the hook, from squarely before the rail [rad]
CLEAR = 0.5  # confidence of a corner with no other cloth beside it
NEAR_ENOUGH = 0.04  # of the place to stand [m or rad]
OTHER: dict[Side, Side] = {"left": "right", "right": "left"}


@dataclass
class Tried:
    """The corners that were found so far, by the wearer's side, the latest last."""

    sleeves: list[Side] = field(default_factory=list)


class FindCorner(Skill):
    """Stands before the hook and looks; where no corner shows down to its end, it looks again from other places.

    First from either side: a gown whose front bulges towards the camera shows it edge-on in front.  Then from
    behind the rail: a gown that is wrapped round itself shows its outside on both sides, and its neckline on one.

    Asked again, it looks for the other corner first.

    Outputs: `hook`; `found`, the corner; `sleeve`, the wearer's side that it belongs to, and `other`, the one that is
    left; `hand` that takes it (the outside faces the robot: corners are mirrored), and `other_hand`.
    """

    hook = Output(GraspPoint)
    found = Output(GraspPoint)
    sleeve = Output(Side)
    other = Output(Side)
    hand = Output(Side)
    other_hand = Output(Side)
    reasons = (Reason.NOTHING_SEEN, Reason.COMMAND_LOST, Reason.TIMEOUT, Reason.PATH_BLOCKED)

    def steps(self) -> Iterator[None]:
        """Stand, look, go round."""
        self.note("looks for a corner of the neckline")
        yaw = float(self.world.observe().pose_base_in_map[2])
        waypoints = self.world.room.waypoints
        sides = sorted(
            (name for name in ("rail", "rail_back") if name in waypoints),
            key=lambda name: -np.cos(waypoints[name][2] - yaw),
        )
        tried = self.context.memory.of(Tried, Tried).sleeves
        wanted = OTHER[tried[-1]] if tried else None
        hook = self.context.senses.hook(self.world.look("head"))
        try:
            front = float(waypoints[sides[0]][2]) if sides else yaw
            hook, found = yield from self._look_round(hook, front, wanted)
        except PerceptionFailure:
            if len(sides) < 2:
                raise
            self.note("looks for a corner of the neckline from the other side of the rail")
            yield from drive_to(self, sides[1])
            hook = self.context.senses.hook(self.world.look("head"))
            hook, found = yield from self._look_round(hook, float(waypoints[sides[1]][2]), wanted)
        sleeve: Side = "left" if found.target == CORNER_OF["left"] else "right"
        tried.append(sleeve)
        self.note(f"sees the {sleeve} corner of the neckline, confidence {found.confidence:.2f}")
        self.hook, self.found, self.sleeve, self.other = hook, found, sleeve, OTHER[sleeve]
        self.hand, self.other_hand = OTHER[sleeve], sleeve

    def _look_round(
        self, hook: GraspPoint, front: float, wanted: Side | None
    ) -> Generator[None, None, tuple[GraspPoint, GraspPoint]]:
        """Hook and corner, from the first place that shows the wanted one clear of other cloth, or else from the best.

        Raises:
            PerceptionFailure: no corner is seen from anywhere.
        """
        nothing: PerceptionFailure | None = None
        best: tuple[float, float, Side | None] | None = None
        for turn in ROUND:
            hook, frame = yield from self._stand(hook, front + turn)
            for side in (wanted, None) if wanted else (None,):
                try:
                    found = self._shown(frame, hook, side)
                except PerceptionFailure as miss:
                    nothing = miss
                    continue
                score = found.confidence + float(side == wanted)
                if score > 1.0 + CLEAR:
                    return hook, found
                if best is None or score > best[0]:
                    best = score, turn, side
        if best is None:
            assert nothing is not None
            raise nothing
        hook, frame = yield from self._stand(hook, front + best[1])
        return hook, self._shown(frame, hook, best[2])

    def _shown(self, frame: Frame, hook: GraspPoint, side: Side | None) -> GraspPoint:
        return self.context.senses.shown_corner(frame, hook_in_map=hook.position_in_map, side=side)

    def _stand(self, hook: GraspPoint, yaw: float) -> Generator[None, None, tuple[GraspPoint, Frame]]:
        """Step to where the hook is straight ahead at a heading; the hook and what is seen from there."""
        goal = np.append(hook.position_in_map[:2] - STAND * np.array((np.cos(yaw), np.sin(yaw))), yaw)
        if np.linalg.norm(goal - self.world.observe().pose_base_in_map) > NEAR_ENOUGH:
            yield from drive_to(self, goal, straight=True)
        frame = self.world.look("head")
        return self.context.senses.hook(frame), frame
