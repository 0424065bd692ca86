"""Let go of a gown that is down on the person, although its way there did not come to its end."""

from __future__ import annotations

from collections.abc import Iterator

from ....skills.control.leave_gown import LeaveGownTuning, leave_gown
from ....skills.core.ports import Input
from ....skills.core.reasons import Reason
from ....skills.core.skill import Skill


class LetGownGo(Skill):
    """Opens both hands, draws them back, and drives off, as `LayGown` does in the end."""

    tuning = Input(LeaveGownTuning, default=LeaveGownTuning(), doc="numbers of this skill")
    reasons = (Reason.UNREACHABLE, Reason.MOTION_BLOCKED, Reason.COMMAND_LOST, Reason.PATH_BLOCKED, Reason.TIMEOUT)

    def steps(self) -> Iterator[None]:
        """Open, rise, drive back."""
        self.note("lets the gown go")
        yield from leave_gown(self, self.tuning)
