"""Look for a visible corner of the hung gown's neckline, from in front of the hook and from beside it."""

from __future__ import annotations

from collections.abc import Generator, Iterator
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from ..perception.errors import PerceptionFailure
from ..perception.estimates import CORNER_OF, GraspPoint
from ..sim.quantity import Quantities, quantity
from ..sim.world import Frame, Side
from .control.base import drive_to
from .core.ports import Input, Output
from .core.reasons import Reason
from .core.skill import Skill
from .core.tries import Tries

OTHER: dict[Side, Side] = {"left": "right", "right": "left"}


@dataclass(frozen=True, kw_only=True)
class FindCornerTuning(Quantities):
    """Numbers of `FindCorner`."""

    distance: float = quantity(
        1.0,
        "m",
        "from the base to the hook",
        "choice: there both hands turn freely, and the camera sees the whole gown",
    )
    view_angles: tuple[float, float, float] = quantity(
        (0.0, float(np.deg2rad(-30.0)), float(np.deg2rad(30.0))),
        "rad",
        "about the hook from squarely before the rail, where it looks from, in this order",
        "measured: on simulated gowns a corner shows from at least one of the three",
    )
    clear_confidence: float = quantity(
        0.5,
        "1",
        "confidence above which no other cloth hangs beside a corner, so that the search ends",
        "design: perception gives less to a corner with other cloth beside it",
    )
    tolerance: float = quantity(
        0.04,
        "m, rad",
        "distance from a place to stand at which no step is made",
        "choice: a shorter step is not worth driving",
    )


@dataclass
class Tried:
    """The corners that were found so far, the latest last."""

    corners: list[GraspPoint] = field(default_factory=list)


class FindCorner(Skill):
    """Stands before the hook and looks; where no corner shows clear of other cloth, it looks from other places.

    The first of these are beside the hook: if the front of the gown bulges towards the camera, its neckline is seen
    edge-on from straight ahead.  The last are behind the rail: a gown that is wrapped round itself shows its outside
    on both sides of the rail, but its neckline on one only.

    When it is run again, it looks for the other corner first, and where none shows, for the one that it found last,
    close to where that was: its side is known by then.  It fails where no corner shows from anywhere.
    """

    tuning = Input(FindCornerTuning, default=FindCornerTuning(), doc="numbers of this skill")
    hook = Output(GraspPoint, unit="m, map", doc="where the gown hangs")
    corner = Output(GraspPoint, unit="m, map", doc="the corner that was found")
    sleeve = Output(Side, doc="the wearer's side that the corner belongs to")
    other_sleeve = Output(Side, doc="the wearer's other side")
    hand = Output(Side, doc="the hand that takes the corner; the gown's outside faces the robot, so sides are mirrored")
    other_hand = Output(Side, doc="the hand that takes the other corner")
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
        tried = self.context.memory.of(Tried, Tried).corners
        last = tried[-1] if tried else None
        hook = self.context.senses.hook(self.world.look("head"))
        try:
            front = float(waypoints[sides[0]][2]) if sides else yaw
            hook, found = yield from self._look_round(hook, front, last)
        except PerceptionFailure:
            if len(sides) < 2:
                raise
            self.note("looks for a corner of the neckline from the other side of the rail")
            yield from drive_to(self, sides[1])
            hook = self.context.senses.hook(self.world.look("head"))
            hook, found = yield from self._look_round(hook, float(waypoints[sides[1]][2]), last)
        sleeve = _sleeve_of(found)
        tried.append(found)
        self.note(f"sees the {sleeve} corner of the neckline, confidence {found.confidence:.2f}")
        self.hook, self.corner, self.sleeve, self.other_sleeve = hook, found, sleeve, OTHER[sleeve]
        self.hand, self.other_hand = OTHER[sleeve], sleeve

    def _look_round(
        self, hook: GraspPoint, front: float, last: GraspPoint | None
    ) -> Generator[None, None, tuple[GraspPoint, GraspPoint]]:
        """Hook and corner: from the first place that shows the wanted corner clear of other cloth, else from the best.

        Raises:
            PerceptionFailure: no corner is seen from anywhere.
        """
        tries, best = Tries(PerceptionFailure), None
        looks = [(0.0, partial(self._shown, side=None))]
        if last is not None:
            looks = [
                (1.0, partial(self._shown, side=OTHER[_sleeve_of(last)])),
                *looks,
                (-1.0, partial(self._same, last=last)),
            ]
        for turn in self.tuning.view_angles:
            hook, frame = yield from self._stand(hook, front + turn)
            for rank, look in looks:
                with tries:
                    found = look(frame, hook)
                    score = rank + found.confidence
                    if rank == looks[0][0] and found.confidence > self.tuning.clear_confidence:
                        return hook, found
                    if best is None or score > best[0]:
                        best = score, turn, look
        if best is None:
            raise tries.last
        hook, frame = yield from self._stand(hook, front + best[1])
        return hook, best[2](frame, hook)

    def _shown(self, frame: Frame, hook: GraspPoint, *, side: Side | None) -> GraspPoint:
        return self.context.senses.shown_corner(frame, hook_in_map=hook.position_in_map, side=side)

    def _same(self, frame: Frame, hook: GraspPoint, *, last: GraspPoint) -> GraspPoint:
        return self.context.senses.hung_corner(
            frame, side=_sleeve_of(last), hook_in_map=hook.position_in_map, near_in_map=last.position_in_map
        )

    def _stand(self, hook: GraspPoint, yaw: float) -> Generator[None, None, tuple[GraspPoint, Frame]]:
        """Step to where the hook is straight ahead at heading `yaw` [rad]; the hook, and the frame seen from there."""
        tuning = self.tuning
        goal = np.append(hook.position_in_map[:2] - tuning.distance * np.array((np.cos(yaw), np.sin(yaw))), yaw)
        if np.linalg.norm(goal - self.world.observe().pose_base_in_map) > tuning.tolerance:
            yield from drive_to(self, goal, straight=True)
        frame = self.world.look("head")
        return self.context.senses.hook(frame), frame


def _sleeve_of(corner: GraspPoint) -> Side:
    """The wearer's side that a corner belongs to."""
    return "left" if corner.target == CORNER_OF["left"] else "right"
