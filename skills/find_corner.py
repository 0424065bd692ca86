"""Look for a visible corner of the hung gown's neckline, from in front of the hook and from beside it."""

from __future__ import annotations

import math
from collections.abc import Callable, Generator, Iterator
from dataclasses import dataclass, field
from functools import partial
from typing import TypeAlias

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
    part_confidence: float = quantity(
        0.21,
        "1",
        "confidence up to which a corner shows in part only, so that the other side of the rail is looked at first",
        "design: perception gives less to a corner that is seen at an angle",
    )
    tolerance: float = quantity(
        0.04,
        "m, rad",
        "distance from a place to stand at which no step is made",
        "choice: a shorter step is not worth driving",
    )


Look: TypeAlias = Callable[[Frame, GraspPoint], GraspPoint]  # of a frame and the hook in it: a corner


@dataclass(frozen=True, kw_only=True, eq=False)
class _Sight:
    """A corner that was seen.

    Attributes:
        rank: how much it is wanted, above all confidence.
        hook: where the gown hung.
        heading: of the robot, the hook straight ahead [rad].
        look: that showed it.
        corner: that it showed.
        clear: whether it is the wanted one, and no other cloth hangs beside it, so that the search ended there.
    """

    rank: float
    hook: GraspPoint
    heading: float
    look: Look
    corner: GraspPoint
    clear: bool


@dataclass
class Tried:
    """The corners that were found so far, the latest last."""

    corners: list[GraspPoint] = field(default_factory=list)


class FindCorner(Skill):
    """Stands before the hook and looks; where no corner shows clear of other cloth, it looks from other places.

    The first of these are beside the hook: if the front of the gown bulges towards the camera, its neckline is seen
    edge-on from straight ahead.  The last are behind the rail: a gown that is wrapped round itself shows its outside
    on both sides of the rail, but its neckline on one only.  A corner that shows in part, at an angle to the camera, is
    taken where none shows whole from either side.

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
            key=lambda name: -math.cos(waypoints[name][2] - yaw),
        )
        tried = self.context.memory.of(Tried, Tried).corners
        last = tried[-1] if tried else None
        hook = self.context.senses.hook(self.world.look("head"))
        tries = Tries(PerceptionFailure)
        seen = yield from self._look_round(hook, float(waypoints[sides[0]][2]) if sides else yaw, last, tries)
        if len(sides) > 1 and not any(self._all_shows(sight) for sight in seen):
            self.note("looks for a corner of the neckline from the other side of the rail")
            yield from drive_to(self, sides[1])
            behind: list[_Sight] = []
            with tries:
                hook = self.context.senses.hook(self.world.look("head"))
                behind = yield from self._look_round(hook, float(waypoints[sides[1]][2]), last, tries)
            if seen and not any(self._all_shows(sight) for sight in behind):
                yield from drive_to(self, sides[0])
            else:
                seen = behind
        if not seen:
            raise tries.last
        hook, found = yield from self._look_again(max(seen, key=lambda sight: sight.rank + sight.corner.confidence))
        sleeve = _sleeve_of(found)
        tried.append(found)
        self.note(f"sees the {sleeve} corner of the neckline, confidence {found.confidence:.2f}")
        self.hook, self.corner, self.sleeve, self.other_sleeve = hook, found, sleeve, OTHER[sleeve]
        self.hand, self.other_hand = OTHER[sleeve], sleeve

    def _all_shows(self, sight: _Sight) -> bool:
        return sight.corner.confidence > self.tuning.part_confidence

    def _look_round(
        self, hook: GraspPoint, front: float, last: GraspPoint | None, tries: Tries[PerceptionFailure]
    ) -> Generator[None, None, list[_Sight]]:
        """What shows of corners from three places, or from fewer if the wanted one shows clear of other cloth.

        Args:
            hook: where the gown hangs.
            front: heading squarely before the rail [rad].
            last: the corner that was found last.
            tries: gets what kept corners from being seen.
        """
        seen: list[_Sight] = []
        looks: list[tuple[float, Look]] = [(0.0, partial(self._shown, side=None))]
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
                    clear = rank == looks[0][0] and found.confidence > self.tuning.clear_confidence
                    seen.append(
                        _Sight(rank=rank, hook=hook, heading=front + turn, look=look, corner=found, clear=clear)
                    )
                    if clear:
                        return seen
        return seen

    def _look_again(self, best: _Sight) -> Generator[None, None, tuple[GraspPoint, GraspPoint]]:
        """Hook and corner, from where the corner showed best."""
        if best.clear:  # it still stands there
            return best.hook, best.corner
        hook, frame = yield from self._stand(best.hook, best.heading)
        return hook, best.look(frame, hook)

    def _shown(self, frame: Frame, hook: GraspPoint, *, side: Side | None) -> GraspPoint:
        return self.context.senses.shown_corner(frame, hook_in_map=hook.position_in_map, side=side)

    def _same(self, frame: Frame, hook: GraspPoint, *, last: GraspPoint) -> GraspPoint:
        return self.context.senses.hung_corner(
            frame, side=_sleeve_of(last), hook_in_map=hook.position_in_map, near_in_map=last.position_in_map
        )

    def _stand(self, hook: GraspPoint, yaw: float) -> Generator[None, None, tuple[GraspPoint, Frame]]:
        """Step to where the hook is straight ahead at heading `yaw` [rad]; the hook, and the frame seen from there."""
        tuning = self.tuning
        goal = np.append(hook.position_in_map[:2] - tuning.distance * np.array((math.cos(yaw), math.sin(yaw))), yaw)
        if np.linalg.norm(goal - self.world.observe().pose_base_in_map) > tuning.tolerance:
            yield from drive_to(self, goal, straight=True)
        frame = self.world.look("head")
        return self.context.senses.hook(frame), frame


def _sleeve_of(corner: GraspPoint) -> Side:
    """The wearer's side that a corner belongs to."""
    return "left" if corner.target == CORNER_OF["left"] else "right"
