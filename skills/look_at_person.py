"""Find the person: both arms if they can be seen, head and trunk, and tell the guard where they are."""

from __future__ import annotations

from collections.abc import Iterator

from ..perception.errors import PerceptionFailure, Problem
from ..perception.estimates import ArmPosture
from ..sim.world import Side
from .belief.person_tracking import see_person, watch_arm
from .control.hands import pan_head
from .core.ports import Input, Output
from .core.reasons import Reason
from .core.skill import Skill

_PANS = (0.0, 0.35, -0.35)  # tried one after the other [rad]
_SETTLED = 0.035  # deviation of every joint at which an arm counts as found [m]


class LookAtPerson(Skill):
    """Looks until the arm on `side` is known well, panning the head when it is not in view.

    Inputs: `side` of the person; `looks`, pictures taken at most at each angle of the head.
    Output: `posture` of that arm.
    """

    side = Input(Side)
    looks = Input(int, default=4)
    posture = Output(ArmPosture)
    reasons = (Reason.NOTHING_SEEN, Reason.ARM_LOST, Reason.COMMAND_LOST)

    def steps(self) -> Iterator[None]:
        """Look, pan, look again."""
        self.note(f"looks for the person's {self.side} arm")
        lost = PerceptionFailure(Problem.ARM_LOST, f"{self.side} arm")
        for pan in _PANS:
            yield from pan_head(self, pan)
            for _ in range(self.looks):
                try:
                    see_person(self)
                    posture = watch_arm(self, self.side, patience=0.0)
                except PerceptionFailure as stop:
                    lost = stop
                    yield
                    continue
                if float(posture.deviation.max()) <= _SETTLED:
                    self.posture = posture
                    return
                yield from self.wait(0.1)
        posture = self._remembered(lost)
        self.note(f"takes the {self.side} arm, which is covered, to lie where it was")
        self.posture = posture

    def _remembered(self, lost: PerceptionFailure) -> ArmPosture:
        """Where an arm that now lies under the gown was seen before."""
        try:
            posture = watch_arm(self, self.side)
        except PerceptionFailure:
            raise lost from None
        if float(posture.deviation.max()) > _SETTLED:
            raise lost
        return posture
