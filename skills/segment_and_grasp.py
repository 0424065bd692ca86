"""Segment the gown on its rail and take it near the hook."""

from __future__ import annotations

from collections.abc import Iterator

from ..perception.estimates import GraspPoint
from ..sim.world import Side
from .control.base import stand_for
from .control.head import pan_head
from .control.pinch import pinch_or_back_off, reach_in
from .core.ports import Input, Output
from .core.reasons import Reason
from .core.skill import Skill


class SegmentAndGrasp(Skill):
    """Looks with the head, picks a place near the hanging point and closes the fingers of one hand there.

    It fails where no gown shows, or none is between the fingers in the end; the hand is then open and drawn back.
    """

    hand = Input(Side, doc="the hand that takes the gown")
    force = Input(float, unit="N", doc="of the grip at most", default=30.0)
    grasp = Output(GraspPoint, unit="m, map", doc="where the gown was taken")
    reasons = (
        Reason.NOTHING_SEEN,
        Reason.PATH_BLOCKED,
        Reason.UNREACHABLE,
        Reason.MOTION_BLOCKED,
        Reason.GRASP_MISSED,
        Reason.COMMAND_LOST,
    )

    def steps(self) -> Iterator[None]:
        """Look, step to where the hand reaches it, reach in, pinch."""
        self.note("looks where to take hold")
        yield from pan_head(self, 0.0)
        point = self.context.senses.hang_point(self.world.look("head"))
        self.note("reaches there")
        yield from stand_for(self, self.hand, point.position_in_map)
        yield from reach_in(self, self.hand, point.position_in_map, point.approach_in_map, point.closing_in_map)
        yield from pinch_or_back_off(self, self.hand, force=self.force)
        self.grasp = point
