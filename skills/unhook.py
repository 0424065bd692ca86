"""Stage A: lift the gown until the hook lets it go, and make sure that the hand carries it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..sim.world import Side
from .control.hands import cloth_load, hand_now, move_hands
from .core.ports import Input, Output
from .core.reasons import Reason, SkillFailure
from .core.skill import Skill


class Unhook(Skill):
    """Lifts what a hand took by `height` and weighs it.

    Inputs: `side`, the hand; `height` to lift by [m]; `weight`, least load of a gown that hangs free [N].
    Output: `load` on the hand afterwards [N].
    """

    side = Input(Side)
    height = Input(float, default=0.22)
    weight = Input(float, default=2.5)
    load = Output(float)
    reasons = (Reason.UNREACHABLE, Reason.MOTION_BLOCKED, Reason.COMMAND_LOST, Reason.GRASP_MISSED)

    def steps(self) -> Iterator[None]:
        """Lift straight up, let it swing out, weigh, look."""
        self.note("lifts the gown off its hook")
        pose = hand_now(self, self.side)
        pose[2, 3] += self.height
        yield from move_hands(self, {self.side: pose}, speed=0.3, free="approach")
        samples = []
        end = self.now() + 0.4
        while self.now() < end:
            samples.append(-cloth_load(self, self.side)[2])
            yield
        load = float(np.mean(samples[len(samples) // 2 :]))
        if load < self.weight:
            raise SkillFailure(Reason.GRASP_MISSED, f"{load:.1f} N hang on the {self.side} hand")

        self.note(f"carries {load:.1f} N")
        self.load = load
