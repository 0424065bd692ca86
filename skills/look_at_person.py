"""Find the person: both arms if they can be seen, head and trunk, and tell the guard where they are."""

from __future__ import annotations

from collections.abc import Generator, Iterator
from dataclasses import dataclass
from typing import Literal

from ..perception.errors import PerceptionFailure, Problem
from ..perception.estimates import ArmPosture
from ..sim.quantity import Quantities, quantity
from ..sim.world import Side
from .belief.person_tracking import PERSON_TRACKING, head_view, see_person, visible_share, watch_arm, watch_of
from .control.head import look_towards, pan_head
from .core.ports import Input, Output
from .core.reasons import Reason
from .core.skill import Skill
from .geometry.stances import HEADWARD

Part = Literal["arm", "trunk"]


@dataclass(frozen=True, kw_only=True)
class LookAtPersonTuning(Quantities):
    """Numbers of the search for an arm."""

    pans: tuple[float, float, float] = quantity(
        (0.0, 0.35, -0.35),
        "rad",
        "angles of the head, tried one after the other",
        "choice: ahead, then a little to either side",
    )
    chest: float = quantity(
        0.3, "m", "of the middle of the trunk from that of the bed, towards the head", "choice: belly and chest in view"
    )
    max_looks: int = quantity(
        4, "1", "pictures taken at most at each angle", "choice: the joints of an arm in view settle meanwhile"
    )
    look_interval: float = quantity(
        0.1, "s", "between two pictures of an arm that is not known well yet", "choice: short"
    )


class LookAtPerson(Skill):
    """Looks until the arm on `side` is known well, first where it was, then panning the head.

    An arm that is covered where it was is taken to lie there still; it fails where it was not seen well then.
    """

    side = Input(Side, doc="arm of the person")
    part = Input(Part, default="arm", doc="the arm, or the trunk, to which the head only turns")
    posture = Output(ArmPosture, unit="m, map", doc="joints of that arm")
    tuning = Input(LookAtPersonTuning, default=LookAtPersonTuning(), doc="numbers of this skill")
    reasons = (Reason.NOTHING_SEEN, Reason.ARM_LOST, Reason.COMMAND_LOST)

    def steps(self) -> Iterator[None]:
        """Look, pan, look again."""
        if self.part == "trunk":
            self.note("looks at the person's trunk")
            yield from look_towards(self, self.world.room.bed[:, :2].mean(axis=0) + self.tuning.chest * HEADWARD[:2])
            return
        self.note(f"looks for the person's {self.side} arm")
        lost: PerceptionFailure | None = PerceptionFailure(Problem.ARM_LOST, f"{self.side} arm")
        known = watch_of(self).arms.get(self.side)
        if known is not None:
            yield from look_towards(self, known.points_in_map[1])
            lost = yield from self._look()
            if lost is None:
                return
            if self._covered():
                yield from self._take_as_it_was(lost)
                return
        for pan in self.tuning.pans:
            yield from pan_head(self, pan)
            lost = yield from self._look()
            if lost is None:
                return
        yield from self._take_as_it_was(lost)

    def _look(self) -> Generator[None, None, PerceptionFailure | None]:
        """Look several times; what was in the way of finding the arm, or None, and then its posture is known."""
        lost = PerceptionFailure(Problem.ARM_LOST, f"{self.side} arm")
        for _ in range(self.tuning.max_looks):
            try:
                found = see_person(self)
            except PerceptionFailure as stop:
                found, lost = [], stop
            if self.side not in found:
                yield
                continue
            posture = watch_of(self).arms[self.side]
            if float(posture.deviation.max()) <= PERSON_TRACKING.sure_deviation:
                self.posture = posture
                return None
            yield from self.wait(self.tuning.look_interval)
        return lost

    def _covered(self) -> bool:
        """Whether something covers the arm where it was seen before: then there is no use in looking elsewhere."""
        known = watch_of(self).arms[self.side]
        return visible_share(head_view(self), known) < PERSON_TRACKING.min_visible

    def _take_as_it_was(self, lost: PerceptionFailure) -> Iterator[None]:
        posture = self._remembered(lost)
        yield from look_towards(self, posture.points_in_map[0])
        self.note(f"takes the {self.side} arm, which is covered, to lie where it was")
        self.posture = posture

    def _remembered(self, lost: PerceptionFailure) -> ArmPosture:
        """Where an arm that now lies under the gown was seen before."""
        try:
            posture = watch_arm(self, self.side)
        except PerceptionFailure:
            raise lost from None
        if float(posture.deviation.max()) > PERSON_TRACKING.sure_deviation:
            raise lost
        return posture
