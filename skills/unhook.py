"""Lift the gown with one hand until it is off the hook, and weigh it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..sim.quantity import Quantities, quantity
from ..sim.world import Side
from .control.hands import cloth_load, hand_now, move_hands
from .core.ports import Input, Output
from .core.reasons import Reason, SkillFailure
from .core.skill import Skill


@dataclass(frozen=True, kw_only=True)
class UnhookTuning(Quantities):
    """Numbers of `Unhook`."""

    speed: float = quantity(0.3, "m/s", "of the hand", "choice: the cloth follows without swinging far")
    weighing_time: float = quantity(
        0.4, "s", "over which the load is read; its second half counts", "choice: in the first half the gown swings out"
    )


class Unhook(Skill):
    """Lifts what a hand took straight up and weighs it; fails where the hand carries less than a gown."""

    hand = Input(Side, doc="the hand that holds the gown")
    height = Input(float, unit="m", doc="by which the hand rises", default=0.22)
    min_load = Input(float, unit="N", doc="least load of a gown that hangs free", default=2.5)
    tuning = Input(UnhookTuning, default=UnhookTuning(), doc="numbers of this skill")
    load = Output(float, unit="N", doc="on the hand in the end")
    reasons = (Reason.UNREACHABLE, Reason.MOTION_BLOCKED, Reason.COMMAND_LOST, Reason.GRASP_MISSED)

    def steps(self) -> Iterator[None]:
        """Lift straight up, let the gown swing out, weigh it."""
        self.note("lifts it off")
        pose = hand_now(self, self.hand)
        pose[2, 3] += self.height
        yield from move_hands(self, {self.hand: pose}, speed=self.tuning.speed, free="approach")
        samples = []
        end = self.now() + self.tuning.weighing_time
        while self.now() < end:
            samples.append(-cloth_load(self, self.hand)[2])
            yield
        load = float(np.mean(samples[len(samples) // 2 :]))
        if load < self.min_load:
            raise SkillFailure(Reason.GRASP_MISSED, f"{load:.1f} N hang on the {self.hand} hand")
        self.note(f"carries {load:.1f} N")
        self.load = load
